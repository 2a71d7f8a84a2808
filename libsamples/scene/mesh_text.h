// SPDX-License-Identifier: GPL-3.0-or-later
// Rewrites OBJ text so that Assimp 5.2.5 reads it correctly. Assimp counts words that start with a digit or a sign as numbers,
// stops at unknown characters in one, and identifies a line by its first letter.
#pragma once

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace nook
{

// Returns nothing if the text can stay as it is. Throws Error (invalid_input) naming the line of an invalid number or index.
// `exact`: empty, or all positions if 32 bits are not precise enough; the text then has their numbers instead.
std::optional<std::string> repairedObj(const std::string& text, const std::string& path, std::vector<glm::dvec3>& exact);

// The position whose number Assimp read.
glm::dvec3 exactPosition(const std::vector<glm::dvec3>& exact, glm::vec3 number);

// Rewrites PLY files so that Assimp 5.2.5 reads them correctly. Assimp loops forever on a truncated file, trusts counts, and loses
// the first byte of some files.

// Returns nothing if the bytes can stay as they are. Throws Error (invalid_input or unsupported) if the file is incomplete.
// `exact`: empty, or all positions in order if 32 bits are not precise enough.
std::optional<std::string> repairedPly(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact);

// Rewrites STL files so that Assimp 5.2.5 reads them correctly.

// Returns nothing if the bytes can stay as they are. Throws Error (invalid_input) if a binary file's length does not match its
// count, or if text is malformed. `exact`: empty, or all positions in order if 32 bits are not precise enough. `solids`: the names
// of the solids in a text file.
std::optional<std::string> repairedStl(const std::string& bytes, const std::string& path, std::vector<glm::dvec3>& exact,
									   std::vector<std::string>& solids);

} // namespace nook
