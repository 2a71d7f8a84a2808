// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/unknowns.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace nook
{
namespace
{

constexpr float kSameNormal = 0.999F; // cosine; visibility differs by some sin 2.6° = 0.045 of what changes with the direction

auto keyOf(glm::dvec3 p)
{
	return std::tuple(p.x, p.y, p.z);
}

// A second value for those whose vertices belong to a triangle of two sides.
void addBacks(const Level& level, Unknowns& unknowns)
{
	constexpr uint32_t kNone = ~0U;
	std::vector<uint32_t> back_of(unknowns.count, kNone);
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		for (int corner = 0; level.material_list[level.materials[t]].two_sided && corner < 3; ++corner)
		{
			back_of[unknowns.of_vertex[level.triangles[t][corner]]] = 0;
		}
	}
	for (uint32_t& back : back_of)
	{
		if (back != kNone)
		{
			back = static_cast<uint32_t>(unknowns.count++);
			unknowns.has_sides = true;
		}
	}
	for (std::size_t v = 0; v < unknowns.of_vertex.size(); ++v)
	{
		const uint32_t back = back_of[unknowns.of_vertex[v]];
		unknowns.of_back[v] = back == kNone ? unknowns.of_vertex[v] : back;
	}
}

} // namespace

std::vector<glm::vec3> vertexNormals(const Level& level)
{
	std::vector<glm::dvec3> sums(level.positions.size(), glm::dvec3(0.0));
	for (const glm::uvec3& t : level.triangles)
	{
		const glm::dvec3 a = level.positions[t.x];
		const glm::dvec3 normal = glm::cross(level.positions[t.y] - a, level.positions[t.z] - a); // twice the area long
		for (int corner = 0; corner < 3; ++corner)
		{
			sums[t[corner]] += normal;
		}
	}
	std::vector<glm::vec3> normals = level.normals;
	for (std::size_t v = 0; v < normals.size(); ++v)
	{
		const double length = glm::length(sums[v]);
		if (normals[v] == glm::vec3(0.0F) && length > 0.0)
		{
			normals[v] = glm::vec3(sums[v] / length);
		}
	}
	return normals;
}

Unknowns unknownsOf(const Level& level, BakeSides sides)
{
	const std::vector<glm::vec3> normals = vertexNormals(level);
	std::vector<uint32_t> order(level.positions.size());
	std::iota(order.begin(), order.end(), 0U);
	std::sort(order.begin(), order.end(),
			  [&](uint32_t a, uint32_t b)
			  {
				  const auto key_a = keyOf(level.positions[a]);
				  const auto key_b = keyOf(level.positions[b]);
				  return key_a != key_b ? key_a < key_b : a < b;
			  });
	// Of each vertex the first one that it shares with; then values are counted in the vertices' order.
	std::vector<uint32_t> first_of(order.size());
	Unknowns unknowns;
	unknowns.place_of_vertex.resize(order.size());
	std::vector<uint32_t> firsts;
	for (std::size_t begin = 0; begin < order.size();)
	{
		std::size_t end = begin;
		firsts.clear();
		for (; end < order.size() && level.positions[order[end]] == level.positions[order[begin]]; ++end)
		{
			const uint32_t v = order[end];
			const auto same = [&](uint32_t other)
			{
				return normals[v] == normals[other] || glm::dot(normals[v], normals[other]) > kSameNormal;
			};
			const auto found = std::find_if(firsts.begin(), firsts.end(), same);
			first_of[v] = found == firsts.end() ? v : *found;
			if (found == firsts.end())
			{
				firsts.push_back(v);
			}
			unknowns.place_of_vertex[v] = order[begin];
		}
		begin = end;
	}
	unknowns.of_vertex.resize(order.size());
	for (std::size_t v = 0; v < order.size(); ++v) // a first one comes before those that share with it
	{
		unknowns.of_vertex[v] = first_of[v] == v ? static_cast<uint32_t>(unknowns.count++) : unknowns.of_vertex[first_of[v]];
	}
	unknowns.of_back = unknowns.of_vertex;
	if (sides == BakeSides::separate)
	{
		addBacks(level, unknowns);
	}
	return unknowns;
}

} // namespace nook
