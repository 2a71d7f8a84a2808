// SPDX-License-Identifier: GPL-3.0-or-later
// Several levels → one.
#pragma once

#include "scene/level.h"

#include <glm/vec3.hpp>

namespace nook
{

// Adds the triangles, meshes, materials, masks, cameras and files of `from`, moved by `move` metres, behind those of `to`. Masks
// with the same texels and materials with the same values are there once. Cameras get names of their own. Requires that vertices
// and triangles of both can be counted by 32 bits.
void appendLevel(Level& to, Level from, glm::dvec3 move);

} // namespace nook
