// SPDX-License-Identifier: GPL-3.0-or-later
// A level's name → its second texture coordinates, which masks do not use, for textures of light.
#pragma once

#include "scene/load.h"

#include <glm/vec2.hpp>

#include <string>
#include <vector>

namespace nook
{

// TEXCOORD_1 of a glTF, one a vertex of `level`, what loadLevel() made of the same name and settings; NaN for vertices without. The
// level has the same vertices whatever its coordinates are.
// Empty where nothing has any, and for other formats. Reads the file once more; throws as loadLevel(), and Error (invalid_input)
// where it is not the same any more.
std::vector<glm::vec2> loadSecondUvs(const std::string& name, const LoadSettings& settings, const Level& level,
									 const RunSettings& run);

} // namespace nook
