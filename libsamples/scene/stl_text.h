// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of an STL file → the bytes that make Assimp 5.2.5 read what the file says.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

// None: as it is. Throws Error (invalid_input) where a binary file has not the length that its count calls for, or where text is
// none of the format. `exact`: empty, or all positions in order, where 32 bits round them too much. `solids`: the names of the
// solids in a text.
std::optional<std::string> repairedStl(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact,
									   std::vector<std::string>& solids);

} // namespace nook
