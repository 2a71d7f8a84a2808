// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/topology.h"

#include "core/parallel.h"
#include "core/random.h"

#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr std::size_t kBuckets = 256; // by the hash's top bits; each then fits a cache and belongs to one thread

std::size_t blocksOf(std::size_t count)
{
	return (count + kParallelBlock - 1) / kParallelBlock;
}

// Indices sorted by bucket, in order within each.
struct Buckets
{
	std::vector<uint32_t> items;
	std::array<std::size_t, kBuckets + 1> starts{};
};

Buckets bucketsOf(std::span<const uint64_t> hashes, int threads)
{
	const std::size_t blocks = blocksOf(hashes.size());
	std::vector<std::array<uint32_t, kBuckets>> counts(blocks);
	const auto bucketOf = [&](std::size_t i)
	{
		return hashes[i] >> 56U;
	};
	parallelForAll(hashes.size(), threads, [&](std::size_t i) { counts[i / kParallelBlock][bucketOf(i)] += 1; });
	Buckets buckets;
	buckets.items.resize(hashes.size());
	std::size_t at = 0;
	for (std::size_t bucket = 0; bucket < kBuckets; ++bucket)
	{
		buckets.starts[bucket] = at;
		for (std::size_t block = 0; block < blocks; ++block)
		{
			const uint32_t count = counts[block][bucket];
			counts[block][bucket] = static_cast<uint32_t>(at); // start of this block's indices
			at += count;
		}
	}
	buckets.starts[kBuckets] = at;
	parallelForAll(hashes.size(), threads,
				   [&](std::size_t i) { buckets.items[counts[i / kParallelBlock][bucketOf(i)]++] = static_cast<uint32_t>(i); });
	return buckets;
}

void add(EdgeCount& into, const EdgeCount& other)
{
	into.count += other.count;
	into.first_triangle = std::min(into.first_triangle, other.first_triangle);
}

} // namespace

std::vector<uint32_t> firstEqual(std::size_t count, int threads, const std::function<uint64_t(std::size_t)>& hash,
								 const std::function<bool(std::size_t, std::size_t)>& equal)
{
	std::vector<uint64_t> hashes(count);
	parallelForAll(count, threads, [&](std::size_t i) { hashes[i] = mixBits(hash(i)); });
	const Buckets buckets = bucketsOf(hashes, threads);
	std::vector<uint32_t> first(count);
	parallelFor(kBuckets, threads,
				[&](std::size_t bucket)
				{
					const std::span<const uint32_t> items(buckets.items.data() + buckets.starts[bucket],
														  buckets.starts[bucket + 1] - buckets.starts[bucket]);
					// Open addressing, at most half full; items are inserted in order, so the first one stays.
					std::vector<uint32_t> table(std::bit_ceil(2 * items.size() + 1), UINT32_MAX);
					for (const uint32_t item : items)
					{
						std::size_t at = hashes[item] & (table.size() - 1);
						while (table[at] != UINT32_MAX && !(hashes[table[at]] == hashes[item] && equal(table[at], item)))
						{
							at = (at + 1) & (table.size() - 1);
						}
						if (table[at] == UINT32_MAX)
						{
							table[at] = item;
						}
						first[item] = table[at];
					}
				});
	return first;
}

std::vector<uint32_t> weldPositions(std::span<const glm::dvec3> positions, int threads)
{
	const auto hash = [&](std::size_t i)
	{
		const glm::dvec3 p = positions[i];
		if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z))
		{
			return uint64_t{i}; // equal to none; a common hash would collide
		}
		// −0 and +0 are equal: adding +0 makes both +0.
		uint64_t value = mixBits(std::bit_cast<uint64_t>(p.x + 0.0));
		value = mixBits(value + std::bit_cast<uint64_t>(p.y + 0.0));
		return value + std::bit_cast<uint64_t>(p.z + 0.0);
	};
	return firstEqual(positions.size(), threads, hash, [&](std::size_t i, std::size_t j) { return positions[i] == positions[j]; });
}

EdgeTable::EdgeTable(std::span<const glm::uvec3> triangles, std::span<const uint8_t> skip, std::size_t vertex_count, int threads)
	: m_ends(vertex_count, 0)
{
	assert(triangles.size() < UINT32_MAX / 2);
	const auto forSides = [&](const auto& use)
	{
		for (std::size_t i = 0; i < triangles.size(); ++i)
		{
			for (int corner = 0; corner < 3 && (skip.empty() || skip[i] == 0); ++corner)
			{
				use(triangles[i][corner], triangles[i][(corner + 1) % 3], static_cast<uint32_t>(i));
			}
		}
	};
	// Counting sort by the lower vertex. Filling moves each start to its end.
	forSides([&](uint32_t a, uint32_t b, uint32_t) { m_ends[std::min(a, b)] += 1; });
	uint32_t start = 0;
	for (uint32_t& end : m_ends)
	{
		start += std::exchange(end, start);
	}
	m_sides.resize(start);
	forSides(
		[&](uint32_t a, uint32_t b, uint32_t triangle) {
			m_sides[m_ends[std::min(a, b)]++] = {std::max(a, b), 2 * triangle + (a > b ? 1 : 0)};
		});
	parallelForAll(vertex_count, threads,
				   [&](std::size_t vertex)
				   {
					   const std::size_t begin = vertex == 0 ? 0 : m_ends[vertex - 1];
					   std::sort(m_sides.begin() + static_cast<std::ptrdiff_t>(begin),
								 m_sides.begin() + static_cast<std::ptrdiff_t>(m_ends[vertex]));
				   });
}

EdgeFaults findEdgeFaults(const EdgeTable& edges, std::span<const uint32_t> parts, int threads)
{
	const std::size_t blocks = blocksOf(edges.vertexCount());
	std::vector<EdgeFaults> found(blocks);
	const auto judge = [&](EdgeFaults& faults, std::span<const HalfEdge> sides)
	{
		if (sides.size() > 2)
		{
			add(faults.non_manifold, {1, sides[0].triangle()});
		}
		else if (sides.size() == 2 && !isPair(sides))
		{
			add(faults.inconsistent, {1, sides[0].triangle()});
		}
	};
	parallelFor(blocks, threads,
				[&](std::size_t block)
				{
					edges.each(block * kParallelBlock, std::min(edges.vertexCount(), (block + 1) * kParallelBlock),
							   [&](std::span<const HalfEdge> edge)
							   { eachPart(edge, parts, [&](std::span<const HalfEdge> sides) { judge(found[block], sides); }); });
				});
	EdgeFaults faults;
	for (const EdgeFaults& part : found)
	{
		add(faults.non_manifold, part.non_manifold);
		add(faults.inconsistent, part.inconsistent);
	}
	return faults;
}

} // namespace nook
