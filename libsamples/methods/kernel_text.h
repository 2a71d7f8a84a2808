// SPDX-License-Identifier: GPL-3.0-or-later
// The text of shared kernels (methods/kernels/*.glsl) → single functions, and these with values put in for what is known when a module is
// made.
//
// Relies on the kernels' own layout: a function begins in the first column, its closing brace stands there too, and its comment
// comes right before it; every brace has a line of its own.
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

// Puts values in for components ("nook.samples" → "9"), decides the conditions that are then decided, and leaves out what cannot be
// reached and variables that nothing reads.
std::string specialised(const std::string& text, const std::map<std::string, std::string>& constants);

} // namespace nook
