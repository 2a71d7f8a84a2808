// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/block_layout.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace nook
{
namespace
{

#define NOOK_ROW(type, name, meaning) BlockMember{#type, #name, meaning, offsetof(ShadeBlock, name)},
constexpr std::array kMembers{NOOK_MODULE_MEMBERS(NOOK_ROW) NOOK_RIVAL_MEMBERS(NOOK_ROW)};
constexpr std::array kModuleMembers{NOOK_MODULE_MEMBERS(NOOK_ROW)};
#undef NOOK_ROW

} // namespace

std::span<const BlockMember> blockMembers(bool all)
{
	return std::span(kMembers).first(all ? kMembers.size() : kModuleMembers.size());
}

MemberPlace placeOf(const BlockMember& member, std::size_t end)
{
	const char last = std::string_view(member.type).back();
	const std::size_t count = last == '2' || last == '4' ? static_cast<std::size_t>(last - '0') : 1;
	const std::size_t bytes = 4 * count;
	const std::size_t offset = (end + bytes - 1) / bytes * bytes;
	return {offset, offset + bytes};
}

std::string membersGlsl(bool all)
{
	std::string text;
	for (const BlockMember& member : blockMembers(all))
	{
		text += "\t" + std::string(member.type) + " " + member.name + "; // " + member.meaning + "\n";
	}
	return text;
}

std::map<std::string, std::string> constantsOf(const ShadeBlock& block)
{
	std::map<std::string, std::string> constants;
	const auto add = [&constants](std::string name, int value)
	{
		std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
		constants["NOOK_" + name] = std::to_string(value);
	};
#define NOOK_ADD(name, value, meaning) add(#name, block.name);
	NOOK_SHADE_CONSTANTS(NOOK_ADD)
#undef NOOK_ADD
	return constants;
}

} // namespace nook
