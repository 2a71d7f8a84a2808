// SPDX-License-Identifier: GPL-3.0-or-later
// A flat outline, with holes if need be → convex polygons.
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

// Lines may touch in corners, not cross. Pieces have corners of the outline only, given as numbers of the points of all loops in a
// row, and at most `most_corners`, ≥ 3. Empty where lines cross.
std::vector<Piece> convexPieces(std::span<const std::vector<glm::dvec2>> loops, std::size_t most_corners);

// Triangles of a mesh, counter-clockwise, joined over common edges as long as they stay convex; overlaps and lines that cross do
// not matter, as nothing but the triangles is looked at. `neighbours`: pairs of triangles with a common edge.
std::vector<Piece> joinTriangles(std::span<const glm::dvec2> points, std::vector<Piece> triangles,
								 std::span<const std::pair<uint32_t, uint32_t>> neighbours, std::size_t most_corners);

// One loop that turns left at every corner, by 360° in all.
bool isConvex(std::span<const glm::dvec2> loop);

// A convex polygon of 0 to count − 1, cut from corner to corner until no piece has more than `most_corners`.
std::vector<Piece> cutConvex(std::size_t count, std::size_t most_corners);

} // namespace nook::detail
