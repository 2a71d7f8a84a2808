// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/passes.h"

#include "methods/block.h"
#include "methods/kernel_text.h"

#include <array>

namespace nook
{
namespace
{

constexpr const char* kHead = "#version 330 core\n#define NOOK_SKY 1e30f\nlayout(std140) uniform NookBlock\n{\n";

constexpr const char* kPrelude = R"(} nook;
uniform sampler2D nook_depths;
uniform sampler2D nook_normals;
uniform sampler2D nook_samples;
uniform sampler2D nook_cells;
uniform sampler2D nook_packed;
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
vec4 nookPacked(ivec2 cell)
{
	return texelFetch(nook_packed, cell, 0);
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

// The samples of the pixel's cell; named after the pass's function, like the functions' other names.
constexpr const char* kSamples = R"(
int nookVariant(ivec2 pixel)
{
	ivec2 cell = ivec2(pixel.x, nookRow(pixel.y)) / NOOK_CELL;
	int own = (cell.y + NOOK_VARIANT / NOOK_WINDOW) % NOOK_WINDOW * NOOK_WINDOW + (cell.x + NOOK_VARIANT) % NOOK_WINDOW;
	return NOOK_VARIANT / (NOOK_WINDOW * NOOK_WINDOW) * (NOOK_WINDOW * NOOK_WINDOW) + own;
}
vec4 nookSample(int row, int i)
{
	return texelFetch(nook_samples, ivec2(i, row), 0);
}
)";

constexpr std::array<const char*, 3> kTypes{"float", "vec4", "uvec4"}; // indexed by PictureFormat

} // namespace

std::string glSourceOf(const ShadePass& pass, PictureFormat format)
{
	const std::string entry = pass.kernel.call;
	const std::map<std::string, std::string> constants = constantsOf(pass.block);
	FunctionWriter writer(screenKernels());
	std::string functions = writer.add("nookRow", constants);
	functions += renamed(resolved(kSamples, constants), {{"nookVariant", entry + "Variant"}, {"nookSample", entry + "Sample"}});
	functions += writer.add(entry, constants);
	functions += pass.of_pixel ? writer.add("nookPixel", constants) : "";
	const char* const packing = packingCall(pass.packing);
	functions += packing != nullptr ? writer.add(packing, constants) : "";
	std::string call = entry + (pass.of_pixel ? "(nookPixel(at))" : "(at)");
	call = packing != nullptr ? std::string(packing) + "(at, " + call + ")" : call;
	const std::string head = kHead + membersGlsl() + kPrelude + functions + "layout(location = 0) out " +
							 kTypes[static_cast<std::size_t>(format)] +
							 " nook_out;\nvoid main()\n{\n\tivec2 at = ivec2(gl_FragCoord.xy);\n";
	return head + "\tnook_out = " + call + ";\n" + (pass.leaves ? "\tif (nook_out < 0.0)\n\t{\n\t\tdiscard;\n\t}\n" : "") + "}\n";
}

} // namespace nook
