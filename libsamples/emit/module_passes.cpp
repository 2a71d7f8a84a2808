// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of a module: their functions, their constants, and a description of what to draw.
#include "core/base64.h"
#include "core/decimal.h"
#include "core/error.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/words.h"
#include "emit/module.h"
#include "emit/module_parts.h"
#include "format/tile_json.h"
#include "methods/block.h"
#include "methods/method_table.h"
#include "methods/passes.h"
#include "pattern/cells.h"

#include <algorithm>
#include <cstring>
#include <regex>
#include <sstream>
#include <variant>

#include <nlohmann/json.hpp>

namespace nook
{
namespace
{

// Constants that differ between passes of one function, and their components in nook_pass.
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
	const ShadeSettings shade = shadeOf(settings, method);
	const ShadeFrame any{64, 64}; // no constant depends on the size
	const ShadeSamples samples =
		method.variants.empty() ? ownSamples(shade) : samplesOf(method.method, method.variants, layersOf(method));
	return planOf(any, samples, shade, false);
}

// The pass that shades a pixel.
ShadePass methodPass(const ModuleSettings& settings, const ModuleMethod& method)
{
	const ShadePlan plan = planFor(settings, method);
	return *firstWhere(plan.passes, [](const ShadePass& pass) { return pass.of_pixel; });
}

std::string line(const std::string& text)
{
	return "//   " + text + "\n";
}

// Prefixes each line of a text as a comment.
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

// Upper bound of a kernel's depth and normal reads per drawn texel. Depths may come from a coarser level.
struct KernelReads
{
	int depths = 0;
	int normals = 0;
};

struct FilterReads
{
	const char* call;
	KernelReads reads;
};
constexpr std::array kFilterReads{
	FilterReads{"nookLinked", {3, 3}},     FilterReads{"nookOfSurface", {1, 1}},  FilterReads{"nookUpsample", {1, 1}},
	FilterReads{"nookBentLinked", {3, 3}}, FilterReads{"nookBentY", {1, 1}},      FilterReads{"nookMoments", {4, 0}},
	FilterReads{"nookCoarser", {1, 0}},    FilterReads{"nookStatRange", {64, 0}}, FilterReads{"nookStatSlopes", {256, 128}},
	FilterReads{"nookStatFlags", {64, 0}},
};

KernelReads operator+(KernelReads a, KernelReads b)
{
	return {a.depths + b.depths, a.normals + b.normals};
}

KernelReads readsOf(const MethodRow& row, const ShadeSettings& shade, const ShadePass& pass)
{
	const std::string_view call = pass.kernel.call;
	const int samples = pass.block.samples;
	const bool normals = row.needs_normals || pass.block.use_normal != 0;
	const int own = 1 + samples * sampleDepths(row, shade);
	if (call == row.kernel.call)
	{
		return {own, normals ? 1 : 0};
	}
	if (call == row.open_kernel.call)
	{
		return {own, 2};
	}
	if (call == row.bent_kernel.call)
	{
		return {own + 1, 3};
	}
	if (call == "nookWindow")
	{
		return {pass.block.window * pass.block.window, pass.block.window * pass.block.window};
	}
	if (call == "nookStatCells")
	{
		const int pixels = pass.block.table_cell * pass.block.table_cell;
		return {pass.block.table > 0 && pass.block.uniform_layers == 0 ? 2 * pixels : pixels, 0};
	}
	const bool first = pass.level == 0; // later levels read the previous one
	const auto* const found = firstWhere(kFilterReads, [call](const FilterReads& one) { return call == one.call; });
	return found != nullptr && first ? KernelReads{found->reads.depths, normals ? found->reads.normals : 0} : KernelReads{};
}

// Includes the values packed for later passes; a reconstructed normal reads nine depths.
int depthReadsOf(const ModuleSettings& settings, const ModuleMethod& method, const ShadePass& pass)
{
	KernelReads reads = readsOf(rowOf(method.method), shadeOf(settings, method), pass);
	for (const FilterReads& one : kFilterReads)
	{
		const char* const packing = packingCall(pass.packing);
		reads = packing != nullptr && std::string_view(packing) == one.call ? reads + one.reads : reads;
	}
	return reads.depths + (settings.normals_from_depth ? 9 * reads.normals : 0);
}

// Texels drawn per pixel of the picture.
double texelsOf(const ShadePass& pass)
{
	const std::string_view call = pass.kernel.call;
	if (call == "nookMoments" || call == "nookCoarser")
	{
		return pass.level == 0 ? 0.25 : 0.0; // the others read no depth
	}
	if (call == "nookStatRange")
	{
		return 2.0 / 64.0;
	}
	if (call == "nookStatSlopes" || call == "nookStatFlags")
	{
		return 1.0 / 64.0;
	}
	const int side = call == "nookStatCells" ? pass.block.table_cell : call == "nookUpsample" ? 1 : pass.block.cell;
	return 1.0 / (side * side);
}

std::string sizeText(const ShadeSettings& shade)
{
	return shade.half_resolution ? "half the width and height of the picture, rounded up" : "size of the picture";
}

std::string pictureText(ShadePacking packing)
{
	switch (packing)
	{
	case ShadePacking::none: break;
	case ShadePacking::links: return "visibility and the links that the filter needs, RGBA8 or better";
	case ShadePacking::surface: return "visibility and the surface that upsampling needs, RGBA32F";
	}
	return "visibility, R8 or better";
}

// Passes over the picture of the pass before. $: the method's function with open directions.
struct FilterPass
{
	const char* call;
	bool packs; // its picture is the pass's own, for upsampling or for the end
	const char* text;
};
constexpr std::array kFilterPasses{
	FilterPass{"nookBilateralX", false, "RGBA8 or better, same size; reads the picture of the pass before as nook_packed"},
	FilterPass{"nookBilateralY", true, ", same size; reads the picture of nookBilateralX as nook_packed"},
	FilterPass{"nookWindow", true, ", same size; reads the picture of the pass before as nook_cells"},
	FilterPass{"nookBentLinked", false,
			   "the links that the filter needs, RGBA8 or better, same size; reads the picture before as nook_levels"},
	FilterPass{"nookBentX", false,
			   "RGBA16F or better, same size; reads the picture of $ as nook_levels, of nookBentLinked as nook_packed"},
	FilterPass{"nookBentY", false,
			   "the bent normal as xyz, visibility as w; reads the picture of nookBentX as nook_levels, of nookBentLinked as "
			   "nook_packed"},
};

// One line per pass over the picture's pixels or cells.
std::string passLines(const ModuleSettings& settings, const ModuleMethod& method)
{
	const MethodRow& row = rowOf(method.method);
	const std::string entry = entryOf(row);
	const ShadeSettings shade = shadeOf(settings, method);
	std::string text;
	for (const ShadePass& pass : planFor(settings, method).passes)
	{
		const std::string call = moduleCallOf(pass);
		const int depths = depthReadsOf(settings, method, pass);
		const std::string reads =
			depths > 0 ? "; at most " + counted(static_cast<std::size_t>(depths), "depth read", "depth reads") + " per texel" : "";
		const std::string_view kernel = pass.kernel.call;
		if (pass.of_pixel && call == row.open_kernel.call)
		{
			text +=
				line(call + "(texel): mean of the open directions and visibility, RGBA16F or better, size of the picture" + reads);
		}
		else if (pass.of_pixel)
		{
			const bool of_cell = shade.half_resolution && pass.packing == ShadePacking::none;
			text +=
				line(call + (of_cell ? "(2 * texel): " : "(texel): ") + pictureText(pass.packing) + ", " + sizeText(shade) + reads);
		}
		else if (kernel == "nookUpsample")
		{
			text +=
				line(entry + "Full(pixel): visibility, size of the picture; reads the picture of the pass before as nook_packed" +
					 reads + ",") +
				line("    and those of the method where no cell shows the surface of the pixel. Or draw it as two passes:") +
				line("    nookUpsample(pixel), which is -1 there: discard, and write depth elsewhere;") +
				line("    then " + entry + "Left(pixel) where nothing was drawn, by a depth test");
		}
		for (const FilterPass& one : kFilterPasses)
		{
			if (kernel == one.call)
			{
				const std::string what = std::regex_replace(one.text, std::regex("\\$"), row.open_kernel.call);
				text += line(call + "(texel): " + (one.packs ? pictureText(pass.packing) : "") + what + reads);
			}
		}
	}
	return text;
}

std::string passesText(const ModuleSettings& settings, const ModuleMethod& method)
{
	const MethodRow& row = rowOf(method.method);
	const ShadeSettings shade = shadeOf(settings, method);
	std::string text =
		row.moments
			? line("nookMoments(texel): levels 0 to 5 of nook_levels, RGBA32F; level 0 has half the size of the depth texture, "
				   "rounded up") +
				  line("    so that both sides are multiples of 32; nook_pass.x = level; level l > 0 reads level l - 1 of "
					   "nook_levels;") +
				  line("    4 depth reads per texel of level 0")
			: "";
	const int levels = row.levels != nullptr ? row.levels(shade) : 0;
	if (levels > 0)
	{
		text += line("nookCoarser(texel): levels 0 to " + std::to_string(levels - 1) +
					 " of nook_levels, R32F; level 0 has half of (nook.last + 1) on each side, rounded down;") +
				line("    nook_pass.x = level; level l > 0 reads level l - 1 of nook_levels; 1 depth read per texel of level 0");
	}
	text += row.passes_text != nullptr ? linesOf(row.passes_text(shade)) : "";
	return text + passLines(settings, method);
}

// Sum over all passes, per pixel of the picture.
std::string totalText(const ModuleSettings& settings, const ModuleMethod& method)
{
	return numberText(sumOver(planFor(settings, method).passes, [&](const ShadePass& pass)
							  { return pass.fills ? 0.0 : texelsOf(pass) * depthReadsOf(settings, method, pass); }));
}

// "3 samples at each of 3 radii, other ones in each pixel of 4 x 4"
std::string countsText(const ModuleSettings& settings, const ModuleMethod& method)
{
	const ShadeSettings shade = shadeOf(settings, method);
	const ShadePass pass = methodPass(settings, method);
	std::string text;
	if (!method.variants.empty() || rowOf(method.method).tile_domain)
	{
		const int radii = 1 + (pass.block.radii != 0 ? 1 : 0) + pass.block.third;
		const bool slices = rowOf(method.method).tile_domain.has_value();
		text += ", " +
				counted(static_cast<std::size_t>(pass.block.samples), slices ? "slice" : "sample", slices ? "slices" : "samples");
		text += slices ? " of " + std::to_string(2 * shade.slices.steps) + " samples" : "";
		text += radii > 1 ? " at each of " + std::to_string(radii) + " radii" : "";
	}
	const int window = windowOf(method);
	return text + (window > 1 ? ", other ones in each pixel of " + std::to_string(window) + " x " + std::to_string(window) : "");
}

// The passes, pictures and uniform block of one picture as JSON, for programs that draw emitted modules.

using PassesJson = nlohmann::ordered_json;

constexpr std::array kPictureFormats{"scalar", "quad", "counts"};
constexpr std::array kSlotNames{"nook_cells", "nook_packed", "nook_levels", "nook_tables", "nook_range"};

// Column = variant, row = sample, as modules read their tiles.
PassesJson tileJson(const ShadeSamples& samples)
{
	const auto count = static_cast<std::size_t>(samples.count);
	const std::size_t variants = samples.samples.size() / count;
	const std::vector<glm::vec4> texels =
		listOf(samples.samples.size(), [&](std::size_t i) { return samples.samples[i % variants * count + i / variants]; });
	return {{"width", variants},
			{"height", count},
			{"texels", base64Of({reinterpret_cast<const uint8_t*>(texels.data()), texels.size() * sizeof(glm::vec4)})}};
}

PassesJson passJson(const ShadePass& pass)
{
	const PassesJson reads = mapped(pass.reads,
									[](const ShadeRead& read) -> PassesJson {
										return {kSlotNames[static_cast<std::size_t>(read.slot)], read.picture};
									});
	const glm::ivec4 numbers = modulePassOf(pass.block, pass.kernel.call);
	return {{"name", pass.kernel.name},
			{"call", moduleCallOf(pass)},
			{"picture", pass.picture},
			{"level", pass.level},
			{"layer", pass.layer},
			{"reads", reads},
			{"numbers", {numbers.x, numbers.y, numbers.z, numbers.w}}};
}

// The first `count` samples. Throws Error (invalid_input) where there are fewer, or where they were not made for it.
void shorten(PatternFile& file, std::size_t count, const std::string& path)
{
	Pattern& pattern = file.pattern;
	refuseInputIf(count > pattern.count(), path + ": --counts", std::to_string(pattern.count()) + " samples",
				  std::to_string(count) + " or more");
	if (count == pattern.count())
	{
		return;
	}
	refuseInputIf(!file.recipe || file.recipe->order != Order::progressive, path + ": recipe",
				  "a pattern whose first samples are none", "one made with --order progressive");
	pattern.points.resize(count);
	pattern.powers.clear();
	pattern.weights = exactCells(pattern.domain, pattern.points, {}).integrals;
}

// The first `count` samples of each variant of a tile. Their weights stay what they were made for, but for their sum.
void shorten(const TileFile& file, std::size_t count, const std::string& path, std::vector<Pattern>& variants)
{
	refuseInputIf(count > variants.front().count(), path + ": --counts", std::to_string(variants.front().count()) + " samples",
				  std::to_string(count) + " or more");
	refuseIf(count < variants.front().count() && !(file.recipe && file.recipe->progressive),
			 path + ": --counts: found a tile of " + std::to_string(variants.front().count()) +
				 " samples, expected all of them, or one made with --progressive",
			 ExitCode::invalid_input);
	for (Pattern& variant : variants)
	{
		if (count == variant.count())
		{
			return;
		}
		variant.points.resize(count);
		variant.weights.resize(count);
		const double sum = sumOver(variant.weights);
		refuseInputIf(!(sum > 0.0), path + ": --counts",
					  "a variant whose first " + std::to_string(count) + " samples have no weight", "some");
		for (double& w : variant.weights)
		{
			w /= sum;
		}
	}
}

// Variants in a window: those of the tile, or of the method's own samples.
std::size_t windowOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	if (!method.variants.empty())
	{
		return method.variants.size() / static_cast<std::size_t>(layersOf(method));
	}
	const auto side = static_cast<std::size_t>(ownSamples(shadeOf(settings, method)).size);
	return side * side;
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
		if (std::any_of(entries.begin(), entries.end(), [&call](const ModuleEntry& entry) { return entry.call == call; }))
		{
			continue;
		}
		ModuleEntry entry{call, constantsOf(pass.block), pass.packing, pass.of_pixel};
		const bool portable = settings.target == GlslTarget::gl330 || settings.target == GlslTarget::es300;
		entry.constants["NOOK_NATIVE_BITS"] = portable ? "0" : "1";
		for (const Varying& one : kVarying)
		{
			entry.constants[one.constant] = settings.float_block ? "int(" + std::string(one.place) + ")" : one.place;
		}
		entries.push_back(entry);
	}
	return entries;
}

