// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/sheets.h"

#include "scene/topology.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace nook
{

std::size_t alignSheets(Level& level, int threads)
{
	const auto isSheet = [&level](std::size_t t)
	{
		return level.material_list[level.materials[t]].two_sided;
	};
	const auto areaOf = [&level](std::size_t t) // twice as long
	{
		const glm::uvec3 corner = level.triangles[t];
		const glm::dvec3 a = level.positions[corner.x];
		return glm::cross(level.positions[corner.y] - a, level.positions[corner.z] - a);
	};
	if (std::none_of(level.material_list.begin(), level.material_list.end(), [](const auto& one) { return one.two_sided; }))
	{
		return 0;
	}
	const std::vector<uint32_t> places = weldPositions(level.positions, threads);
	std::vector<glm::dvec3> sums(level.positions.size(), glm::dvec3(0.0));
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		for (int corner = 0; isSheet(t) && corner < 3; ++corner)
		{
			sums[places[level.triangles[t][corner]]] += areaOf(t);
		}
	}
	std::size_t turned = 0;
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		const glm::dvec3 own = isSheet(t) ? areaOf(t) : glm::dvec3(0.0);
		bool against = own != glm::dvec3(0.0);
		for (int corner = 0; against && corner < 3; ++corner)
		{
			against = glm::dot(own, sums[places[level.triangles[t][corner]]]) < 0.0;
		}
		if (against)
		{
			std::swap(level.triangles[t].y, level.triangles[t].z);
			turned += 1;
		}
	}
	return turned;
}

} // namespace nook
