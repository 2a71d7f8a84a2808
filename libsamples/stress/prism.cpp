// SPDX-License-Identifier: GPL-3.0-or-later
// The builder of volumes: AOV's eqs. 6 to 13 as they are written, in 80 bits, and what makes a volume one.
#include "volume/prism.h"

#include "core/math.h"
#include "stress/case.h"
#include "stress/form_factor_twin.h"
#include "stress/numbers.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace nook::stress
{
namespace
{

using WideVector = Vector<long double>;

WideVector operator-(const WideVector& a, const WideVector& b)
{
	return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
WideVector scaled(const WideVector& a, long double s)
{
	return {a[0] * s, a[1] * s, a[2] * s};
}
WideVector unit(const WideVector& a)
{
	return scaled(a, 1.0L / std::sqrt(dotOf(a, a)));
}

struct HardPrism
{
	std::vector<glm::dvec3> corners;
	glm::dvec3 front{0, 0, 1};
	VolumeShape shape;
	double size_m = 1.0;
	double far_m = 0.0; // of the coordinates
};

// Convex polygons of 10⁻⁸ to 10⁸ metres, needles among them, up to 10⁵ times as far from the origin as they are large.
HardPrism hardPrism(Random& random)
{
	HardPrism prism;
	prism.size_m = anySize(random);
	prism.shape.distance_m = prism.size_m * octaves(random, -10.0, 10.0);
	prism.shape.two_sided = random.below(2) == 0;
	prism.shape.exact_bounds = random.below(2) == 0;
	prism.front = hardDirection(random);
	const glm::dvec3 aside = std::fabs(prism.front.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
	const glm::dvec3 u = glm::normalize(glm::cross(prism.front, aside));
	const glm::dvec3 v = glm::cross(prism.front, u);
	const double width = random.below(2) == 0 ? 1.0 : octaves(random, -20.0, 0.0);
	prism.far_m = random.below(2) == 0 ? 0.0 : prism.size_m * octaves(random, -3.0, 16.0);
	const glm::dvec3 at = prism.far_m * hardDirection(random);
	const auto count = 3 + random.below(10);
	const double first = between(random, 0.0, 2.0 * kPi);
	for (uint32_t i = 0; i < count; ++i)
	{
		const SinCos angle = sinCosOf(first + 2.0 * kPi * (i + between(random, 0.0, 0.8)) / count);
		prism.corners.push_back(at + 0.5 * prism.size_m * (angle.cos * u + width * angle.sin * v));
	}
	return prism;
}

// Eqs. 9 to 11: e·n = e·n' = δ for the outward normals n, n' of both edges, across the front.
WideVector extensionTwin(const WideVector& arriving, const WideVector& leaving, const WideVector& front, long double distance,
						 long double most)
{
	const WideVector n = crossOf(arriving, front);
	const WideVector m = crossOf(leaving, front);
	const WideVector sum{n[0] + m[0], n[1] + m[1], n[2] + m[2]};
	const long double square = dotOf(sum, sum); // 2 + 2 n·m
	const long double length = square > 0.0L ? 2.0L * distance / std::sqrt(square) : most;
	const WideVector outward = arriving - leaving;
	const bool sharp = square < 1.0L;
	const WideVector along = sharp ? unit(outward) : unit(sum);
	return scaled(along, std::min(length, most));
}

void runPrism(Case& one)
{
	const HardPrism prism = hardPrism(one.random);
	const std::size_t count = prism.corners.size();
	if (one.shown())
	{
		for (const glm::dvec3& corner : prism.corners)
		{
			one.note("corner", corner);
		}
		one.note("front", prism.front);
		one.note("distance", prism.shape.distance_m);
		one.note("sides", prism.shape.two_sided ? 2 : 1);
		one.note("exact bounds", prism.shape.exact_bounds ? 1 : 0);
	}
	std::vector<glm::dvec3> points(2 * count);
	prismOf(prism.corners, prism.front, prism.shape, points);
	double longest = 0.0;
	double shortest = HUGE_VAL;
	for (std::size_t i = 0; i < count; ++i)
	{
		const double length = glm::distance(prism.corners[i], prism.corners[(i + 1) % count]);
		longest = std::max(longest, length);
		shortest = std::min(shortest, length);
	}
	const double d = prism.shape.distance_m;
	const double most = prism.shape.exact_bounds ? 64.0 * std::max(4.0 * d, longest) : 2.0 * d;
	// Corners' own rounding turns an edge by this much.
	const double turn = 4e-16 * (prism.far_m + prism.size_m) / shortest;
	for (std::size_t i = 0; i < count; ++i)
	{
		const glm::dvec3& before = prism.corners[(i + count - 1) % count];
		const glm::dvec3& corner = prism.corners[i];
		const WideVector arriving = unit(wideOf(corner) - wideOf(before));
		const WideVector leaving = unit(wideOf(prism.corners[(i + 1) % count]) - wideOf(corner));
		const WideVector e = extensionTwin(arriving, leaving, wideOf(prism.front), d, most);
		const auto length = static_cast<double>(std::sqrt(dotOf(e, e)));
		const double scale = length + d + prism.far_m * 1e-3 + prism.size_m * 1e-3;
		// How far e moves when an edge turns: by its length, over the sine of half of the corner's angle.
		const double unit_m = scale * (1.0 + turn * 1e12 * length / d);
		for (int k = 0; k < 3; ++k)
		{
			const auto axis = static_cast<std::size_t>(k);
			const auto up = static_cast<long double>(prism.front[k]) * static_cast<long double>(d);
			const long double ring = static_cast<long double>(corner[k]) + e[axis];
			one.result("point", points[i][k], -1e30, 1e30);
			one.compare("lower", points[i][k], prism.shape.two_sided ? ring - up : ring, unit_m);
			one.compare("upper", points[count + i][k], ring + up, unit_m);
		}
	}
}

// The front of a polygon by 80 bits.
void runFront(Case& one)
{
	const HardPrism prism = hardPrism(one.random);
	const glm::dvec3 found = frontOf(prism.corners);
	WideVector sum{};
	for (std::size_t i = 1; i + 1 < prism.corners.size(); ++i)
	{
		const WideVector c =
			crossOf(wideOf(prism.corners[i]) - wideOf(prism.corners[0]), wideOf(prism.corners[i + 1]) - wideOf(prism.corners[0]));
		for (std::size_t k = 0; k < 3; ++k)
		{
			sum[k] += c[k];
		}
	}
	const long double area = std::sqrt(dotOf(sum, sum));
	if (one.shown())
	{
		for (const glm::dvec3& corner : prism.corners)
		{
			one.note("corner", corner);
		}
	}
	one.result("length", glm::length(found), area > 0.0L ? 1.0 - 1e-12 : 0.0, 1.0 + 1e-12);
	if (!(area > 0.0L))
	{
		one.leaveOpen();
		return;
	}
	// Rounding of differences and products, as a share of the area.
	const double unit_share = 1.0 + prism.size_m * prism.size_m / static_cast<double>(area);
	for (int k = 0; k < 3; ++k)
	{
		one.compare("front", found[k], sum[static_cast<std::size_t>(k)] / area, unit_share);
	}
}

constexpr std::array kPrismKernels{
	StressKernel{"prism", "builders", "AOV's eqs. 9 to 13 in 80 bits", "the extension, distance and 1/1000 of the coordinates",
				 1e-12, 200, 1, runPrism},
	StressKernel{"polygon-front", "builders", "Newell's sum in 80 bits", "sine, over the share of its box that it fills", 1e-15,
				 200, 1, runFront},
};

} // namespace

std::span<const StressKernel> prismKernels()
{
	return kPrismKernels;
}

} // namespace nook::stress
