// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/topology.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr std::size_t kBuckets = 256; // by the hash's top bits; each is then small enough for a cache and one thread's own

std::size_t blocksOf(std::size_t count)
{
	return (count + kParallelBlock - 1) / kParallelBlock;
}

// splitmix64's finaliser (Sebastiano Vigna, 2015).
uint64_t mixed(uint64_t x)
{
	x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
	x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
	return x ^ (x >> 31U);
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
	parallelFor(blocks, threads,
				[&](std::size_t block)
				{
					counts[block] = {};
					for (std::size_t i = block * kParallelBlock; i < std::min(hashes.size(), (block + 1) * kParallelBlock); ++i)
					{
						counts[block][bucketOf(i)] += 1;
					}
				});
	Buckets buckets;
	buckets.items.resize(hashes.size());
	std::size_t at = 0;
	for (std::size_t bucket = 0; bucket < kBuckets; ++bucket)
	{
		buckets.starts[bucket] = at;
		for (std::size_t block = 0; block < blocks; ++block)
		{
			const uint32_t count = counts[block][bucket];
			counts[block][bucket] = static_cast<uint32_t>(at); // where this block's begin
			at += count;
		}
	}
	buckets.starts[kBuckets] = at;
	parallelFor(blocks, threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kParallelBlock; i < std::min(hashes.size(), (block + 1) * kParallelBlock); ++i)
					{
						buckets.items[counts[block][bucketOf(i)]++] = static_cast<uint32_t>(i);
					}
				});
	return buckets;
}

// An edge as seen from its lower vertex.
struct HalfEdge
{
	uint32_t to = 0;       // the higher vertex
	uint32_t triangle = 0; // twice its index, and 1 where it runs from the higher vertex to the lower

	bool operator<(const HalfEdge& other) const
	{
		return to != other.to ? to < other.to : triangle < other.triangle;
	}
};

void count(EdgeCount& into, uint32_t triangle)
{
	into.count += 1;
	into.first_triangle = std::min(into.first_triangle, triangle);
}

void merge(EdgeCount& into, const EdgeCount& other)
{
	into.count += other.count;
	into.first_triangle = std::min(into.first_triangle, other.first_triangle);
}

// Half-edges of one lower vertex, sorted: runs of the same higher vertex and the same part are an edge.
void judge(std::span<const HalfEdge> edges, std::span<const uint32_t> parts, EdgeFaults& faults)
{
	for (std::size_t begin = 0; begin < edges.size();)
	{
		const uint32_t part = parts[edges[begin].triangle / 2];
		std::size_t end = begin + 1;
		while (end < edges.size() && edges[end].to == edges[begin].to && parts[edges[end].triangle / 2] == part)
		{
			++end;
		}
		if (end - begin > 2)
		{
			count(faults.non_manifold, edges[begin].triangle / 2);
		}
		else if (end - begin == 2 && edges[begin].triangle % 2 == edges[begin + 1].triangle % 2)
		{
			count(faults.inconsistent, edges[begin].triangle / 2);
		}
		begin = end;
	}
}

} // namespace

std::vector<uint32_t> firstEqual(std::size_t count, int threads, const std::function<uint64_t(std::size_t)>& hash,
								 const std::function<bool(std::size_t, std::size_t)>& equal)
{
	std::vector<uint64_t> hashes(count);
	parallelFor(blocksOf(count), threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * kParallelBlock; i < std::min(count, (block + 1) * kParallelBlock); ++i)
					{
						hashes[i] = mixed(hash(i));
					}
				});
	const Buckets buckets = bucketsOf(hashes, threads);
	std::vector<uint32_t> first(count);
	parallelFor(kBuckets, threads,
				[&](std::size_t bucket)
				{
					const std::span<const uint32_t> items(buckets.items.data() + buckets.starts[bucket],
														  buckets.starts[bucket + 1] - buckets.starts[bucket]);
					// Open addressing, at most half full; items come in order, so that the first one stays.
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
			return uint64_t{i}; // equal to none: else all of them would meet in one place
		}
		// −0 and +0 are equal: adding +0 makes both +0.
		uint64_t value = mixed(std::bit_cast<uint64_t>(p.x + 0.0));
		value = mixed(value + std::bit_cast<uint64_t>(p.y + 0.0));
		return value + std::bit_cast<uint64_t>(p.z + 0.0);
	};
	return firstEqual(positions.size(), threads, hash, [&](std::size_t i, std::size_t j) { return positions[i] == positions[j]; });
}

EdgeFaults findEdgeFaults(std::span<const glm::uvec3> triangles, std::span<const uint8_t> skip, std::span<const uint32_t> parts,
						  std::size_t vertex_count, int threads)
{
	assert(triangles.size() < UINT32_MAX / 2);
	// Half-edges sorted by their lower vertex, by counting.
	std::vector<uint32_t> starts(vertex_count + 1, 0);
	const auto forEdges = [&](const auto& use)
	{
		for (std::size_t i = 0; i < triangles.size(); ++i)
		{
			for (int corner = 0; corner < 3 && skip[i] == 0; ++corner)
			{
				use(triangles[i][corner], triangles[i][(corner + 1) % 3], static_cast<uint32_t>(i));
			}
		}
	};
	forEdges([&](uint32_t a, uint32_t b, uint32_t) { starts[std::min(a, b) + 1] += 1; });
	for (std::size_t i = 0; i < vertex_count; ++i)
	{
		starts[i + 1] += starts[i];
	}
	std::vector<HalfEdge> edges(starts[vertex_count]);
	forEdges(
		[&](uint32_t a, uint32_t b, uint32_t triangle) {
			edges[starts[std::min(a, b)]++] = {std::max(a, b), 2 * triangle + (a > b ? 1 : 0)};
		});
	// Filling has moved every start to its end, which is the next one's start.
	const std::size_t blocks = blocksOf(vertex_count);
	std::vector<EdgeFaults> found(blocks);
	parallelFor(blocks, threads,
				[&](std::size_t block)
				{
					for (std::size_t vertex = block * kParallelBlock; vertex < std::min(vertex_count, (block + 1) * kParallelBlock);
						 ++vertex)
					{
						const std::size_t begin = vertex == 0 ? 0 : starts[vertex - 1];
						const std::span<HalfEdge> of_vertex(edges.data() + begin, starts[vertex] - begin);
						std::sort(of_vertex.begin(), of_vertex.end());
						judge(of_vertex, parts, found[block]);
					}
				});
	EdgeFaults faults;
	for (const EdgeFaults& part : found)
	{
		merge(faults.non_manifold, part.non_manifold);
		merge(faults.inconsistent, part.inconsistent);
	}
	return faults;
}

} // namespace nook
