// SPDX-License-Identifier: GPL-3.0-or-later
// Halved at the median of the boxes' middles along the longest axis, down to a few triangles.
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

} // namespace

TriangleTree::TriangleTree(const Level& level, std::span<const uint8_t> counted, int threads)
{
	assert(counted.size() == level.triangles.size());
	for (std::size_t i = 0; i < counted.size(); ++i)
	{
		if (counted[i] != 0)
		{
			m_triangles.push_back(static_cast<uint32_t>(i));
		}
	}
	if (m_triangles.empty())
	{
		return;
	}
	const auto cornersOf = [&](uint32_t triangle)
	{
		const glm::uvec3 corner = level.triangles[triangle];
		return std::array{level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]};
	};

	struct Range
	{
		std::size_t node;
		std::size_t first;
		std::size_t last;
	};
	// A subtree of n triangles has a number of nodes that depends on n alone, so that every place in the list is known beforehand.
	const auto nodesOf = [](auto&& self, std::size_t n) -> std::size_t
	{
		return n <= kLeaf ? 1 : 1 + self(self, n / 2) + self(self, n - n / 2);
	};
	m_nodes.resize(nodesOf(nodesOf, m_triangles.size()));
	std::vector<std::array<float, 3>> middles(level.triangles.size()); // only where to cut: 32 bits will do
	parallelFor((m_triangles.size() + 4095) / 4096, threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * 4096; i < std::min(m_triangles.size(), (block + 1) * 4096); ++i)
					{
						const auto [a, b, c] = cornersOf(m_triangles[i]);
						const glm::dvec3 middle = 0.5 * (glm::min(a, glm::min(b, c)) + glm::max(a, glm::max(b, c)));
						middles[m_triangles[i]] = {static_cast<float>(middle.x), static_cast<float>(middle.y),
												   static_cast<float>(middle.z)};
					}
				});

	// Fills one node; says where its halves are.
	const auto split = [&](const Range& range) -> std::array<Range, 2>
	{
		Node& node = m_nodes[range.node];
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
		const std::size_t n = range.last - range.first;
		if (n <= kLeaf)
		{
			node.first = static_cast<uint32_t>(range.first);
			node.count = static_cast<uint32_t>(n);
			return {};
		}
		const glm::dvec3 size = node.most - node.least;
		const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
		const std::size_t half = range.first + n / 2;
		const auto at = [&](std::size_t i)
		{
			return m_triangles.begin() + static_cast<std::ptrdiff_t>(i);
		};
		std::nth_element(at(range.first), at(half), at(range.last),
						 [&](uint32_t a, uint32_t b)
						 { return middles[a][axis] != middles[b][axis] ? middles[a][axis] < middles[b][axis] : a < b; });
		// nth_element leaves each half in an order of its own making, which differs between libraries.
		const std::size_t second = range.node + 1 + nodesOf(nodesOf, n / 2);
		node.first = static_cast<uint32_t>(second);
		return {Range{range.node + 1, range.first, half}, Range{second, half, range.last}};
	};
	const auto fill = [&](auto&& self, const Range& range) -> void
	{
		for (const Range& half : split(range))
		{
			if (half.last > half.first)
			{
				self(self, half);
			}
		}
	};

	std::vector<Range> open{{0, 0, m_triangles.size()}};
	while (open.size() < 64 && m_triangles.size() > 4096)
	{
		std::vector<Range> next(2 * open.size());
		parallelFor(open.size(), threads,
					[&](std::size_t i)
					{
						const auto halves = split(open[i]);
						next[2 * i] = halves[0];
						next[2 * i + 1] = halves[1];
					});
		open = std::move(next);
	}
	parallelFor(open.size(), threads, [&](std::size_t i) { fill(fill, open[i]); });
	for (Node& node : m_nodes)
	{
		if (node.count > 0)
		{
			std::sort(m_triangles.begin() + node.first, m_triangles.begin() + node.first + node.count);
		}
	}
}

} // namespace nook
