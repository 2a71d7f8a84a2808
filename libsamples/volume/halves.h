// SPDX-License-Identifier: GPL-3.0-or-later
// A long convex polygon → pieces.
#pragma once

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace nook::detail
{

// Cuts a convex, flat polygon in the middle, along or across its longest edge, until pieces are at most `longest_m` long both ways
// and have at most `most_corners` ≥ 4 corners. The pieces' area is the polygon's; those without any are left out.
std::vector<std::vector<glm::dvec3>> halvedPolygon(std::span<const glm::dvec3> corners, double longest_m, std::size_t most_corners);

// How many pieces that makes, at most.
double halvesOf(std::span<const glm::dvec3> corners, double longest_m);

} // namespace nook::detail
