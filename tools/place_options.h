// SPDX-License-Identifier: GPL-3.0-or-later
// Points and boxes as words of a command line.
#pragma once

#include "scene/level.h"

#include <glm/vec3.hpp>

#include <string>

namespace nook
{

// "X,Y,Z", metres, each from −1e15 to 1e15. Throws Error (usage) of `option`.
glm::dvec3 positionOf(const std::string& option, const std::string& text);

// "X,Y,Z,X,Y,Z": the least corner first, which the other is nowhere below; as above.
Bounds boxOf(const std::string& option, const std::string& text);

} // namespace nook
