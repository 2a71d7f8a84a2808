// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load_parts.h"

#include "core/parallel.h"

#include <algorithm>
#include <cassert>

namespace nook
{
namespace
{

void dropTriangles(Level& level, std::span<const uint8_t> keep)
{
	std::size_t to = 0;
	std::vector<Mesh> meshes;
	for (const Mesh& mesh : level.meshes)
	{
		const std::size_t begin = to;
		for (std::size_t i = mesh.first_triangle; i < mesh.first_triangle + mesh.triangle_count; ++i)
		{
			if (keep[i] != 0)
			{
				level.triangles[to] = level.triangles[i];
				level.materials[to] = level.materials[i];
				to += 1;
			}
		}
		if (to > begin)
		{
			Mesh& kept = meshes.emplace_back(mesh);
			kept.first_triangle = begin;
			kept.triangle_count = to - begin;
		}
	}
	level.triangles.resize(to);
	level.materials.resize(to);
	level.meshes = std::move(meshes);
}

void dropVertices(Level& level, int threads, std::vector<glm::vec2>* more)
{
	std::vector<uint8_t> used(level.positions.size(), 0);
	for (const glm::uvec3& t : level.triangles)
	{
		used[t.x] = used[t.y] = used[t.z] = 1;
	}
	if (std::find(used.begin(), used.end(), 0) == used.end())
	{
		return;
	}
	std::vector<uint32_t> moved(used.size());
	uint32_t to = 0;
	for (std::size_t i = 0; i < used.size(); ++i)
	{
		moved[i] = to;
		if (used[i] != 0)
		{
			level.positions[to] = level.positions[i];
			level.normals[to] = level.normals[i];
			level.uvs[to] = level.uvs[i];
			if (more != nullptr)
			{
				(*more)[to] = (*more)[i];
			}
			to += 1;
		}
	}
	level.positions.resize(to);
	level.normals.resize(to);
	level.uvs.resize(to);
	if (more != nullptr)
	{
		more->resize(to);
	}
	parallelForAll(level.triangles.size(), threads,
				   [&](std::size_t i)
				   {
					   glm::uvec3& t = level.triangles[i];
					   t = {moved[t.x], moved[t.y], moved[t.z]};
				   });
}

} // namespace

void compactLevel(Level& level, std::span<const uint8_t> keep, int threads, std::vector<glm::vec2>* more)
{
	assert(keep.size() == level.triangles.size());
	if (std::find(keep.begin(), keep.end(), 0) != keep.end() ||
		std::any_of(level.meshes.begin(), level.meshes.end(), [](const Mesh& mesh) { return mesh.triangle_count == 0; }))
	{
		dropTriangles(level, keep);
	}
	dropVertices(level, threads, more);
}

} // namespace nook
