// SPDX-License-Identifier: GPL-3.0-or-later
// The C++ that fills the uniform block (methods/runtime/nook_block.h) → JavaScript that computes the same numbers.
//
// It translates structs of numbers with defaults, a member a line, whose comment is behind it or on lines before it; inline
// functions whose statements are declarations, assignments, if, for and return; arrays; texts; static_cast around the
// whole right side; the functions of <cmath> that both languages round alike.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct ScriptField
{
	std::string type; // of C++: "double"
	std::string name;
	std::string value; // the default, in JavaScript
	std::string meaning;
};

struct ScriptText
{
	std::string functions;             // with their comments
	std::vector<ScriptField> settings; // of nook_settings
};

// Throws Error (runtime) for a statement that it does not know.
ScriptText scriptOf(std::string_view header);

} // namespace nook
