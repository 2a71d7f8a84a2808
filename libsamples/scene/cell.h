// SPDX-License-Identifier: GPL-3.0-or-later
// Cuts a box out of a level, with the surroundings needed for the same light as in the whole level.
#pragma once

#include "scene/level.h"

#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

struct CellSettings
{
	Bounds box;            // world, metres
	double around_m = 0.0; // ≥ 0: how far surroundings extend beyond the box and the cell's own triangles
};

// Keeps the triangles whose centre is in the box (lower faces included, upper ones excluded), so that each triangle of a level is
// in exactly one cell of a grid. Adds meshes with the surroundings (Mesh::around): triangles whose bounds are that close. No
// triangle is cut. `closed`: 1 for triangles of closed surfaces (Mesh::closed); empty: none is known. Keeps cameras in the box.
// Without triangles of its own the result is empty.
Level cutCell(const Level& level, const CellSettings& settings, std::span<const uint8_t> closed, int threads);

// Boxes of a grid of counts.x × counts.y × counts.z equal cells over a level's bounds, x fastest, then y and z. The last ones
// extend slightly further, so that every triangle is in one.
std::vector<Bounds> gridOf(const Level& level, glm::uvec3 counts);

} // namespace nook
