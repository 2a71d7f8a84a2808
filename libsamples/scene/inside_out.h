// SPDX-License-Identifier: GPL-3.0-or-later
// Finds closed parts whose triangles face inward.
#pragma once

#include "scene/level.h"
#include "scene/topology.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

struct InsideOutPart
{
	std::size_t first_triangle = 0;
	double volume_m3 = 0.0; // signed: negative
};

// A part consists of triangles connected by edges; it is closed if every edge has two triangles in opposite directions. If more
// than two meet, those of one mesh (meshes[triangle]) are paired. Excluded are
// - parts that look the same from both sides (both_sides[triangle] ≠ 0 for all of their triangles),
// - rooms: parts around another part or a camera,
// - cavities: parts inside closed parts that face outward.
// Sorted by the first triangle. Triangles that the edge table excludes belong to no part.
std::vector<InsideOutPart> insideOutParts(const Level& level, const EdgeTable& edges, std::span<const uint32_t> meshes,
										  std::span<const uint8_t> both_sides);

} // namespace nook