std::vector<ModulePass> mainPasses(const ModuleSettings& settings)
{
	const ModuleMethod& method = settings.methods.front();
	const ShadeSettings shade = shadeOf(settings, method);
	const ShadePlan plan = planFor(settings, method);
	std::vector<ModulePass> passes;
	std::string entry;
	for (const ShadePass& pass : plan.passes)
	{
		const std::string_view kernel = pass.kernel.call;
		if (kernel == "nookUpsample") // nook...Full calls it
		{
			continue;
		}
		entry = pass.of_pixel ? pass.kernel.call : entry;
		const bool of_cell = pass.of_pixel && shade.half_resolution && pass.packing == ShadePacking::none;
		const std::string call = pass.fills ? entry + "Full(at)" : moduleCallOf(pass) + (of_cell ? "(2 * at)" : "(at)");
		if (std::any_of(passes.begin(), passes.end(), [&call](const ModulePass& one) { return one.call == call; }))
		{
			continue;
		}
		switch (plan.pictures[pass.picture].format)
		{
		case PictureFormat::scalar: passes.push_back({call, "float", kernel == "nookCoarser" ? "r32f" : "r8"}); break;
		case PictureFormat::counts: passes.push_back({call, "uvec4", "rgba32ui"}); break;
		case PictureFormat::quad:
		{
			const bool links = pass.packing == ShadePacking::links || kernel == "nookBilateralX" || kernel == "nookBentLinked";
			const bool bent = hasBentNormals(settings, method) && !links;
			passes.push_back({call, "vec4", links ? "rgba8" : bent ? "rgba16f" : "rgba32f"});
			break;
		}
		}
	}
	return passes;
}

