// SPDX-License-Identifier: GPL-3.0-or-later
// Bounding-box tree over a level's triangles that finds those reaching into a convex volume. In double precision, so that nothing
// is missed.
#pragma once

#include "scene/level.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// Inside: normal · x ≥ offset.
struct HalfSpace
{
	glm::dvec3 normal{0.0}; // unit
	double offset = 0.0;
};

class TriangleTree
{
public:
	// Contains the triangles with counted[i] ≠ 0. Same tree for any thread count.
	TriangleTree(const Level& level, std::span<const uint8_t> counted, int threads);

	// Calls visit(triangle), until it returns false, for every triangle whose box intersects `box` and is not entirely outside one
	// of the half-spaces; returns false if visit did. Roughly in order of distance from the box's centre.
	template <class Visit> bool visit(const Bounds& box, std::span<const HalfSpace> volume, Visit&& visit) const;

private:
	struct Range;
	class Builder;
	struct Node
	{
		glm::dvec3 least;
		glm::dvec3 most;
		uint32_t first = 0; // leaves: index into m_triangles
		uint32_t count = 0; // 0: inner; its children are the next node and `first`
	};

	// Squared distance of a node's box from a point.
	static double distance2(const Node& node, glm::dvec3 point)
	{
		const glm::dvec3 off = glm::max(glm::dvec3(0.0), glm::max(node.least - point, point - node.most));
		return glm::dot(off, off);
	}
	static bool meets(const Node& node, const Bounds& box, std::span<const HalfSpace> volume);

	std::vector<Node> m_nodes;
	std::vector<uint32_t> m_triangles;
};

inline bool TriangleTree::meets(const Node& node, const Bounds& box, std::span<const HalfSpace> volume)
{
	for (int axis = 0; axis < 3; ++axis)
	{
		if (node.most[axis] < box.least[axis] || node.least[axis] > box.most[axis])
		{
			return false;
		}
	}
	for (const HalfSpace& half : volume)
	{
		// The corner furthest along the normal.
		const double x = half.normal.x * (half.normal.x > 0.0 ? node.most.x : node.least.x);
		const double y = half.normal.y * (half.normal.y > 0.0 ? node.most.y : node.least.y);
		const double z = half.normal.z * (half.normal.z > 0.0 ? node.most.z : node.least.z);
		if (x + y + z < half.offset)
		{
			return false;
		}
	}
	return true;
}

template <class Visit> bool TriangleTree::visit(const Bounds& box, std::span<const HalfSpace> volume, Visit&& visit) const
{
	std::array<uint32_t, 64> stack{}; // 2³² triangles have a depth of 32
	std::size_t size = 0;
	const glm::dvec3 middle = 0.5 * (box.least + box.most);
	if (!m_nodes.empty())
	{
		stack[size++] = 0;
	}
	while (size > 0)
	{
		const uint32_t at = stack[--size];
		const Node& node = m_nodes[at];
		if (!meets(node, box, volume))
		{
			continue;
		}
		if (node.count == 0)
		{
			const bool swap = distance2(m_nodes[node.first], middle) < distance2(m_nodes[at + 1], middle);
			stack[size++] = swap ? at + 1 : node.first;
			stack[size++] = swap ? node.first : at + 1;
			continue;
		}
		for (uint32_t i = 0; i < node.count; ++i)
		{
			if (!visit(m_triangles[node.first + i]))
			{
				return false;
			}
		}
	}
	return true;
}

} // namespace nook
