// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/cell.h"

#include "scene/load_parts.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <array>
#include <cassert>

namespace nook
{
namespace
{

bool isIn(const Bounds& box, glm::dvec3 position)
{
	return glm::all(glm::greaterThanEqual(position, box.least)) && glm::all(glm::lessThan(position, box.most));
}

std::array<glm::dvec3, 3> cornersOf(const Level& level, std::size_t triangle)
{
	const glm::uvec3& t = level.triangles[triangle];
	return {level.positions[t.x], level.positions[t.y], level.positions[t.z]};
}

constexpr uint8_t kAway = 0;
constexpr uint8_t kOwn = 1;
constexpr uint8_t kAround = 2;

// Classifies each triangle.
std::vector<uint8_t> placesOf(const Level& level, const CellSettings& settings)
{
	std::vector<uint8_t> places(level.triangles.size(), kAway);
	Bounds near = settings.box;
	for (std::size_t i = 0; i < places.size(); ++i)
	{
		const auto [a, b, c] = cornersOf(level, i);
		if (isIn(settings.box, (a + b + c) / 3.0))
		{
			places[i] = kOwn;
			near.least = glm::min(near.least, glm::min(a, glm::min(b, c)));
			near.most = glm::max(near.most, glm::max(a, glm::max(b, c)));
		}
	}
	near.least -= settings.around_m;
	near.most += settings.around_m;
	for (std::size_t i = 0; i < places.size(); ++i)
	{
		const auto [a, b, c] = cornersOf(level, i);
		const bool reaches = glm::all(glm::lessThanEqual(glm::min(a, glm::min(b, c)), near.most)) &&
							 glm::all(glm::greaterThanEqual(glm::max(a, glm::max(b, c)), near.least));
		places[i] = places[i] == kOwn ? kOwn : reaches ? kAround : kAway;
	}
	return places;
}

} // namespace

Level cutCell(const Level& level, const CellSettings& settings, std::span<const uint8_t> closed, int threads)
{
	assert(closed.empty() || closed.size() == level.triangles.size());
	const std::vector<uint8_t> places = placesOf(level, settings);
	Level cell = level;
	cell.triangles.clear();
	cell.materials.clear();
	cell.meshes.clear();
	std::erase_if(cell.cameras,
				  [&](const LevelCamera& camera) { return !isIn(settings.box, glm::dvec3(camera.world_from_camera[3])); });
	for (const uint8_t place : {kOwn, kAround})
	{
		for (const Mesh& mesh : level.meshes)
		{
			for (const bool is_closed : {false, true})
			{
				Mesh made = mesh;
				made.first_triangle = cell.triangles.size();
				made.around = place == kAround;
				made.closed = is_closed;
				for (std::size_t i = mesh.first_triangle; i < mesh.first_triangle + mesh.triangle_count; ++i)
				{
					const bool closed_here = mesh.closed || (!closed.empty() && closed[i] != 0);
					if (places[i] == place && closed_here == is_closed)
					{
						cell.triangles.push_back(level.triangles[i]);
						cell.materials.push_back(level.materials[i]);
					}
				}
				made.triangle_count = cell.triangles.size() - made.first_triangle;
				cell.meshes.push_back(made);
			}
		}
		if (cell.triangles.empty())
		{
			break; // no triangles of its own
		}
	}
	compactLevel(cell, std::vector<uint8_t>(cell.triangles.size(), 1), threads);
	return cell;
}

std::vector<Bounds> gridOf(const Level& level, glm::uvec3 counts)
{
	const Bounds all = boundsOf(level);
	const glm::dvec3 size = all.most - all.least;
	const auto at = [&](glm::uvec3 index)
	{
		glm::dvec3 corner = all.least + size * glm::dvec3(index) / glm::dvec3(counts);
		for (int axis = 0; axis < 3; ++axis)
		{
			// Boxes are half-open: a surface may coincide with the level's bounds, and rounding may move its centre outside.
			const double more = 1e-6 * (1.0 + size[axis]);
			corner[axis] = index[axis] == 0              ? all.least[axis] - more
						   : index[axis] == counts[axis] ? all.most[axis] + more
														 : corner[axis];
		}
		return corner;
	};
	std::vector<Bounds> boxes;
	for (unsigned z = 0; z < counts.z; ++z)
	{
		for (unsigned y = 0; y < counts.y; ++y)
		{
			for (unsigned x = 0; x < counts.x; ++x)
			{
				boxes.push_back({at({x, y, z}), at({x + 1, y + 1, z + 1})});
			}
		}
	}
	return boxes;
}

} // namespace nook
