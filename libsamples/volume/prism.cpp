// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), §5.2.
#include "core/lists.h"
#include "volume/volumes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{

namespace
{

// AOV's clamp: |e| ≤ 2 δ cuts corners sharper than 60°.
constexpr double kClamp = 2.0;

// Exact bounds keep the whole mitre up to this multiple of the polygon's reach, max(4 δ, its longest edge ℓ). Cutting a corner with
// half angle a there loses, besides the tip, points with g ≤ 1/(k + 1), for which the polygon is at most a · ℓ/δ high, so that its
// form factor is below 1/(2 k): less than 1/(2 k²) = 1/8192 of occlusion. Beyond the tip the form factor falls even faster.
constexpr double kMitre = 64.0;

// Eqs. 9 to 11 have the closed form e = δ (n + n') / (1 + n · n') for the outward normals n, n' of the two edges. It is
// well-conditioned for collinear neighbours, where the 3×3 system of eq. 12 is singular. If the outline turns by more than a right
// angle the sum cancels; then the direction comes from the edges' difference and the length from the sine of the turn, exact to
// 1e-9 for a corner of 1e-7 radians.
glm::dvec3 extension(glm::dvec3 arriving, glm::dvec3 leaving, glm::dvec3 front, double distance_m, double most_m)
{
	const double cosine = glm::dot(arriving, leaving);
	if (cosine >= 0.0)
	{
		return glm::cross(arriving + leaving, front) * (distance_m / (1.0 + cosine)); // at most √2 δ
	}
	const glm::dvec3 outward = arriving - leaving; // length 2 cos a, with a half of the inner angle
	const double length = glm::length(outward);
	const double sine = glm::dot(glm::cross(arriving, leaving), front); // 2 sin a cos a
	const double most_sine = distance_m * length / most_m;
	return outward / length * (sine > most_sine ? distance_m * length / sine : most_m);
}

using Corners = std::vector<glm::dvec3>;

// The part of a convex polygon where along · x ≤ limit, or ≥ with negated arguments. Corners within `near_m` of the cut are on it.
Corners partBelow(const Corners& corners, glm::dvec3 along, double limit, double near_m)
{
	Corners part;
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const glm::dvec3 a = corners[i];
		const glm::dvec3 b = corners[(i + 1) % corners.size()];
		const double from = glm::dot(along, a) - limit;
		const double to = glm::dot(along, b) - limit;
		if (from <= near_m)
		{
			part.push_back(a);
		}
		if ((from < -near_m && to > near_m) || (from > near_m && to < -near_m))
		{
			// Interpolates from the same end in both parts, so that they share the corner exactly.
			part.push_back(from < 0.0 ? a + (b - a) * (from / (from - to)) : b + (a - b) * (to / (to - from)));
		}
	}
	return part;
}

// Directions along the longest edge and across it.
std::pair<glm::dvec3, glm::dvec3> axesOf(std::span<const glm::dvec3> corners)
{
	glm::dvec3 edge(0.0);
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const glm::dvec3 side = corners[(i + 1) % corners.size()] - corners[i];
		edge = glm::dot(side, side) > glm::dot(edge, edge) ? side : edge;
	}
	const glm::dvec3 x = glm::normalize(edge);
	return {x, glm::cross(frontOf(corners), x)};
}

} // namespace

VolumeShape shapeOf(const VolumeSet& volumes, const Occluder& polygon)
{
	return {volumes.distance_m * static_cast<double>(polygon.reach), polygon.two_sided, volumes.exact_bounds,
			static_cast<double>(polygon.side_reach) / static_cast<double>(polygon.reach)};
}

glm::dvec3 areaVector(std::span<const glm::dvec3> corners)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
	}
	return sum;
}

glm::dvec3 frontOf(std::span<const glm::dvec3> corners)
{
	const glm::dvec3 sum = areaVector(corners);
	const double largest = std::max({std::fabs(sum.x), std::fabs(sum.y), std::fabs(sum.z)});
	return largest > 0.0 ? glm::normalize(sum / largest) : glm::dvec3(0.0); // scaled, because squares of small areas underflow
}