std::string entryOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	const std::vector<ModuleEntry> entries = entriesOf(settings, method);
	return firstWhere(entries, [](const ModuleEntry& entry) { return entry.of_pixel; })->call;
}

bool hasBentNormals(const ModuleSettings& settings, const ModuleMethod& method)
{
	return hasBentNormals(shadeOf(settings, method));
}

std::string settingsMeaning(const ModuleMethod& method)
{
	const std::string of = "Settings of " + std::string(entryOf(rowOf(method.method)));
	return of + (method.recipe
					 ? ", fitted to ray tracing with rays as long as `reach`, in the unit of your depths. Set width and height."
					 : " with the radius `reach`, in the unit of your depths. Set width and height.");
}

std::vector<std::pair<std::string, std::string>> presetsOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	std::vector<std::pair<std::string, std::string>> presets;
	presets.emplace_back("radius", method.recipe ? numberText(method.recipe->radius) + " * reach" : "reach");
	for (const RecipeValue& one : method.recipe ? method.recipe->values : std::vector<RecipeValue>{})
	{
		if (one.feature->kind == FeatureKind::number && !one.feature->setting.empty())
		{
			presets.emplace_back(one.feature->setting, numberText(one.value) + (isLength(*one.feature) ? " * reach" : ""));
		}
	}
	if (settings.device_depth)
	{
		presets.emplace_back("device_depth", "true");
		presets.emplace_back("zero_to_one", hasUnitClip(settings) ? "true" : "false");
	}
	return presets;
}

