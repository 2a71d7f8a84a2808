// SPDX-License-Identifier: GPL-3.0-or-later
// The text of an OBJ file → the text that makes Assimp 5.2.5 read what the file says. It counts words that begin with a
// digit or a sign as numbers, stops at what it does not know in one, and takes a line for what its first letter says.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

// None: as it is. Throws Error (invalid_input) that names the line, where a number or an index is none. `exact`: empty, or all
// positions, where 32 bits round them too much; the text then has their numbers in their place.
std::optional<std::string> repairedObj(const std::string& text, const std::string& path, std::vector<glm::dvec3>& exact);

// The position whose number stands in its place.
glm::dvec3 exactPosition(const std::vector<glm::dvec3>& exact, glm::vec3 number);

} // namespace nook
