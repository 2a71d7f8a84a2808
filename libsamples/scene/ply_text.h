// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a PLY file → the bytes that make Assimp 5.2.5 read what the file says. It never ends on one that is cut off, takes
// counts at their word, and loses the first byte of some.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

// None: as it is. Throws Error (invalid_input or unsupported) where the file is not whole. `exact`: empty, or all positions in
// order, where 32 bits round them too much.
std::optional<std::string> repairedPly(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact);

} // namespace nook
