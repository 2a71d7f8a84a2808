// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/block_layout.h"

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
				"w after the projection, of a depth d: x * d + y; z: what device depth is at the far end",
				{"-p[11]", "p[15]", "far_end", "0"}},
	BlockMember{"origin",
				"vec4",
				offsetof(ShadeBlock, origin),
				false,
				"the picture's first pixel in the texture",
				{"settings.x", "settings.y", "0", "0"}},
	BlockMember{"rect",
				"ivec4",
				offsetof(ShadeBlock, rect),
				false,
				"first and last pixel with depth: x, y, x, y",
				{"settings.x - settings.guard", "settings.y - settings.guard", "settings.x + settings.width - 1 + settings.guard",
				 "settings.y + settings.height - 1 + settings.guard"}},
	BlockMember{"depth",
				"vec4",
				offsetof(ShadeBlock, depth),
				false,
				"depth at a device depth t away from the far end: (x + y * t) / (z + w * t)",
				{"above / near_end", "(0.0 - p[15] * turn) / near_end", "below / near_end", "(0.0 - p[11] * turn) / near_end"}},
	BlockMember{"error",
				"vec4",
				offsetof(ShadeBlock, error),
				false,
				"of a depth: x * w * w + y * depth; z: sine of the angle by which a normal may be off",
				{"half_step", "rounding", "normal_error", "0"}},
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
	BlockMember{"volume",
				"vec4",
				offsetof(ShadeBlock, volume),
				false,
				"volumetric obscurance: x thickness of surfaces, y second radius, in the unit of the radius",
				{"settings.thickness", "settings.second_radius > 0.0 ? settings.second_radius : settings.radius", "0", "0"}},
	BlockMember{
		"limits",
		"vec4",
		offsetof(ShadeBlock, limits),
		false,
		"of the bands: below a radius of x pixels the first one's samples, below y the first two's; z, w: most, least pixels",
		{"settings.first_band", "settings.second_band", "most_pixels", "settings.least_pixels"}},
	BlockMember{"count", "ivec4", offsetof(ShadeBlock, count), true, "", {}},
	BlockMember{"features", "ivec4", offsetof(ShadeBlock, features), true, "", {}},
	BlockMember{"bands", "ivec4", offsetof(ShadeBlock, bands), true, "", {}},
	BlockMember{"grid", "ivec4", offsetof(ShadeBlock, grid), true, "", {}},
	BlockMember{
		"statvo",
		"vec4",
		offsetof(ShadeBlock, statvo),
		false,
		"statistical volumetric obscurance: height of the box in radii, slope of psi, its largest and least half side in pixels",
		{"settings.box_height", "settings.slope", "settings.largest_pixels", "least_box"}},
	BlockMember{"layers", "ivec4", offsetof(ShadeBlock, layers), true, "", {}},
	BlockMember{"table", "ivec4", offsetof(ShadeBlock, table), true, "", {}},
	BlockMember{"slices",
				"vec4",
				offsetof(ShadeBlock, slices),
				false,
				"slices: x thickness of surfaces, in radii",
				{"settings.slice_thickness", "0", "0", "0"}},
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
