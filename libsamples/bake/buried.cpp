// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/buried.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <array>
#include <cmath>

namespace nook
{
namespace
{

constexpr std::size_t kVotes = 9;
constexpr int kNeeded = 7; // a leak or a sheet that faces the other way, but for that: backs all round

} // namespace

bool isBuried(const Tracer& tracer, glm::dvec3 origin, glm::dvec3 normal)
{
	std::array<float, kVotes> x{};
	std::array<float, kVotes> y{};
	std::array<float, kVotes> z{};
	const glm::dvec3 other = std::fabs(normal.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
	const glm::dvec3 tangent = glm::normalize(glm::cross(other, normal));
	const glm::dvec3 bitangent = glm::cross(normal, tangent);
	const double golden_rad = kPi * (3.0 - std::sqrt(5.0));
	for (std::size_t i = 0; i < kVotes; ++i)
	{
		const double square = static_cast<double>(i) / static_cast<double>(kVotes); // of the radius in the disk
		const SinCos a = sinCosOf(golden_rad * static_cast<double>(i));
		const double radius = std::sqrt(square);
		const glm::dvec3 direction = radius * a.cos * tangent + radius * a.sin * bitangent + std::sqrt(1.0 - square) * normal;
		x[i] = static_cast<float>(direction.x);
		y[i] = static_cast<float>(direction.y);
		z[i] = static_cast<float>(direction.z);
	}
	std::array<int8_t, kVotes> sides{};
	const auto some = [&](std::size_t first, std::size_t count)
	{
		const Directions directions{std::span(x).subspan(first, count), std::span(y).subspan(first, count),
									std::span(z).subspan(first, count)};
		tracer.sides(origin, directions, std::span(sides).subspan(first, count));
	};
	// Out in the open, which most points are, two directions tell.
	some(0, 2);
	if (sides[0] >= 0 && sides[1] >= 0)
	{
		return false;
	}
	some(2, kVotes - 2);
	int sum = 0;
	for (const int8_t side : sides)
	{
		sum += side;
	}
	return sum <= -kNeeded;
}

} // namespace nook
