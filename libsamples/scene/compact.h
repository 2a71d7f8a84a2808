// SPDX-License-Identifier: GPL-3.0-or-later
// A level and what stays of it → the level without the rest.
#pragma once

#include "scene/level.h"

#include <cstdint>
#include <span>

namespace nook
{

// Drops the triangles with keep[i] = 0, the vertices that none of the others uses (their indices may be out of range), and the
// meshes that are left empty. The order stays. `more`, one a vertex, goes with the vertices.
void compactLevel(Level& level, std::span<const uint8_t> keep, int threads, std::vector<glm::vec2>* more = nullptr);

} // namespace nook
