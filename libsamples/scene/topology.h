// SPDX-License-Identifier: GPL-3.0-or-later
// Finds shared positions, triangles with the same corners, and shared edges in linear time, with the same result for any thread
// count.
#pragma once

#include "core/lists.h"

#include <glm/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <utility>
#include <vector>

namespace nook
{

// For each of `count` items the least index of an equal one. hash(i) must agree for equal items; equal(i, j) is symmetric and
// transitive.
std::vector<uint32_t> firstEqual(std::size_t count, int threads, const std::function<uint64_t(std::size_t)>& hash,
								 const std::function<bool(std::size_t, std::size_t)>& equal);

// For each vertex the first one at exactly its position. Requires finite positions where used; others map to themselves.
std::vector<uint32_t> weldPositions(std::span<const glm::dvec3> positions, int threads);

// Union-find; the lowest member represents its group.
class Groups
{
public:
	explicit Groups(std::size_t count) : m_parent(countingFrom(0U, count)) {}
	uint32_t rootOf(uint32_t i)
	{
		while (m_parent[i] != i)
		{
			m_parent[i] = m_parent[m_parent[i]];
			i = m_parent[i];
		}
		return i;
	}
	void join(uint32_t a, uint32_t b)
	{
		if (m_parent[a] != m_parent[b])
		{
			a = rootOf(a);
			b = rootOf(b);
			m_parent[std::max(a, b)] = std::min(a, b);
		}
	}

	// The lowest member of each one's group.
	std::vector<uint32_t> roots() &&
	{
		for (uint32_t& parent : m_parent) // never above the child, so it is already final
		{
			parent = m_parent[parent];
		}
		return std::move(m_parent);
	}

private:
	std::vector<uint32_t> m_parent;
};

// A triangle's edge, stored at its lower vertex.
struct HalfEdge
{
	uint32_t to = 0;   // the higher vertex
	uint32_t side = 0; // twice the triangle's index, plus 1 if it runs from the higher vertex to the lower

	uint32_t triangle() const
	{
		return side / 2;
	}
	bool operator<(const HalfEdge& other) const
	{
		return to != other.to ? to < other.to : side < other.side;
	}
};

// True for two triangles that traverse their edge in opposite directions.
inline bool isPair(std::span<const HalfEdge> edge)
{
	return edge.size() == 2 && edge[0].side % 2 != edge[1].side % 2;
}

// The edges of triangles with three different welded vertices each, without those with skip[i] ≠ 0 (empty: none).
class EdgeTable
{
public:
	EdgeTable(std::span<const glm::uvec3> triangles, std::span<const uint8_t> skip, std::size_t vertex_count, int threads);

	std::size_t vertexCount() const
	{
		return m_ends.size();
	}

	// use(edge) for the edges whose lower vertex is in [first, last): the sides of all triangles of an edge, lowest first.
	template <class Use> void each(std::size_t first, std::size_t last, const Use& use) const
	{
		for (std::size_t vertex = first; vertex < last; ++vertex)
		{
			const std::size_t begin = vertex == 0 ? 0 : m_ends[vertex - 1];
			const std::span<const HalfEdge> sides = std::span(m_sides).subspan(begin, m_ends[vertex] - begin);
			eachRun(
				sides, [](const HalfEdge& a, const HalfEdge& b) { return a.to == b.to; }, use);
		}
	}

private:
	std::vector<HalfEdge> m_sides; // sorted by their lower vertex
	std::vector<uint32_t> m_ends;  // per vertex: end of its sides
};

// use(sides) for each part (parts[triangle]) of an edge's sides; triangles of a part are consecutive.
template <class Use> void eachPart(std::span<const HalfEdge> edge, std::span<const uint32_t> parts, const Use& use)
{
	eachRun(
		edge, [&parts](const HalfEdge& a, const HalfEdge& b) { return parts[a.triangle()] == parts[b.triangle()]; }, use);
}

// Number of defective edges, and the lowest triangle at one.
struct EdgeCount
{
	uint64_t count = 0;
	uint32_t first_triangle = UINT32_MAX;
};

struct EdgeFaults
{
	EdgeCount non_manifold; // edges with more than two triangles of a part
	EdgeCount inconsistent; // edges that both of their triangles traverse in the same direction
};

// Only triangles of the same part count as neighbours.
EdgeFaults findEdgeFaults(const EdgeTable& edges, std::span<const uint32_t> parts, int threads);

} // namespace nook
