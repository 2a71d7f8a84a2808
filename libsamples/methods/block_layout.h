// SPDX-License-Identifier: GPL-3.0-or-later
// The members of the kernels' uniform block (methods/kernels.h): what emitted GLSL and C++ say of them, and how the C++ fills them.
// A member of ShadeBlock that is missing here makes checkBlockLayout throw.
#pragma once

#include "methods/kernels.h"

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <string>

namespace nook
{

struct BlockMember
{
	const char* name;
	const char* type; // "vec4" or "ivec4": 16 bytes
	std::size_t offset;
	bool constant; // no member of a module's block: known when the module is made (numbers in its text), or of no emitted kernel
	const char* meaning; // one line
	const char* fill[4]; // C++ that gives the four components from `p` (column-major projection) and `settings`
};

std::span<const BlockMember> blockMembers();

// Throws Error (runtime) where the table and ShadeBlock differ in size or order.
void checkBlockLayout();

// "nook.count.x" → its number, for every component of every constant member.
std::map<std::string, std::string> constantsOf(const ShadeBlock& block);

} // namespace nook
