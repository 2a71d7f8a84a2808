// SPDX-License-Identifier: GPL-3.0-or-later
// Partitions a flat outline, possibly with holes, into convex polygons.
#pragma once

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace nook::detail
{

using Piece = std::vector<uint32_t>; // corners, counter-clockwise

// Lines may touch in corners but not cross. Pieces use only corners of the outline, given as indices into the points of all loops
// in a row, and have at most `most_corners` ≥ 3. Empty if lines cross.
std::vector<Piece> convexPieces(std::span<const std::vector<glm::dvec2>> loops, std::size_t most_corners);

// Joins counter-clockwise triangles of a mesh over common edges while they stay convex. Only looks at the triangles, so overlaps
// and crossing lines do not matter. `neighbours`: pairs of triangles with a common edge.
std::vector<Piece> joinTriangles(std::span<const glm::dvec2> points, std::vector<Piece> triangles,
								 std::span<const std::pair<uint32_t, uint32_t>> neighbours, std::size_t most_corners);

// True for a loop that turns left at every corner, by 360° in total.
bool isConvex(std::span<const glm::dvec2> loop);

// A convex polygon with corners 0 to count − 1, cut from corner to corner until no piece has more than `most_corners`.
std::vector<Piece> cutConvex(std::size_t count, std::size_t most_corners);

} // namespace nook::detail
