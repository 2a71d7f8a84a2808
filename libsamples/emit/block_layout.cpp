// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/block_layout.h"

#include "core/error.h"

#include <cstring>
#include <string_view>

namespace nook
{
namespace
{

constexpr std::array kMembers{
	BlockMember{"size",
				"vec4",
				offsetof(ShadeBlock, size),
				false,
				"width and height of the picture in pixels, 1 / width, 1 / height",
				{"width", "height", "1.0 / width", "1.0 / height"}},
	BlockMember{"across_x",
				"vec4",
				offsetof(ShadeBlock, across_x),
				false,
				"of the projection P: 1 / P00, P20 / P00, -P30 / P00 (P20: column 2, row 0)",
				{"1.0 / p[0]", "p[8] / p[0]", "-p[12] / p[0]", "0"}},
	BlockMember{"across_y",
				"vec4",
				offsetof(ShadeBlock, across_y),
				false,
				"1 / P11 (negative where the first row of pixels is that of NDC y = -1), P21 / P11, -P31 / P11",
				{"first_row / p[5]", "p[9] / p[5]", "-p[13] / p[5]", "0"}},
	BlockMember{"w",
				"vec4",
				offsetof(ShadeBlock, w),
				false,
				"w after the projection, of a depth d: x * d + y",
				{"-p[11]", "p[15]", "0", "0"}},
	BlockMember{"radius",
				"vec4",
				offsetof(ShadeBlock, radius),
				false,
				"x: radius in metres, or in the unit of your depths",
				{"settings.radius", "0", "0", "0"}},
	BlockMember{"alchemy",
				"vec4",
				offsetof(ShadeBlock, alchemy),
				false,
				"Alchemy: sigma, contrast k, beta, epsilon",
				{"settings.sigma", "settings.contrast", "settings.beta", "settings.epsilon"}},
	BlockMember{"count", "ivec4", offsetof(ShadeBlock, count), true, "", {}},
	BlockMember{"grid", "ivec4", offsetof(ShadeBlock, grid), true, "", {}},
	BlockMember{"march", "ivec4", offsetof(ShadeBlock, march), true, "", {}},
	BlockMember{"rival", "vec4", offsetof(ShadeBlock, rival), true, "", {}},
};

} // namespace

std::span<const BlockMember> blockMembers()
{
	return kMembers;
}

void checkBlockLayout()
{
	std::size_t offset = 0;
	for (const BlockMember& member : kMembers)
	{
		if (member.offset != offset)
		{
			throw Error(ExitCode::runtime, std::string("block_layout.cpp: ") + member.name + ": found offset " +
											   std::to_string(member.offset) + ", expected " + std::to_string(offset));
		}
		offset += 16;
	}
	if (offset != sizeof(ShadeBlock))
	{
		throw Error(ExitCode::runtime, "block_layout.cpp: found " + std::to_string(offset) + " bytes, expected the " +
										   std::to_string(sizeof(ShadeBlock)) + " of ShadeBlock");
	}
}

std::map<std::string, std::string> constantsOf(const ShadeBlock& block)
{
	std::map<std::string, std::string> constants;
	for (const BlockMember& member : kMembers)
	{
		if (!member.constant || std::string_view(member.type) != "ivec4")
		{
			continue;
		}
		std::array<int, 4> values{};
		std::memcpy(values.data(), reinterpret_cast<const char*>(&block) + member.offset, sizeof values);
		for (std::size_t i = 0; i < 4; ++i)
		{
			constants[std::string("nook.") + member.name + "." + "xyzw"[i]] = std::to_string(values[i]);
		}
	}
	return constants;
}

} // namespace nook
