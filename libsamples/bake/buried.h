// SPDX-License-Identifier: GPL-3.0-or-later
// A point of a surface → whether it lies inside matter, where nobody sees it.
#pragma once

#include "scene/tracer.h"

#include <glm/vec3.hpp>

namespace nook
{

// True where at least seven more of nine directions over the hemisphere about `normal` (unit) meet the back of a surface first than
// meet a front: under a box that stands on a floor, in a wall that reaches into another. `origin` is off its own surface. Surfaces
// with a mask have no inside.
bool isBuried(const Tracer& tracer, glm::dvec3 origin, glm::dvec3 normal);

} // namespace nook