std::string introductionOf(const ModuleSettings& settings)
{
	std::string text = "//\n// Visibility of the surface that a pixel shows, 1 where open, from a depth buffer:\n";
	for (const ModuleMethod& method : settings.methods)
	{
		const MethodRow& row = rowOf(method.method);
		const bool bent = hasBentNormals(settings, method);
		const bool passes = entriesOf(settings, method).size() > 1;
		text += line((bent ? "vec4 " : "float ") + entryOf(settings, method) + "(ivec2 pixel): " + std::string(row.what) +
					 countsText(settings, method));
		text +=
			bent ? line("    w: visibility; xyz: " + std::string(shadeOf(settings, method).filter == ShadeFilter::none
																	 ? "the bent normal, a unit vector in view space"
																	 : "the mean of the open directions, for the passes below")) +
					   line("    nookBentCoded packs a bent normal and visibility into a texture with 8 bits per channel, "
							"nookBentDecoded unpacks them;") +
					   line("    nookConeAngle returns the half angle of the open cone around it")
				 : "";
		ShadePass alone = methodPass(settings, method);
		alone.packing = ShadePacking::none;
		text += line("    depth reads per pixel: at most " + std::to_string(depthReadsOf(settings, method, alone)) +
					 (passes ? "; with all passes below: at most " + totalText(settings, method) : "") +
					 (row.moments || alone.block.levels > 0 ? " (samples far from the pixel read nook_levels instead)" : ""));
		const auto presets =
			joinedText(presetsOf(settings, method), ", ", [](const auto& preset) { return preset.first + " = " + preset.second; });
		text += method.recipe ? line("    preset for ray-traced occlusion with rays of the length reach: " + presets) : "";
	}
	for (const ModuleMethod& method : settings.methods)
	{
		if (entriesOf(settings, method).size() > 1)
		{
			text += "// Passes" + (settings.methods.size() > 1 ? " of " + std::string(rowOf(method.method).name) : "") +
					", in this order. Each calls a function for the texel that it draws, into a picture of its own:\n" +
					passesText(settings, method);
		}
	}
	if (settings.gather)
	{
		text += "// float nookGather(ivec2 pixel, vec3 position, vec3 n): visibility for one of several samples of a pixel (MSAA), "
				"from the\n"
				"// finished picture in nook_cells; position and normal of the sample are in view space. At most " +
				std::to_string(settings.normals_from_depth ? 50 : 5) + " depth reads.\n";
	}
	if (settings.normals_from_depth)
	{
		text += "// Normals come from depths: nookNormalFromDepth takes nine of the reads above each time. To read fewer, draw\n"
				"// nookNormalFromDepth(pixel) into a picture first, and define NOOK_NORMAL(pixel) to read it in the passes after "
				"it.\n";
	}
	const bool hlsl = settings.target == GlslTarget::hlsl60;
	text += "// Pixels count as in " + std::string(hlsl ? "Load" : "texelFetch") +
			". `nook emit -o FILE.h` writes the C++ that fills the uniform block, `-o FILE.js` the JavaScript.\n";
	text += settings.main ? "// This is a complete shader; its entry point is main.\n"
			: hlsl        ? "// This is a file to include. All its names begin with nook or NOOK.\n"
						  : "// This file has no #version: include it after yours. All its names begin with nook or NOOK.\n";
	if (const std::vector<ModulePass> passes = settings.main ? mainPasses(settings) : std::vector<ModulePass>{}; passes.size() > 1)
	{
		text += "// Define NOOK_PASS first to choose what main computes:";
		for (std::size_t i = 0; i < passes.size(); ++i)
		{
			text += (i == 0 ? " " : ", ") + std::to_string(i) + " " + passes[i].call.substr(0, passes[i].call.find('('));
		}
		text += ".\n";
	}
	return text;
}

