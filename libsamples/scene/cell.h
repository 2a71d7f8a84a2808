// SPDX-License-Identifier: GPL-3.0-or-later
// A level and a box → what lies in the box, and around it what it takes for the same light as in the whole level.
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
	double around_m = 0.0; // ≥ 0: how far surroundings reach beyond the box and the cell's own triangles
};

// Triangles whose centre is in the box, its least faces with it and its greatest ones without, so that each triangle of a level is
// in one cell of a grid; in meshes behind them those of the surroundings (Mesh::around), whose bounds come as near as that. All are
// as they were, none is cut. `closed`: 1 for triangles of closed surfaces, one each (Mesh::closed); empty: none is known to be.
// Cameras in the box stay. No triangle of its own: the level is empty.
Level cutCell(const Level& level, const CellSettings& settings, std::span<const uint8_t> closed, int threads);

// Boxes of a grid of counts.x × counts.y × counts.z cells of one size over all of a level, x fastest, then y and z. The last ones
// reach a little further, so that all triangles are in one.
std::vector<Bounds> gridOf(const Level& level, glm::uvec3 counts);

} // namespace nook
