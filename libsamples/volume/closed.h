// SPDX-License-Identifier: GPL-3.0-or-later
// A level → which of its surfaces are closed, before a part of it is cut out and cannot tell any more.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

#include <cstdint>
#include <vector>

namespace nook
{

// 1 for opaque triangles whose piece of surface is closed with its fronts outside: those that Sides::automatic takes for one-sided.
std::vector<uint8_t> closedTriangles(const Level& level, const RunSettings& run);

} // namespace nook