std::string passesJson(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings,
					   std::string_view version)
{
	const ShadePlan plan = planOf(frame, samples, settings, false);
	PassesJson members = PassesJson::object();
	std::size_t end = 0;
	for (const BlockMember& member : blockMembers())
	{
		members[member.name] = member.offset;
		end = placeOf(member, end).end;
	}
	std::vector<uint8_t> bytes((end + 15) / 16 * 16);
	const ShadeBlock block = blockOf(frame, samples, settings);
	std::memcpy(bytes.data(), &block, end);
	PassesJson pictures = mapped(plan.pictures,
								 [](const PictureShape& shape) -> PassesJson
								 {
									 return {{"format", kPictureFormats[static_cast<std::size_t>(shape.format)]},
											 {"width", shape.width},
											 {"height", shape.height},
											 {"levels", shape.levels},
											 {"layers", shape.layers}};
								 });
	PassesJson passes = mapped(plan.passes, passJson);
	PassesJson json{{"schema", "nook.passes/1"}, {"version", version}, {"members", std::move(members)}, {"block", base64Of(bytes)}};
	if (rowOf(settings.method).domain)
	{
		json["tile"] = tileJson(samples);
	}
	json["pictures"] = std::move(pictures);
	json["passes"] = std::move(passes);
	return jsonLine(json) + "\n";
}

