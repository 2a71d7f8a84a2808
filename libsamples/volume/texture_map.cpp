// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/texture_map.h"

#include <glm/geometric.hpp>

namespace nook::detail
{

glm::dvec2 TextureMap::at(glm::dvec3 position) const
{
	const glm::dvec3 offset = position - origin;
	return at_origin + glm::dvec2(glm::dot(u, offset), glm::dot(v, offset));
}

TextureMap textureMapOf(const Soup& soup, std::size_t triangle)
{
	const glm::uvec3& t = soup.triangles[triangle];
	const Level& level = *soup.level;
	const glm::dvec3 side = level.positions[t.y] - level.positions[t.x];
	const glm::dvec3 other = level.positions[t.z] - level.positions[t.x];
	const glm::dvec3 area = glm::cross(side, other);
	const glm::dvec2 start(level.uvs[t.x]);
	const glm::dvec2 along_side = glm::dvec2(level.uvs[t.y]) - start;
	const glm::dvec2 along_other = glm::dvec2(level.uvs[t.z]) - start;
	// Gradients of the barycentric coordinates.
	const double square = glm::dot(area, area);
	const glm::dvec3 of_side = glm::cross(other, area) / square;
	const glm::dvec3 of_other = glm::cross(area, side) / square;
	return {level.positions[t.x], start, along_side.x * of_side + along_other.x * of_other,
			along_side.y * of_side + along_other.y * of_other};
}

} // namespace nook::detail
