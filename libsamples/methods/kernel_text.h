// SPDX-License-Identifier: GPL-3.0-or-later
// The text of shared kernels (methods/kernels/*.glsl) → single functions, and these with values put in for what is known when a
// module is made.
//
// A function's comment comes right before it, an empty line before that. Directives are #if, #elif, #else and #endif, each on a
// line of its own, around whole statements; they ask for one constant: NAME, !NAME, or NAME compared with a number.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct KernelFunction
{
	std::string name;
	std::string comment;    // with "//", or empty
	std::string text;       // from the return type to the brace; a macro: its line
	std::size_t credit = 0; // index of the file's head comment
};

struct KernelText
{
	std::vector<std::string> credits;      // of each file: the first paragraph of its head comment, without the licence
	std::vector<KernelFunction> functions; // of all files, in order; a function uses only earlier ones
};

// Throws Error (runtime) for a line that is neither comment, macro nor function.
KernelText parseKernels(const std::vector<std::string_view>& files);

// All identifiers outside comments, but for members behind a point.
std::set<std::string> identifiersOf(std::string_view text);

// Exchanges whole identifiers.
std::string renamed(const std::string& text, const std::map<std::string, std::string>& names);

// Puts values in for constants ("NOOK_SAMPLES" → "9"), in comments too, and leaves out the blocks whose conditions are not met.
// Throws Error (runtime) for a condition that no number decides.
std::string resolved(std::string_view text, const std::map<std::string, std::string>& constants);

} // namespace nook
