// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/gl_source.h"

#include "methods/assets.h"
#include "methods/block_layout.h"
#include "methods/kernel_functions.h"

#include <array>

namespace nook
{
namespace
{

constexpr const char* kPrelude = R"(#version 330 core
#define NOOK_SKY 1e30f
layout(std140) uniform NookBlock
{
	vec4 size;
	vec4 across_x;
	vec4 across_y;
	vec4 w;
	vec4 origin;
	ivec4 rect;
	vec4 depth;
	vec4 error;
	vec4 radius;
	vec4 alchemy;
	vec4 volume;
	vec4 limits;
	ivec4 count;
	ivec4 features;
	ivec4 bands;
	ivec4 grid;
	vec4 statvo;
	ivec4 layers;
	ivec4 table;
	vec4 slices;
	ivec4 march;
	vec4 rival;
} nook;
uniform sampler2D nook_depths;
uniform sampler2D nook_normals;
uniform sampler2D nook_samples;
uniform sampler2D nook_cells;
uniform sampler2D nook_levels;
uniform highp usampler2DArray nook_tables;
uniform sampler2D nook_range;

float nookDepth(ivec2 pixel)
{
	return texelFetch(nook_depths, pixel, 0).r;
}
vec3 nookNormal(ivec2 pixel)
{
	return texelFetch(nook_normals, pixel, 0).xyz;
}
float nookVisibility(ivec2 cell)
{
	return texelFetch(nook_cells, cell, 0).r;
}
vec4 nookLevel(ivec2 texel, int level)
{
	return texelFetch(nook_levels, texel, level);
}
uvec4 nookTable(ivec2 texel, int table)
{
	return texelFetch(nook_tables, ivec3(texel, table), 0);
}
vec4 nookRange(int i)
{
	return texelFetch(nook_range, ivec2(i, 0), 0);
}
)";

// Samples of the pixel's cell. Named by the pass's function, as the writer of functions does.
constexpr const char* kSamples = R"(
int nookVariant(ivec2 pixel)
{
	ivec2 cell = pixel / nook.grid.x;
	int own = (cell.y % nook.count.y) * nook.count.y + cell.x % nook.count.y;
	return (own + nook.march.w) % (nook.count.y * nook.count.y);
}
vec4 nookSample(int row, int i)
{
	return texelFetch(nook_samples, ivec2(i, row), 0);
}
)";

constexpr std::array<const char*, 3> kTypes{"float", "vec4", "uvec4"}; // in the order of PictureFormat

const KernelText& kernels()
{
	static const KernelText text = parseKernels({assets::screen_kernels.begin(), assets::screen_kernels.end()});
	return text;
}

} // namespace

std::string glSourceOf(const ShadePass& pass, PictureFormat format)
{
	const std::string entry = pass.kernel.call;
	const std::map<std::string, std::string> constants = constantsOf(pass.block);
	FunctionWriter writer(kernels());
	std::string functions =
		renamed(specialised(kSamples, constants), {{"nookVariant", entry + "Variant"}, {"nookSample", entry + "Sample"}});
	functions += writer.add(entry, 2, constants);
	functions += pass.of_pixel ? writer.add("nookPixel", 2, constants) : "";
	const std::string call = entry + (pass.of_pixel ? "(nookPixel(at))" : "(at)");
	const std::string head = std::string(kPrelude) + functions + "layout(location = 0) out " +
							 kTypes[static_cast<std::size_t>(format)] +
							 " nook_out;\nvoid main()\n{\n\tivec2 at = ivec2(gl_FragCoord.xy);\n";
	if (pass.fills)
	{
		// A loop of one turn or none in place of an if: renderers on a CPU walk through both sides of that.
		return head +
			   "\tnook_out = nookVisibility(at);\n\tfor (int i = nook_out < 0.0 ? 0 : 1; i < 1; ++i)\n\t{\n\t\tnook_out = " + call +
			   ";\n\t}\n}\n";
	}
	return head + "\tnook_out = " + call + ";\n}\n";
}

} // namespace nook
