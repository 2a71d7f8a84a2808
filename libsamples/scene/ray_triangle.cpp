// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/ray_triangle.h"

#include "core/lists.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace nook
{

PlaneHit meet(const Level& level, uint32_t triangle, glm::dvec3 origin, glm::dvec3 direction)
{
	const glm::uvec3 corner = level.triangles[triangle];
	const glm::dvec3 a = level.positions[corner[0]] - origin;
	const glm::dvec3 ab = level.positions[corner[1]] - level.positions[corner[0]];
	const glm::dvec3 ac = level.positions[corner[2]] - level.positions[corner[0]];
	const glm::dvec3 normal = glm::cross(ab, ac);
	const double facing = glm::dot(direction, normal);
	const glm::dvec3 q = glm::cross(a, direction);
	return {glm::dot(a, normal) / facing, glm::dot(ac, q) / facing, -glm::dot(ab, q) / facing, facing / glm::length(normal)};
}

bool isInside(const PlaneHit& hit)
{
	constexpr double kRoom = 1e-12;                                                            // several thousand roundings
	return hit.b >= -kRoom && hit.c >= -kRoom && hit.b + hit.c <= 1.0 + kRoom && hit.t >= 0.0; // false for NaN
}

LargerTriangle enlarge(const Level& level, uint32_t triangle, double by_m)
{
	const glm::uvec3 corner = level.triangles[triangle];
	LargerTriangle larger{{level.positions[corner[0]], level.positions[corner[1]], level.positions[corner[2]]}, 0.0};
	const std::array<glm::dvec3, 3> at = larger.corners;
	const double doubled_area = glm::length(glm::cross(at[1] - at[0], at[2] - at[0]));
	if (!(doubled_area > 0.0))
	{
		return larger;
	}
	for (std::size_t i = 0; i < 3; ++i)
	{
		const glm::dvec3 next = at[(i + 1) % 3] - at[i];
		const glm::dvec3 along = glm::normalize(next);
		const glm::dvec3 back = glm::normalize(at[(i + 2) % 3] - at[i]);
		// by_m from both lines; the length of along + back is at most 2.
		const double share = by_m / glm::length(glm::cross(along, back));
		larger.corners[i] -= std::min(share, 500.0 * by_m) * (along + back);
		// A height is twice the area over its edge. Once for the larger edges, and once for by_m across a ray, which is up to ten
		// times as much along the surface at a grazing angle of six degrees.
		larger.margin = std::max(larger.margin, 11.0 * by_m * glm::length(next) / doubled_area);
	}
	return larger;
}

glm::dvec3 twiceAreaOf(const Level& level, std::size_t triangle)
{
	const glm::uvec3& corner = level.triangles[triangle];
	const glm::dvec3 a = level.positions[corner.x];
	return glm::cross(level.positions[corner.y] - a, level.positions[corner.z] - a);
}

std::vector<double> areasOf(const Level& level)
{
	return listOf(level.triangles.size(), [&level](std::size_t t) { return 0.5 * glm::length(twiceAreaOf(level, t)); });
}

glm::dvec3 geometricNormal(const Level& level, uint32_t triangle)
{
	return glm::normalize(twiceAreaOf(level, triangle));
}

glm::dvec3 interpolatedNormal(const Level& level, uint32_t triangle, glm::dvec2 barycentric)
{
	const glm::uvec3 corner = level.triangles[triangle];
	const glm::dvec3 sum = (1.0 - barycentric.x - barycentric.y) * glm::dvec3(level.normals[corner[0]]) +
						   barycentric.x * glm::dvec3(level.normals[corner[1]]) +
						   barycentric.y * glm::dvec3(level.normals[corner[2]]);
	const double length = glm::length(sum);
	const glm::dvec3 flat = geometricNormal(level, triangle);
	if (!(length > 1e-6))
	{
		return flat;
	}
	const glm::dvec3 normal = sum / length;
	return glm::dot(normal, flat) < 0.0 ? -normal : normal; // flipped to the surface's side
}

} // namespace nook
