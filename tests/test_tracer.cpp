// SPDX-License-Identifier: GPL-3.0-or-later
// Rays compared with every triangle in double precision.
#include "small_levels.h"

#include "core/random.h"
#include "scene/ray_triangle.h"
#include "scene/tracer.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

using namespace nook;
using namespace nook::test;

namespace
{

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

} // namespace

TEST_CASE("tracer: hits lie on their triangle, at their distance", "[reference]")
{
	Level level = emptyLevel();
	addSphere(level, {0.3, 0.2, -0.1}, 1.0, 40, 60);
	const Tracer tracer(level, {});
	Random random(5);
	for (int i = 0; i < 20000; ++i)
	{
		const glm::dvec3 origin(3.0 * random.uniform() - 1.5, 3.0 * random.uniform() - 1.5, 3.0 + random.uniform());
		const glm::dvec3 direction(random.uniform() - 0.5, random.uniform() - 0.5, -1.0);
		const RayHit hit = tracer.nearest(origin, direction, kUnlimited);
		if (!hit.hit)
		{
			continue;
		}
		const glm::uvec3 corner = level.triangles[hit.triangle];
		const double b = hit.barycentric.x;
		const double c = hit.barycentric.y;
		const glm::dvec3 on_triangle =
			(1.0 - b - c) * level.positions[corner[0]] + b * level.positions[corner[1]] + c * level.positions[corner[2]];
		CHECK(std::min({b, c, 1.0 - b - c}) > -1e-4);
		REQUIRE(glm::length(origin + hit.distance * direction - on_triangle) < 1e-6);
		CHECK(hit.front);
	}
	CHECK(!tracer.nearest({0.0, 0.0, 5.0}, {0.0, 1.0, 0.0}, kUnlimited).hit);
	CHECK(!tracer.nearest({0.0, 0.0, 5.0}, {0.0, 0.0, -1.0}, 2.0).hit);
	CHECK(!tracer.nearest({0.3, 0.2, -0.1}, {0.0, 0.0, -1.0}, kUnlimited).front);
}

TEST_CASE("tracer: no distance is below zero, of points in a surface either", "[reference]")
{
	Level level = emptyLevel();
	addSphere(level, {300.0, 200.0, -100.0}, 50.0, 40, 60);
	const Tracer tracer(level, {});
	Random random(9);
	std::array<float, 64> x{};
	std::array<float, 64> y{};
	std::array<float, 64> z{};
	std::array<float, 64> distances{};
	int met = 0;
	for (const glm::uvec3& corner : level.triangles)
	{
		const glm::dvec3 a = level.positions[corner[0]];
		const glm::dvec3 origin = a + 0.3 * (level.positions[corner[1]] - a) + 0.3 * (level.positions[corner[2]] - a);
		for (std::size_t i = 0; i < x.size(); ++i)
		{
			x[i] = static_cast<float>(random.uniform() - 0.5);
			y[i] = static_cast<float>(random.uniform() - 0.5);
			z[i] = static_cast<float>(random.uniform() - 0.5);
		}
		tracer.distances(origin, {x, y, z}, 1.0F, distances);
		for (const float distance : distances)
		{
			REQUIRE(distance >= 0.0F);
			met += distance < 1.0F ? 1 : 0;
		}
	}
	CHECK(met > 0);
}

TEST_CASE("tracer: rays along edges meet what every triangle in double says", "[reference]")
{
	Random random(7);
	Level level = emptyLevel();
	const auto somewhere = [&](double size)
	{
		return size * (glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 0.5);
	};
	for (int i = 0; i < 60; ++i)
	{
		const glm::dvec3 middle = somewhere(20.0);
		const double size = std::pow(10.0, 2.0 * random.uniform() - 1.0);
		const uint32_t a = addVertex(level, middle + somewhere(size));
		const uint32_t b = addVertex(level, middle + somewhere(size));
		const uint32_t c = addVertex(level, middle + somewhere(size));
		addTriangle(level, a, b, c);
		addTriangle(level, c, b, addVertex(level, middle + somewhere(size)));
		if (i % 4 == 0)
		{
			addTriangle(level, b, a, c); // twice at one place
		}
	}
	addSphere(level, {1.0, 2.0, 3.0}, 2.0, 12, 16);
	const Tracer tracer(level, {});
	constexpr std::size_t kRays = 64;
	std::size_t compared = 0;
	std::size_t blocked_count = 0;
	for (int bundle = 0; bundle < 300; ++bundle)
	{
		const glm::dvec3 origin = somewhere(20.0);
		const auto reach = static_cast<float>(5.0 + 20.0 * random.uniform());
		std::array<float, kRays> x{};
		std::array<float, kRays> y{};
		std::array<float, kRays> z{};
		for (std::size_t i = 0; i < kRays; ++i)
		{
			const glm::uvec3 corner = level.triangles[random.below(static_cast<uint32_t>(level.triangles.size()))];
			const double share = i % 8 == 0 ? 0.0 : random.uniform();
			const glm::dvec3 on_edge = (1.0 - share) * level.positions[corner[0]] + share * level.positions[corner[1]];
			const glm::vec3 way(glm::normalize(on_edge - origin));
			x[i] = way.x;
			y[i] = way.y;
			z[i] = way.z;
		}
		std::array<uint8_t, kRays> blocked{};
		std::array<float, kRays> distances{};
		tracer.blocked(origin, {x, y, z}, reach, blocked);
		tracer.distances(origin, {x, y, z}, reach, distances);
		for (std::size_t i = 0; i < kRays; ++i)
		{
			double least = kUnlimited;
			bool grazes = false; // by less than six degrees, where enlarged triangles do not suffice
			for (uint32_t triangle = 0; triangle < level.triangles.size(); ++triangle)
			{
				const PlaneHit hit = meet(level, triangle, origin, glm::dvec3(glm::vec3(x[i], y[i], z[i])));
				least = isInside(hit) && hit.t <= static_cast<double>(reach) ? std::min(least, hit.t) : least;
				grazes = grazes || (std::fabs(hit.rise) < 0.1 && std::min({hit.b, hit.c, 1.0 - hit.b - hit.c}) > -0.1);
			}
			if (!grazes)
			{
				compared += 1;
				blocked_count += blocked[i];
				CHECK(blocked[i] == (least < kUnlimited ? 1 : 0));
				CHECK(distances[i] == static_cast<float>(least));
			}
		}
	}
	CHECK(compared > 300 * kRays / 2);
	CHECK(blocked_count > compared / 4);
}
