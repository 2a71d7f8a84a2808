// SPDX-License-Identifier: GPL-3.0-or-later
// The text of an OBJ or MTL file → the text that makes Assimp 5.2.5 read what the file says. It counts words that begin with a
// digit or a sign as numbers, stops at what it does not know in one, and takes a line for what its first letter says.
#pragma once

#include <optional>
#include <string>

namespace nook
{

// None: as it is. Throws Error (invalid_input) that names the line, where a number or an index is none.
std::optional<std::string> repairedObj(const std::string& text, const std::string& path);

// Keeps what a level needs: names, opacities, and the pictures of opacity and colour. As above.
std::optional<std::string> repairedMtl(const std::string& text, const std::string& path);

} // namespace nook
