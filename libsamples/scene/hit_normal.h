// SPDX-License-Identifier: GPL-3.0-or-later
// A place on a triangle → the normals that a renderer shades it with.
#pragma once

#include "scene/level.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>

namespace nook
{

// Unit; of the counter-clockwise side. Requires a triangle with an area.
glm::dvec3 geometricNormal(const Level& level, uint32_t triangle);

// Unit: that of the vertices, on the same side as the triangle's own; the triangle's where they have none or cancel out.
// `barycentric`: weights of the second and third vertex.
glm::dvec3 interpolatedNormal(const Level& level, uint32_t triangle, glm::dvec2 barycentric);

} // namespace nook
