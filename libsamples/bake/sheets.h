// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of two sides that face against their neighbours → turned, so that fronts of a surface lie on one side of it.
#pragma once

#include "scene/level.h"

#include <cstddef>

namespace nook
{

// Turns each triangle of a material with two sides whose normal is against those around it, by area, at all three of its places:
// its front would else share values with the backs beside it. Draws the same. How many were turned; the same for any number of
// threads.
std::size_t alignSheets(Level& level, int threads);

} // namespace nook
