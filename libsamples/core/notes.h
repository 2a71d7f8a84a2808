// SPDX-License-Identifier: GPL-3.0-or-later
// Lines of text that travel with a file.
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

// The notes, each behind `prefix` ("// ", "# "), the command first; ends with a newline.
std::string commentBlock(const Notes& notes, std::string_view prefix);

} // namespace nook
