// SPDX-License-Identifier: GPL-3.0-or-later
// The members of the kernels' uniform block as a table, and as GLSL.
#pragma once

#include "methods/kernels.h"

#include <cstddef>
#include <map>
#include <span>
#include <string>

namespace nook
{

struct BlockMember
{
	const char* type; // of GLSL
	const char* name;
	const char* meaning; // one line
	std::size_t offset;  // in ShadeBlock
};

// Those of modules come first; `all`: those of methods that are never emitted as well.
std::span<const BlockMember> blockMembers(bool all = false);

// Where std140 has the member of that type that comes after `end` bytes, and where that ends.
struct MemberPlace
{
	std::size_t offset = 0;
	std::size_t end = 0;
};
MemberPlace placeOf(const BlockMember& member, std::size_t end);

// A line each, with what it means.
std::string membersGlsl(bool all = false);

// "NOOK_SAMPLES" → its number, for every constant.
std::map<std::string, std::string> constantsOf(const ShadeBlock& block);

} // namespace nook
