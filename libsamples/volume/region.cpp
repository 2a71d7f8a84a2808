// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/region.h"

#include "core/convex_clip.h"
#include "core/math.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

// Grows the box by the extension of corner i: eqs. 9 to 11 of AOV without the far end, |e| = δ / sin(half of the corner's angle).
double extensionOf(glm::dvec3 before, glm::dvec3 after, double distance_m, bool exact_bounds)
{
	// The sum of two edges' inward normals has length 2 sin(angle / 2).
	const double sine = 0.5 * glm::length(before + after);
	const double length_m = distance_m / std::max(sine, 1e-9);
	return exact_bounds ? length_m : std::min(length_m, 2.0 * distance_m);
}

} // namespace

VolumeRegion regionOf(std::span<const glm::dvec3> corners, glm::dvec3 front, glm::dvec3 winding, double distance_m,
					  bool exact_bounds)
{
	assert(corners.size() >= 3 && corners.size() <= kMaxOccluderCorners);
	VolumeRegion region;
	region.distance_m = distance_m;
	glm::dvec3 largest(0.0);
	for (const glm::dvec3& corner : corners)
	{
		largest = glm::max(largest, glm::abs(corner));
	}
	const double slack_m = 1e-9 * distance_m + 1e-14 * (largest.x + largest.y + largest.z);
	const auto add = [&](glm::dvec3 normal, double offset)
	{
		region.halves[region.count++] = {normal, offset - slack_m};
	};
	// Starts beyond the bias, unless rounding to 32 bits is coarser: then directly in front.
	const double height = glm::dot(front, corners[0]);
	add(front, height + 0.5 * kPlaneBias * distance_m);
	add(-front, -height - distance_m);
	const std::size_t n = corners.size();
	std::array<glm::dvec3, kMaxOccluderCorners> inward;
	for (std::size_t i = 0; i < n; ++i)
	{
		const glm::dvec3 across = glm::cross(winding, corners[(i + 1) % n] - corners[i]); // eq. 7, inward
		inward[i] = across / std::max(glm::length(across), 1e-300);
		add(inward[i], glm::dot(inward[i], corners[i]) - distance_m);
	}
	for (std::size_t i = 0; i < n; ++i)
	{
		const double extension_m = extensionOf(inward[(i + n - 1) % n], inward[i], distance_m, exact_bounds) + slack_m;
		region.box.least = glm::min(region.box.least, corners[i] - extension_m);
		region.box.most = glm::max(region.box.most, corners[i] + extension_m);
	}
	return region;
}

namespace
{

using Clipped = std::array<glm::dvec3, 3 + kMaxOccluderCorners + 8>; // every plane adds at most one corner

// The part of the triangle inside the region; returns its number of corners.
std::size_t clipped(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle, Clipped& shape)
{
	Clipped cut;
	std::copy(triangle.begin(), triangle.end(), shape.begin());
	std::size_t size = 3;
	const auto clip = [&](glm::dvec3 normal, double offset)
	{
		std::size_t kept = 0;
		clipConvex(
			shape.data(), size, LastEdge::first, [&](const glm::dvec3& x) { return glm::dot(normal, x) - offset; }, OnEdge{},
			[&](const glm::dvec3& x) { cut[kept++] = x; });
		std::swap(shape, cut);
		size = kept;
		return size > 0;
	};
	uint32_t cuts = 0; // planes that intersect it
	for (const HalfSpace& half : region.planes())
	{
		const double a = glm::dot(half.normal, triangle[0]);
		const double b = glm::dot(half.normal, triangle[1]);
		const double c = glm::dot(half.normal, triangle[2]);
		if (std::max({a, b, c}) < half.offset)
		{
			return 0;
		}
		cuts |= std::min({a, b, c}) < half.offset ? 1U << static_cast<unsigned>(&half - region.planes().data()) : 0U;
	}
	for (std::size_t k = 0; k < region.count; ++k)
	{
		const HalfSpace& half = region.halves[k];
		if ((cuts >> k & 1U) != 0 && !clip(half.normal, half.offset))
		{
			return 0;
		}
	}
	for (int axis = 0; axis < 3; ++axis)
	{
		glm::dvec3 along(0.0);
		along[axis] = 1.0;
		const auto [least, most] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
		if ((least < region.box.least[axis] && !clip(along, region.box.least[axis])) ||
			(most > region.box.most[axis] && !clip(-along, -region.box.most[axis])))
		{
			return 0;
		}
	}
	return size;
}

} // namespace

bool reaches(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle)
{
	Clipped shape;
	return clipped(region, triangle, shape) > 0;
}

std::size_t partWithin(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle, std::vector<glm::dvec3>& corners)
{
	Clipped shape;
	const std::size_t size = clipped(region, triangle, shape);
	corners.insert(corners.end(), shape.begin(), shape.begin() + static_cast<std::ptrdiff_t>(size));
	return size;
}

