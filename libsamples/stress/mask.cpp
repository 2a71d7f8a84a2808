// SPDX-License-Identifier: GPL-3.0-or-later
// Masks of directions: the frame about a normal, and the bits that a polygon sets.
#include "methods/directions.h"
#include "methods/volume_kernels.h"
#include "stress/case.h"
#include "stress/form_factor_twin.h"
#include "stress/numbers.h"

#include <algorithm>
#include <array>
#include <vector>

namespace nook::stress
{
namespace
{

using WideVector = Vector<long double>;

void runTangent(Case& one)
{
	glm::vec3 n(hardDirection(one.random));
	if (one.random.below(8) == 0)
	{
		// Close to the one normal without a frame.
		const glm::dvec3 pole = glm::normalize(glm::dvec3(0.23, 0.94, 0.252));
		n = glm::vec3(glm::normalize(octaves(one.random, -20.0, -3.0) * glm::dvec3(n) - pole));
	}
	one.note("normal", n);
	volume_kernels::Kernels kernels;
	const glm::vec3 x = kernels.nookTangent(n, 0);
	const glm::vec3 y = kernels.nookTangent(n, 1);
	one.result("x.x", static_cast<double>(x.x), -1.1, 1.1);
	one.result("y.y", static_cast<double>(y.y), -1.1, 1.1);
	// Rounding of the normal itself turns the frame by its share of the way to the pole.
	const double away = glm::length(glm::dvec3(n) + glm::normalize(glm::dvec3(0.23, 0.94, 0.252)));
	const double unit = 2.0 / std::max(away, 1e-6);
	one.note("away", away);
	one.compare("x.n", static_cast<double>(dotOf(wideOf(x), wideOf(n))), 0.0L, unit);
	one.compare("y.n", static_cast<double>(dotOf(wideOf(y), wideOf(n))), 0.0L, unit);
	one.compare("x.y", static_cast<double>(dotOf(wideOf(x), wideOf(y))), 0.0L, unit);
	one.compare("|x|", static_cast<double>(std::sqrt(dotOf(wideOf(x), wideOf(x)))), 1.0L, unit);
	one.compare("|y|", static_cast<double>(std::sqrt(dotOf(wideOf(y), wideOf(y)))), 1.0L, unit);
}

// Bits that are surely wrong: each direction as a ray against the polygon, its distance against the threshold.
int wrongBits(const HardPolygon& hard, const std::vector<glm::vec4>& directions, const glm::vec3& x, const glm::vec3& y,
			  const glm::vec3& front, float reach, uint32_t bits)
{
	int wrong = 0;
	const WideVector n = wideOf(hard.normal);
	const long double height = -dotOf(wideOf(front), wideOf(hard.corners[0]));
	const long double side = height < 0.0L ? -1.0L : 1.0L;
	double extent = 0.0;
	for (const glm::vec3& corner : hard.corners)
	{
		extent = std::max(extent, static_cast<double>(glm::length(corner)));
	}
	for (std::size_t i = 0; i < 32; ++i)
	{
		const glm::vec4& d = directions[i];
		WideVector ray{};
		for (std::size_t k = 0; k < 3; ++k)
		{
			const auto axis = static_cast<int>(k);
			ray[k] = static_cast<long double>(d.x) * static_cast<long double>(x[axis]) +
					 static_cast<long double>(d.y) * static_cast<long double>(y[axis]) + static_cast<long double>(d.z) * n[k];
		}
		const long double down = -side * dotOf(ray, wideOf(front));
		const long double distance = down > 0.0L ? std::fabs(height) / down : 1e30L;
		long double sure = std::fabs(1.0L - distance / static_cast<long double>(reach) - static_cast<long double>(d.w)) /
						   (1.0L + static_cast<long double>(extent) / static_cast<long double>(reach)) * down;
		sure = std::min(sure, std::fabs(down));
		bool covered = down > 0.0L && 1.0L - distance / static_cast<long double>(reach) > static_cast<long double>(d.w);
		for (std::size_t k = 0; k < hard.corners.size(); ++k)
		{
			const WideVector a = wideOf(hard.corners[k]);
			const WideVector b = wideOf(hard.corners[(k + 1) % hard.corners.size()]);
			const WideVector c = crossOf(b, a);
			const long double inward = dotOf(ray, c) * side;
			const long double size = std::sqrt(dotOf(c, c));
			sure = std::min(sure, size > 0.0L ? std::fabs(inward) / size : 0.0L);
			covered = covered && inward >= 0.0L;
		}
		const bool set = ((bits >> i) & 1U) != 0U;
		wrong += set != covered && sure > 4e-6L ? 1 : 0;
	}
	return wrong;
}

void runMask(Case& one)
{
	static const std::vector<glm::vec4> directions = maskDirections(32);
	HardPolygon hard = hardPolygon(one.random, static_cast<int>(one.index() % kHardKinds));
	glm::dvec3 sum(0.0);
	double extent = 0.0;
	for (std::size_t i = 1; i + 1 < hard.corners.size(); ++i)
	{
		sum += glm::cross(glm::dvec3(hard.corners[i]) - glm::dvec3(hard.corners[0]),
						  glm::dvec3(hard.corners[i + 1]) - glm::dvec3(hard.corners[0]));
		extent = std::max(extent, static_cast<double>(glm::length(hard.corners[i])));
	}
	const glm::vec3 front(glm::length(sum) > 0.0 ? glm::normalize(sum) : glm::dvec3(0, 0, 1));
	const auto reach = static_cast<float>(extent * octaves(one.random, -4.0, 4.0));
	volume_kernels::Kernels kernels;
	kernels.corners = hard.corners;
	kernels.directions = directions;
	const auto count = static_cast<int>(hard.corners.size());
	const uint32_t bits = kernels.nookMaskWord(count, 0, hard.normal, front, kernels.nookHeight(front), 1.0F,
											   static_cast<int>(one.random.below(1U << 24U)), reach);
	if (one.shown())
	{
		for (const glm::vec3& corner : hard.corners)
		{
			one.note("corner", corner);
		}
		one.note("normal", hard.normal);
		one.note("front", front);
		one.note("reach", static_cast<double>(reach));
	}
	if (one.hasTwin())
	{
		one.compare("wrong bits",
					static_cast<double>(wrongBits(hard, directions, kernels.nookTangent(hard.normal, 0),
												  kernels.nookTangent(hard.normal, 1), front, reach, bits)),
					0.0L);
	}
}

constexpr std::array kMaskKernels{
	StressKernel{"mask-frame", "volume", "right angles and lengths of 1, in 80 bits",
				 "cosine, length; over half the distance to the pole", 2.5e-6, 300, 1, runTangent},
	StressKernel{"mask-word", "volume", "rays along 32 directions, in 80 bits", "wrong bits, of those 4e-6 from any edge", 0.0, 100,
				 1, runMask},
};

} // namespace

std::span<const StressKernel> maskKernels()
{
	return kMaskKernels;
}

} // namespace nook::stress
