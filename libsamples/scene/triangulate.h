// SPDX-License-Identifier: GPL-3.0-or-later
// A polygon in space → triangles over its own corners, concave ones and ones with holes cut in along bridges included.
#pragma once

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// Adds triangles as indices into `corners` to `triangles`; their winding is the polygon's. Requires ≥ 3 corners, finite.
// False where it has no area, or no ear is left before the end, as with most polygons that cross themselves: some triangle is a
// guess then. O(n · reflex corners).
bool triangulate(std::span<const glm::dvec3> corners, std::vector<glm::uvec3>& triangles);

} // namespace nook
