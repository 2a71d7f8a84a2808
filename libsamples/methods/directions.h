// SPDX-License-Identifier: GPL-3.0-or-later
// The directions of masks (mask.glsl), with the threshold of each.
#pragma once

#include <glm/vec4.hpp>

#include <vector>

namespace nook
{

inline constexpr int kLeastDirections = 32;
inline constexpr int kMostDirections = 256;

// `count` unit directions around z, the steepest first, each for an equal share of the hemisphere weighted by the cosine; w: a
// threshold in (0, 1), spread evenly over the directions of any part of the hemisphere. Requires a multiple of 32 within the
// limits.
std::vector<glm::vec4> maskDirections(int count);

} // namespace nook
