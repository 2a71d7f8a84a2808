// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/ray_triangle.h"

#include <glm/geometric.hpp>

namespace nook
{

glm::dvec3 geometricNormal(const Level& level, uint32_t triangle)
{
	const glm::uvec3 corner = level.triangles[triangle];
	const glm::dvec3 a = level.positions[corner[0]];
	return glm::normalize(glm::cross(level.positions[corner[1]] - a, level.positions[corner[2]] - a));
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
