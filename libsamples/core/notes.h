// SPDX-License-Identifier: GPL-3.0-or-later
// Comment lines stored in output files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct Note
{
	std::string key;
	std::string value; // one line
};
using Notes = std::vector<Note>;

// One note per line after `prefix` ("// ", "# "), the command first; ends with a newline.
std::string commentBlock(const Notes& notes, std::string_view prefix);

} // namespace nook