std::string readSamples(const std::string& path, std::optional<std::size_t> count, const ShadeSettings& shade, ModuleMethod& method)
{
	std::variant<PatternFile, TileFile> input = readInput(path);
	if (shade.bands.count > 1)
	{
		checkProgressive(input, path);
	}
	const Domain expected = domainOf(method.method);
	const auto checkDomain = [&](Domain found)
	{
		refuseIf(found != expected,
				 path + ": domain: found " + std::string(nameOf(found)) + ", expected " + std::string(nameOf(expected)) + " for " +
					 std::string(nameOf(method.method)),
				 ExitCode::invalid_input);
	};
	if (PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		checkDomain(file->pattern.domain);
		completeWeights(*file);
		shorten(*file, count.value_or(file->pattern.count()), path);
		method.variants = {file->pattern};
		return file->command;
	}
	const TileFile& file = std::get<TileFile>(input);
	checkDomain(file.tile.domain);
	method.variants = file.tile.variants;
	method.frames = file.tile.frames;
	method.moves = file.tile.moves;
	if (count)
	{
		shorten(file, *count, path, method.variants);
	}
	return file.command;
}

void checkWindows(const ModuleSettings& settings)
{
	if (settings.shade.filter != ShadeFilter::window)
	{
		return;
	}
	for (const ModuleMethod& method : settings.methods)
	{
		const std::size_t variants = windowOf(settings, method);
		refuseInputIf(variants < 2 || variants != windowOf(settings, settings.methods.front()),
					  "--filter window: " + std::string(nameOf(method.method)),
					  std::to_string(method.variants.size()) + " variants", "tiles of one size for all methods");
	}
}

} // namespace nook
