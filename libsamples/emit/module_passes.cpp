// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of a module: which functions, with which constants, and in words what to draw.
#include "emit/module_parts.h"
#include "methods/block.h"
#include "methods/block_layout.h"
#include "methods/passes.h"

#include <algorithm>
#include <sstream>

namespace nook
{
namespace
{

// Constants that differ between passes of one function, and where in nook_pass they are.
struct Varying
{
	const char* constant;
	const char* place;
};
constexpr std::array kVarying{
	Varying{"NOOK_LEVEL", "nook_pass.x"},  Varying{"NOOK_RANGE_WIDTH", "nook_pass.x"}, Varying{"NOOK_RANGE_HEIGHT", "nook_pass.y"},
	Varying{"NOOK_STRIDE", "nook_pass.x"}, Varying{"NOOK_AXIS", "nook_pass.y"},        Varying{"NOOK_TABLE", "nook_pass.z"},
};

ShadePlan planFor(const ModuleSettings& settings, const ModuleMethod& method)
{
	ShadeSettings shade = shadeOf(settings, method);
	shade.method = method.method;
	const ShadeFrame any{64, 64}; // what comes of it is no constant
	const ShadeSamples samples =
		method.variants.empty() ? ownSamples(shade) : samplesOf(method.method, method.variants, layersOf(method));
	return planOf(any, samples, shade, false);
}

std::string line(const std::string& text)
{
	return "//   " + text + "\n";
}

// Of a text with one a line.
std::string linesOf(const std::string& text)
{
	std::string lines;
	std::istringstream rest(text);
	for (std::string one; std::getline(rest, one);)
	{
		lines += line(one);
	}
	return lines;
}

std::string momentsText()
{
	return line("nookMoments(texel): levels 0 to 5 of nook_levels, RGBA32F, of half the size of the texture of depths, rounded up "
				"so") +
		   line("    that both sides are multiples of 32; nook_pass.x = level; level l > 0 reads level l - 1");
}

std::string sizeText(const ShadeSettings& shade)
{
	return shade.half_resolution ? "half of both sides, rounded up" : "the picture's size";
}

std::string pictureText(ShadePacking packing)
{
	switch (packing)
	{
	case ShadePacking::none: break;
	case ShadePacking::links: return "visibility and what the filter needs, RGBA, 8 bits or better";
	case ShadePacking::surface: return "visibility and what upsampling needs, RGBA32F";
	}
	return "visibility, R8 or better";
}

// Of the last pass over cells.
std::string lastText(const ShadeSettings& shade)
{
	return pictureText(shade.half_resolution ? ShadePacking::surface : ShadePacking::none);
}
std::string lastCall(const char* call, const ShadeSettings& shade)
{
	return std::string(call) + (shade.half_resolution ? "OfSurface" : "");
}

// Bent normals and visibility together.
std::string bentPassesText(const std::string& entry)
{
	return line(entry + "(texel): the mean of the open directions and visibility, RGBA16F or better, the picture's size") +
		   line("nookBentLinked(texel): what the filter needs, RGBA, 8 bits or better, as large; reads it as nook_levels") +
		   line("nookBentX(texel): RGBA16F or better, as large; reads the first as nook_levels, nookBentLinked's as nook_packed") +
		   line("nookBentY(texel): the bent normal as xyz, visibility as w; reads nookBentX's as nook_levels, nookBentLinked's as "
				"nook_packed");
}

std::string passesText(const ModuleSettings& settings, const ModuleMethod& method)
{
	if (hasBentNormals(settings, method))
	{
		return bentPassesText(entryOf(settings, method));
	}
	const MethodRow& row = rowOf(method.method);
	const std::string entry = entryOf(row);
	const ShadeSettings& shade = shadeOf(settings, method);
	std::string text;
	text += row.moments ? momentsText() : "";
	const int levels = row.levels != nullptr ? row.levels(shade) : 0;
	if (levels > 0)
	{
		text += line("nookCoarser(texel): levels 0 to " + std::to_string(levels - 1) +
					 " of nook_levels, R32F, of half of (nook.last + 1), rounded down; nook_pass.x = level; level l > 0 reads "
					 "level l - 1");
	}
	text += row.passes_text != nullptr ? linesOf(row.passes_text(shade)) : "";
	const ShadePlan plan = planFor(settings, method);
	const auto first = std::find_if(plan.passes.begin(), plan.passes.end(), [](const ShadePass& pass) { return pass.of_pixel; });
	const bool of_cell = shade.half_resolution && first->packing == ShadePacking::none;
	text += line(moduleCallOf(*first) + (of_cell ? "(2 * texel): " : "(texel): ") + pictureText(first->packing) + ", " +
				 sizeText(shade));
	switch (shade.filter)
	{
	case ShadeFilter::none: break;
	case ShadeFilter::bilateral:
		text += line("nookBilateralX(texel): RGBA, 8 bits or better, as large; reads it as nook_packed");
		text += line(lastCall("nookBilateralY", shade) + "(texel): " + lastText(shade) + ", as large; reads that as nook_packed");
		break;
	case ShadeFilter::window:
		text += line(lastCall("nookWindow", shade) + "(texel): " + lastText(shade) + ", as large; reads it as nook_cells");
		break;
	}
	if (shade.half_resolution)
	{
		text += line(entry + "Full(pixel): visibility, the picture's size; reads the one before as nook_packed. Or in two:") +
				line("nookUpsample(pixel): the same, but -1 where no cell shows the pixel's surface (discard, and write depth);") +
				line("    then " + entry + "Left(pixel) where nothing was drawn (test depth)");
	}
	return text;
}

} // namespace

glm::ivec4 modulePassOf(const ShadeBlock& block, std::string_view call)
{
	if (call == "nookStatRangeUp")
	{
		return {block.range_width, block.range_height, 0, 0};
	}
	if (call == "nookTableSum")
	{
		return {block.stride, block.axis, 0, 0};
	}
	return {block.level, 0, block.table, 0};
}

std::string moduleCallOf(const ShadePass& pass)
{
	const char* const packing = packingCall(pass.packing);
	return std::string(pass.kernel.call) + (packing != nullptr ? packing + std::string_view("nook").size() : "");
}

std::vector<ModuleEntry> entriesOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	std::vector<ModuleEntry> entries;
	for (const ShadePass& pass : planFor(settings, method).passes)
	{
		const std::string call = pass.kernel.call;
		const auto same = [&call](const ModuleEntry& entry)
		{
			return entry.call == call;
		};
		if (std::any_of(entries.begin(), entries.end(), same))
		{
			continue;
		}
		ModuleEntry entry{call, constantsOf(pass.block), pass.packing, pass.of_pixel};
		for (const Varying& one : kVarying)
		{
			entry.constants[one.constant] = settings.float_block ? "int(" + std::string(one.place) + ")" : one.place;
		}
		entries.push_back(entry);
	}
	return entries;
}

