// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), §5.2.
#include "volume/prism.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace nook
{
namespace
{

// AOV's clamp: |e| ≤ 2 δ cuts corners sharper than 60°.
constexpr double kClamp = 2.0;

// Exact bounds keep the whole mitre up to this many times the polygon's reach, max(4 δ, its longest edge ℓ). A corner with half
// angle a cut there loses, beside the tip, points with g ≤ 1/(k + 1), for which the polygon is at most a · ℓ/δ high, so that its
// form factor is below 1/(2 k): less than 1/(2 k²) = 1/8192 of occlusion; beyond the tip the form factor falls faster still.
constexpr double kMitre = 64.0;

// Eqs. 9 to 11 have the closed form e = δ (n + n') / (1 + n · n') for the outward normals n, n' of the two edges: well-conditioned
// for collinear neighbours, where the 3×3 system of eq. 12 is singular. Where the outline turns by more than a right angle the sum
// cancels; there the direction comes from the edges' difference and the length from the sine of the turn, exact to 1e-9 for a
// corner of 1e-7 radians.
glm::dvec3 extension(glm::dvec3 arriving, glm::dvec3 leaving, glm::dvec3 front, double distance_m, double most_m)
{
	const double cosine = glm::dot(arriving, leaving);
	if (cosine >= 0.0)
	{
		return glm::cross(arriving + leaving, front) * (distance_m / (1.0 + cosine)); // at most √2 δ
	}
	const glm::dvec3 outward = arriving - leaving; // length 2 cos a, a: half of the inner angle
	const double length = glm::length(outward);
	const double sine = glm::dot(glm::cross(arriving, leaving), front); // 2 sin a cos a
	const double most_sine = distance_m * length / most_m;
	return outward / length * (sine > most_sine ? distance_m * length / sine : most_m);
}

} // namespace

VolumeShape shapeOf(const VolumeSet& volumes, const Occluder& polygon)
{
	return {volumes.distance_m * static_cast<double>(polygon.reach), polygon.two_sided, volumes.exact_bounds,
			static_cast<double>(polygon.side_reach) / static_cast<double>(polygon.reach)};
}

glm::dvec3 frontOf(std::span<const glm::dvec3> corners)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		sum += glm::cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
	}
	const double largest = std::max({std::fabs(sum.x), std::fabs(sum.y), std::fabs(sum.z)});
	return largest > 0.0 ? glm::normalize(sum / largest) : glm::dvec3(0.0); // scaled: squares of small areas vanish
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