void prismOf(std::span<const glm::dvec3> corners, glm::dvec3 front, const VolumeShape& shape, std::span<glm::dvec3> points)
{
	const std::size_t count = corners.size();
	assert(count >= 3 && points.size() == 2 * count && shape.distance_m > 0.0 && shape.side_share > 0.0);
	double longest = 0.0;
	for (std::size_t i = 0; i < count; ++i)
	{
		longest = std::max(longest, glm::distance(corners[i], corners[(i + 1) % count]));
	}
	const double side_m = shape.distance_m * shape.side_share;
	const double most_m = shape.exact_bounds ? kMitre * std::max(4.0 * side_m, longest) : kClamp * side_m;
	const glm::dvec3 upper = shape.distance_m * front;
	glm::dvec3 arriving = glm::normalize(corners[0] - corners[count - 1]);
	for (std::size_t i = 0; i < count; ++i)
	{
		const glm::dvec3 leaving = glm::normalize(corners[(i + 1) % count] - corners[i]);
		const glm::dvec3 ring = corners[i] + extension(arriving, leaving, front, side_m, most_m);
		points[i] = shape.two_sided ? ring - upper : ring;
		points[count + i] = ring + upper; // eq. 13
		arriving = leaving;
	}
}

} // namespace nook

namespace nook::detail
{

std::array<double, 2> extentsOf(std::span<const glm::dvec3> corners)
{
	const auto [x, y] = axesOf(corners);
	std::array<double, 2> extents{};
	for (std::size_t i = 0; i < 2; ++i)
	{
		double least = 0.0;
		double most = 0.0;
		for (const glm::dvec3 corner : corners)
		{
			least = std::min(least, glm::dot(i == 0 ? x : y, corner - corners[0]));
			most = std::max(most, glm::dot(i == 0 ? x : y, corner - corners[0]));
		}
		extents[i] = most - least;
	}
	return extents;
}

double halvesOf(std::span<const glm::dvec3> corners, double longest_m)
{
	const auto is_near = [&](glm::dvec3 corner)
	{
		return 4.0 * glm::dot(corner - corners[0], corner - corners[0]) <= longest_m * longest_m;
	};
	if (std::all_of(corners.begin(), corners.end(), is_near))
	{
		return 1.0;
	}
	const auto [along, across] = extentsOf(corners);
	double count = 1.0;
	for (const double extent : {along, across})
	{
		for (double length = extent; length > longest_m && count < 1e15; length *= 0.5)
		{
			count *= 2.0;
		}
	}
	return count;
}

std::vector<std::vector<glm::dvec3>> halvedPolygon(std::span<const glm::dvec3> corners, double longest_m, std::size_t most_corners)
{
	const auto [x, y] = axesOf(corners);
	const glm::dvec3 origin = corners[0]; // preserves precision far from the world's origin
	const double near_m = 1e-9 * longest_m;
	std::vector<Corners> open{mapped(corners, [origin](const glm::dvec3& corner) { return corner - origin; })};
	std::vector<Corners> done;
	while (!open.empty())
	{
		Corners piece = std::move(open.back());
		open.pop_back();
		glm::dvec3 along(0.0);
		double middle = 0.0;
		double longest = 0.0;
		for (const glm::dvec3 axis : {x, y})
		{
			double least = 1e300;
			double most = -1e300;
			for (const glm::dvec3 corner : piece)
			{
				least = std::min(least, glm::dot(axis, corner));
				most = std::max(most, glm::dot(axis, corner));
			}
			if (most - least > longest)
			{
				longest = most - least;
				along = axis;
				middle = 0.5 * (least + most);
			}
		}
		if (longest > longest_m || piece.size() > most_corners)
		{
			open.push_back(partBelow(piece, -along, -middle, near_m));
			open.push_back(partBelow(piece, along, middle, near_m));
		}
		else if (piece.size() >= 3)
		{
			done.push_back(mapped(piece, [origin](const glm::dvec3& corner) { return corner + origin; }));
		}
	}
	return done;
}

} // namespace nook::detail
