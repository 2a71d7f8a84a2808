// SPDX-License-Identifier: GPL-3.0-or-later
// Which vertices share a position, which triangles share their corners, which edges are shared by how many: in linear time, and
// with the same result on any number of threads.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace nook
{

// For each of `count` things the least index of those equal to it. hash(i) must agree for equal things; equal(i, j) is symmetric
// and transitive.
std::vector<uint32_t> firstEqual(std::size_t count, int threads, const std::function<uint64_t(std::size_t)>& hash,
								 const std::function<bool(std::size_t, std::size_t)>& equal);

// For each vertex the first at exactly its position. Requires finite positions where used; others are themselves.
std::vector<uint32_t> weldPositions(std::span<const glm::dvec3> positions, int threads);

// What is wrong with edges, and the lowest triangle at one.
struct EdgeCount
{
	uint64_t count = 0;
	uint32_t first_triangle = UINT32_MAX;
};

struct EdgeFaults
{
	EdgeCount non_manifold; // edges of more than two triangles of a part
	EdgeCount inconsistent; // edges that both of their triangles run along the same way
};

// Triangles (of welded vertices, three different ones each) with skip[i] ≠ 0 are left out; only those of the same part (parts[i])
// count as neighbours; triangles of a part are consecutive.
EdgeFaults findEdgeFaults(std::span<const glm::uvec3> triangles, std::span<const uint8_t> skip, std::span<const uint32_t> parts,
						  std::size_t vertex_count, int threads);

} // namespace nook