std::string entryOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	const std::vector<ModuleEntry> entries = entriesOf(settings, method);
	return std::find_if(entries.begin(), entries.end(), [](const ModuleEntry& entry) { return entry.of_pixel; })->call;
}

bool hasBentNormals(const ModuleSettings& settings, const ModuleMethod& method)
{
	ShadeSettings shade = shadeOf(settings, method);
	shade.method = method.method;
	return hasBentNormals(shade);
}

std::string introductionOf(const ModuleSettings& settings)
{
	std::string text = "//\n// Visibility, 1 where open, of the pixel of a depth buffer:\n";
	for (const ModuleMethod& method : settings.methods)
	{
		const MethodRow& row = rowOf(method.method);
		const int window = windowOf(method);
		const std::string samples =
			method.variants.empty() ? "" : ", " + std::to_string(method.variants.front().count()) + " samples";
		const bool bent = hasBentNormals(settings, method);
		text += line((bent ? "vec4 " : "float ") + entryOf(settings, method) + "(ivec2 pixel): " + std::string(row.what) + samples +
					 (window > 1 ? ", others in each pixel of " + std::to_string(window) + " x " + std::to_string(window) : ""));
		text +=
			bent ? line("    w: visibility; xyz: " + std::string(shadeOf(settings, method).filter == ShadeFilter::none
																	 ? "the bent normal, a unit vector in view space"
																	 : "the mean of the open directions, for the passes below")) +
					   line("    nookBentCoded puts a bent normal and visibility into a texture of 8 bits, nookBentDecoded takes "
							"them "
							"out; nookConeAngle")
				 : "";
		text += method.recipe ? line("    fitted to rays that reach so far: " + recipeText(*method.recipe)) : "";
	}
	for (const ModuleMethod& method : settings.methods)
	{
		if (entriesOf(settings, method).size() > 1)
		{
			text += "// Passes" + (settings.methods.size() > 1 ? " of " + std::string(rowOf(method.method).name) : "") +
					", in order, each a function of the texel that is drawn, into a picture of its own:\n" +
					passesText(settings, method);
		}
	}
	if (settings.gather)
	{
		text += "// float nookGather(ivec2 pixel, vec3 position, vec3 n): where a renderer shades one of several samples of a "
				"pixel, from the\n"
				"// finished picture in nook_cells; the sample's position and normal in view space.\n";
	}
	if (settings.normals_from_depth)
	{
		text += "// Normals come from depths: nookNormalFromDepth reads nine. A filter asks for the normal of every pixel that it "
				"reads: where that\n"
				"// costs too much, draw nookNormalFromDepth(pixel) into a picture first, and define NOOK_NORMAL in the passes "
				"after it.\n";
	}
	text += "// Pixels count as texelFetch does. `nook emit -o FILE.h` writes the C++ that fills the block, `-o FILE.js` the "
			"JavaScript.\n";
	text += settings.main ? "" : "// Without #version, to be included after yours. All names begin with nook or NOOK.\n";
	return text;
}

} // namespace nook