bool receiverSide(const Level& level, uint32_t triangle, int side, bool smooth_normals, ReceiverSide& receiver)
{
	const glm::uvec3 corner = level.triangles[triangle];
	receiver.corners = {level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]};
	const glm::dvec3 across = glm::cross(receiver.corners[1] - receiver.corners[0], receiver.corners[2] - receiver.corners[0]);
	const double length = glm::length(across);
	if (!(length > 0.0))
	{
		return false;
	}
	receiver.flat = across * ((side == 0 ? 1.0 : -1.0) / length);
	receiver.has_smooth = smooth_normals;
	receiver.mixed = false;
	if (smooth_normals)
	{
		int turned = 0;
		for (int i = 0; i < 3; ++i)
		{
			const auto at = static_cast<std::size_t>(i);
			receiver.smooth[at] = glm::dvec3(level.normals[corner[i]]);
			turned += glm::dot(receiver.smooth[at], receiver.flat) < 0.0 ? 1 : 0;
		}
		receiver.mixed = turned != 0 && turned != 3;
		if (turned == 3)
		{
			for (glm::dvec3& normal : receiver.smooth)
			{
				normal = -normal;
			}
		}
	}
	return true;
}

double riseOf(std::span<const glm::dvec3> polygon, const ReceiverSide& receiver)
{
	const auto& p = receiver.corners;
	double rise = -1e300;
	for (const glm::dvec3& c : polygon)
	{
		rise = std::max(rise, glm::dot(receiver.flat, c - p[0]));
	}
	if (!receiver.has_smooth)
	{
		return rise;
	}
	const auto& n = receiver.smooth;
	double shortest = 1.0;
	double smooth = -1e300;
	for (std::size_t i = 0; i < 3; ++i)
	{
		for (std::size_t j = i; j < 3; ++j)
		{
			shortest = std::min(shortest, glm::dot(n[i], n[j]));
			for (const glm::dvec3& c : polygon)
			{
				smooth = std::max(smooth, 0.5 * (glm::dot(n[i], c - p[j]) + glm::dot(n[j], c - p[i])));
			}
		}
	}
	if (receiver.mixed || (smooth > 0.0 && !(shortest > 0.01)))
	{
		return 1e300;
	}
	return std::max(rise, smooth > 0.0 ? smooth / std::sqrt(shortest) : smooth);
}

double greatestShare(const VolumeRegion& region, std::span<const glm::dvec3> polygon, double area_m2, double alpha,
					 const ReceiverSide& receiver, double rise_m)
{
	// Falloff: each factor of eq. 5 is linear in x, so its maximum is at one of the corners. The first half-space is the polygon's
	// plane (slightly in front), the second the far end; the others lie δ beyond the edges.
	const double distance_m = region.distance_m;
	double g = alpha;
	double least_m = 0.0;    // lower bound of the triangle's distance
	double greatest_m = 0.0; // upper bound of its distance from the polygon's plane
	for (std::size_t k = 1; k < region.count; ++k)
	{
		const HalfSpace& half = region.halves[k];
		double most = -1e300;
		for (const glm::dvec3& corner : receiver.corners)
		{
			most = std::max(most, glm::dot(half.normal, corner) - half.offset);
		}
		g *= std::clamp(most / distance_m, 0.0, 1.0);
		least_m = std::max(least_m, distance_m - most);
	}
	for (const glm::dvec3& corner : receiver.corners)
	{
		greatest_m = std::max(greatest_m, glm::dot(region.halves[0].normal, corner) - region.halves[0].offset);
	}
	greatest_m = std::min(greatest_m, distance_m) + kPlaneBias * distance_m;
	// Distance between the two boxes.
	glm::dvec3 least(1e300);
	glm::dvec3 most(-1e300);
	for (const glm::dvec3& corner : polygon)
	{
		least = glm::min(least, corner);
		most = glm::max(most, corner);
	}
	const auto& p = receiver.corners;
	const glm::dvec3 apart = glm::max(
		glm::dvec3(0.0), glm::max(least - glm::max(p[0], glm::max(p[1], p[2])), glm::min(p[0], glm::min(p[1], p[2])) - most));
	least_m = std::max({least_m, glm::length(apart), 0.5 * kPlaneBias * distance_m});
	// Form factor = ∫ cos θ cos θ' / (π r²) dA with cos θ ≤ rise / r and cos θ' ≤ height / r; the lowest part of the hemisphere, up
	// to the elevation asin(rise / r), contributes sin² of that.
	const double cosine = std::min(1.0, rise_m / least_m);
	const double by_area = area_m2 * cosine * std::min(1.0, greatest_m / least_m) / (kPi * least_m * least_m);
	return g * std::min(by_area, cosine * cosine);
}

} // namespace nook
