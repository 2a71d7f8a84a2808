// SPDX-License-Identifier: GPL-3.0-or-later
// Split at the median of the boxes' centres along the longest axis, down to a few triangles.
// Not Embree's tree, whose 32-bit boxes would miss what just touches a volume. Not CGAL's, whose order depends on the standard
// library's nth_element, so that a search would stop at different triangles on different systems.
#include "volume/triangle_tree.h"

#include "core/parallel.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cassert>

namespace nook
{
namespace
{

constexpr std::size_t kLeaf = 4;
constexpr std::size_t kTreeBlock = 4096; // minimum triangles per thread

// The number of nodes of a subtree depends only on n, so that all positions in the list are known in advance.
std::size_t nodesOf(std::size_t n)
{
	return n <= kLeaf ? 1 : 1 + nodesOf(n / 2) + nodesOf(n - n / 2);
}

std::vector<uint32_t> indicesOf(std::span<const uint8_t> counted)
{
	std::vector<uint32_t> indices;
	for (std::size_t i = 0; i < counted.size(); ++i)
	{
		if (counted[i] != 0)
		{
			indices.push_back(static_cast<uint32_t>(i));
		}
	}
	return indices;
}

} // namespace

// A subtree's first node and its triangles. Empty: none.
struct TriangleTree::Range
{
	std::size_t node;
	std::size_t first;
	std::size_t last;
};

class TriangleTree::Builder
{
public:
	Builder(TriangleTree& tree, const Level& level, int threads)
		: m_nodes(tree.m_nodes), m_triangles(tree.m_triangles), m_level(level), m_middles(level.triangles.size())
	{
		parallelFor((m_triangles.size() + kTreeBlock - 1) / kTreeBlock, threads,
					[&](std::size_t block)
					{
						for (std::size_t i = block * kTreeBlock; i < std::min(m_triangles.size(), (block + 1) * kTreeBlock); ++i)
						{
							findMiddle(m_triangles[i]);
						}
					});
	}

	// Fills one node and returns the ranges of its halves.
	std::array<Range, 2> split(const Range& range)
	{
		Node& node = m_nodes[range.node];
		findBounds(node, range);
		const std::size_t n = range.last - range.first;
		if (n <= kLeaf)
		{
			// The order left by nth_element differs between libraries.
			std::sort(at(range.first), at(range.last));
			node.first = static_cast<uint32_t>(range.first);
			node.count = static_cast<uint32_t>(n);
			return {};
		}
		const glm::dvec3 size = node.most - node.least;
		const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
		const std::size_t half = range.first + n / 2;
		std::nth_element(at(range.first), at(half), at(range.last),
						 [&](uint32_t a, uint32_t b)
						 { return m_middles[a][axis] != m_middles[b][axis] ? m_middles[a][axis] < m_middles[b][axis] : a < b; });
		const std::size_t second = range.node + 1 + nodesOf(n / 2);
		node.first = static_cast<uint32_t>(second);
		return {Range{range.node + 1, range.first, half}, Range{second, half, range.last}};
	}

	void fill(const Range& range)
	{
		for (const Range& half : split(range))
		{
			if (half.last > half.first)
			{
				fill(half);
			}
		}
	}

private:
	std::array<glm::dvec3, 3> cornersOf(uint32_t triangle) const
	{
		const glm::uvec3 corner = m_level.triangles[triangle];
		return {m_level.positions[corner.x], m_level.positions[corner.y], m_level.positions[corner.z]};
	}

	void findMiddle(uint32_t triangle)
	{
		const auto [a, b, c] = cornersOf(triangle);
		const glm::dvec3 middle = 0.5 * (glm::min(a, glm::min(b, c)) + glm::max(a, glm::max(b, c)));
		m_middles[triangle] = {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z)};
	}

	void findBounds(Node& node, const Range& range) const
	{
		node.least = glm::dvec3(1e300);
		node.most = glm::dvec3(-1e300);
		for (std::size_t i = range.first; i < range.last; ++i)
		{
			for (const glm::dvec3& corner : cornersOf(m_triangles[i]))
			{
				node.least = glm::min(node.least, corner);
				node.most = glm::max(node.most, corner);
			}
		}
	}

	std::vector<uint32_t>::iterator at(std::size_t i)
	{
		return m_triangles.begin() + static_cast<std::ptrdiff_t>(i);
	}

	std::vector<Node>& m_nodes;
	std::vector<uint32_t>& m_triangles;
	const Level& m_level;
	std::vector<std::array<float, 3>> m_middles; // only used to choose the split, so 32 bits suffice
};

TriangleTree::TriangleTree(const Level& level, std::span<const uint8_t> counted, int threads) : m_triangles(indicesOf(counted))
{
	assert(counted.size() == level.triangles.size());
	if (m_triangles.empty())
	{
		return;
	}
	m_nodes.resize(nodesOf(m_triangles.size()));
	Builder builder(*this, level, threads);
	std::vector<Range> open{{0, 0, m_triangles.size()}};
	while (open.size() < 64 && m_triangles.size() > kTreeBlock)
	{
		std::vector<Range> next(2 * open.size());
		parallelFor(open.size(), threads,
					[&](std::size_t i)
					{
						const auto halves = builder.split(open[i]);
						next[2 * i] = halves[0];
						next[2 * i + 1] = halves[1];
					});
		open = std::move(next);
	}
	parallelFor(open.size(), threads, [&](std::size_t i) { builder.fill(open[i]); });
}

} // namespace nook
