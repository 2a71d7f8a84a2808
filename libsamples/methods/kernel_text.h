// SPDX-License-Identifier: GPL-3.0-or-later
// Splits the text of shared kernels (methods/kernels/*.glsl) into functions, and substitutes constants for the values known when a
// module is generated.
//
// A function's comment directly precedes it, after an empty line. Directives are #if, #elif, #else and #endif, each on its own
// line, around whole statements; a condition tests one constant: NAME, !NAME, or NAME compared with a number.
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
	std::string text;       // from the return type to the closing brace; for a macro its line
	std::size_t credit = 0; // index of the file's head comment
};

struct KernelText
{
	std::vector<std::string> credits;      // per file: the first paragraph of its head comment, without the licence
	std::vector<KernelFunction> functions; // of all files in order; functions use only earlier ones
};

// Throws Error (runtime) for a line that is not part of a comment, macro or function.
KernelText parseKernels(const std::vector<std::string_view>& files);

// The kernels of all screen-space methods.
const KernelText& screenKernels();

// Replaces whole identifiers.
std::string renamed(const std::string& text, const std::map<std::string, std::string>& names);

// Substitutes constants ("NOOK_SAMPLES" → "9"), in comments too, and removes blocks whose conditions are false. Throws Error
// (runtime) for a condition that the constants do not decide.
std::string resolved(std::string_view text, const std::map<std::string, std::string>& constants);

// Collects the functions of a module from the kernels, with their constants filled in and without duplicates.

class FunctionWriter
{
public:
	explicit FunctionWriter(const KernelText& kernels) : m_kernels(kernels) {}

	// Returns the text of a function and everything it needs, without what has already been added.
	std::string add(const std::string& entry, const std::map<std::string, std::string>& constants);

	bool uses(std::string_view name) const;

	// The head comments of all files used.
	std::string credits() const;

private:
	void reach(const std::string& name, const std::map<std::string, std::string>& constants,
			   std::map<std::string, std::string>& texts);

	const KernelText& m_kernels;
	std::map<std::string, std::string> m_written;
	std::set<std::string> m_used;
	std::set<std::size_t> m_credits;
};

} // namespace nook
