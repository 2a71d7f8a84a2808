// SPDX-License-Identifier: GPL-3.0-or-later
// Methods → their samples, their modules in OpenGL ES 3.0 with the passes to draw, and what of their block a person may set.
#include "core/text.h"
#include "emit/module.h"
#include "format/pattern_file.h"
#include "live_report/live_parts.h"
#include "measure/quality.h"
#include "methods/block_layout.h"
#include "methods/feature_table.h"
#include "methods/method_table.h"
#include "pattern/generate.h"
#include "pattern/tile.h"
#include "shade/shade.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array kFormats{"scalar", "quad", "counts"};
constexpr std::array kSlots{"nook_cells", "nook_levels", "nook_tables", "nook_range"};

// A number that a person may move, and the member of the block that holds it.
struct Slider
{
	std::string_view option; // of nook shade
	const char* member;
	double least;
	double most;
};
constexpr std::array kSliders{
	Slider{"--thickness", "thickness", 0.05, 2.0}, Slider{"--sigma", "sigma", 0.0, 3.0},
	Slider{"--contrast", "contrast", 0.25, 4.0},   Slider{"--slice-thickness", "slice_thickness", 0.1, 2.0},
	Slider{"--strength", "strength", 0.25, 4.0},   Slider{"--power", "power", 0.25, 4.0},
	Slider{"--slope", "slope", 0.1, 4.0}};

// Samples of one of the ways in which a method may take them.
struct Sampled
{
	const char* name = ""; // "tile", "random", "one"
	std::string file;      // that nook pattern or nook tile makes, in the module's command
	std::string text;      // of that file
	std::string command;   // that makes it
	std::vector<Pattern> variants;
};

std::string patternFile(const Recipe& recipe, const char* ending)
{
	return std::string(nameOf(recipe.domain)) + "_" + std::to_string(recipe.count) + ending + ".json";
}

std::vector<Sampled> samplesFor(const MethodRow& row, int count, const std::string& version, const RunSettings& run)
{
	if (!row.domain)
	{
		return {{}};
	}
	Recipe recipe;
	recipe.domain = *row.domain;
	recipe.count = count;
	const Pattern base = generatePattern(recipe, run);
	Sampled one{"one", patternFile(recipe, ""), "", commandOf(recipe), {base}};
	one.text = patternBytes(".json", base, &recipe, measurePattern(base, run), {one.command, version, {}, {}});
	std::vector<Sampled> all{one};
	for (const auto& [name, kind] : {std::pair("random", TileKind::random), std::pair("tile", TileKind::points)})
	{
		TileRecipe tile;
		tile.kind = kind;
		const PatternTile made = generateTile(base, tile, run);
		Sampled of_tile{name, patternFile(recipe, kind == TileKind::random ? "_random" : "_tile"), "", commandOf(tile, one.file),
						made.variants};
		of_tile.text = tileBytes(".json", made, &tile, measureTile(made, base, run), {of_tile.command, version, {}, one.command});
		all.push_back(std::move(of_tile));
	}
	return all;
}

// Column = variant, row = sample, as modules read their tiles.
std::string texelsJson(const ShadeSamples& samples)
{
	std::vector<float> numbers;
	const auto count = static_cast<std::size_t>(samples.count);
	const std::size_t variants = samples.samples.size() / count;
	for (std::size_t i = 0; i < samples.samples.size(); ++i)
	{
		const glm::vec4& s = samples.samples[i % variants * count + i / variants];
		numbers.insert(numbers.end(), {s.x, s.y, s.z, s.w});
	}
	return packed(numbers);
}

LiveJson passJson(const ShadePass& pass)
{
	LiveJson reads = LiveJson::array();
	for (const ShadeRead& read : pass.reads)
	{
		reads.push_back({kSlots[static_cast<std::size_t>(read.slot)], read.picture});
	}
	const glm::ivec4 numbers = modulePassOf(pass.block, pass.kernel.call);
	return {{"name", pass.kernel.name},
			{"call", pass.kernel.call},
			{"picture", pass.picture},
			{"level", pass.level},
			{"layer", pass.layer},
			{"reads", std::move(reads)},
			{"numbers", {numbers.x, numbers.y, numbers.z, numbers.w}}};
}

LiveJson planJson(const ShadePlan& plan)
{
	LiveJson pictures = LiveJson::array();
	for (const PictureShape& shape : plan.pictures)
	{
		pictures.push_back({{"format", kFormats[static_cast<std::size_t>(shape.format)]},
							{"width", shape.width},
							{"height", shape.height},
							{"levels", shape.levels},
							{"layers", shape.layers}});
	}
	LiveJson passes = LiveJson::array();
	for (const ShadePass& pass : plan.passes)
	{
		passes.push_back(passJson(pass));
	}
	return {{"pictures", std::move(pictures)}, {"passes", std::move(passes)}};
}

ShadeSamples samplesOfMethod(const MethodRow& row, const std::vector<Pattern>& variants, const ShadeSettings& shade)
{
	return row.domain ? samplesOf(row.method, variants) : ownSamples(shade);
}

LiveJson moduleJson(const ShadeFrame& frame, const MethodRow& row, const Sampled& sampled, const ShadeSettings& shade,
					const std::string& version)
{
	ModuleSettings settings;
	settings.methods = {{row.method, sampled.variants, shade, *recipeFor(raysRecipes(), row.method)}};
	settings.target = GlslTarget::es300;
	ShadeSettings said; // beside the recipe
	said.method = row.method;
	said.filter = shade.filter;
	const std::string command = "nook emit --methods " + std::string(row.name) + (row.domain ? " --patterns " + sampled.file : "") +
								emitOptions(said) + " --glsl es300";
	const ShadePlan plan = planOf(frame, samplesOfMethod(row, sampled.variants, shade), shade, false);
	return {{"one", row.domain && sampled.variants.size() == 1},
			{"filter", valueText(featureOf("--filter"), shade)},
			{"command", command},
			{"module", moduleGlsl(settings, {command, version, {}, sampled.command})},
			{"plan", planJson(plan)}};
}

LiveJson slidersJson(const MethodRow& row, const ShadeSettings& shade)
{
	LiveJson sliders = LiveJson::array();
	for (const Slider& slider : kSliders)
	{
		const FeatureRow& feature = featureOf(slider.option);
		if (takesFeature(row, feature))
		{
			sliders.push_back({{"option", slider.option},
							   {"member", slider.member},
							   {"least", slider.least},
							   {"most", slider.most},
							   {"value", feature.value.get(shade)},
							   {"unit", feature.unit},
							   {"nothing", feature.value.get(shade) > 0.0 ? std::string_view() : feature.nothing}});
		}
	}
	return sliders;
}

// Filters that a method's samples can take, the default one first.
std::vector<ShadeFilter> filtersOf(const MethodRow& row, bool one)
{
	if (!hasNoise(row))
	{
		return {ShadeFilter::none};
	}
	return one ? std::vector{ShadeFilter::none, ShadeFilter::bilateral}
			   : std::vector{ShadeFilter::window, ShadeFilter::none, ShadeFilter::bilateral};
}

// What lies in the block: its members, and their bytes for one method.
std::string blockBytes(const ShadeBlock& block)
{
	std::size_t end = 0;
	for (const BlockMember& member : blockMembers())
	{
		end = placeOf(member, end).end;
	}
	std::vector<uint8_t> bytes((end + 15) / 16 * 16);
	std::memcpy(bytes.data(), &block, end);
	return packed(bytes);
}

// Members of the block that follow the reach, in reaches.
LiveJson lengthsJson(const MethodRow& row)
{
	const MethodRecipe& recipe = *recipeFor(raysRecipes(), row.method);
	LiveJson lengths{{"radius", recipe.radius}};
	for (const RecipeValue& one : recipe.values)
	{
		if (isLength(*one.feature))
		{
			lengths[std::string(one.feature->setting)] = one.value;
		}
	}
	return lengths;
}

LiveJson methodJson(const MethodRow& row, const ShadeFrame& frame, double radius_m, const std::string& version,
					const RunSettings& run)
{
	ShadeSettings shade;
	shade.method = row.method;
	const double reach_m = roundedNumber(radius_m, 6);
	applyRecipe(shade, *recipeFor(raysRecipes(), row.method), reach_m);
	const int count = row.default_count / radiiOf(shade.volume);
	const std::vector<Sampled> all = samplesFor(row, count, version, run);
	LiveJson method{{"name", row.name},
					{"what", row.what},
					{"page", row.page},
					{"entry", row.kernel.call},
					{"domain", row.domain ? nameOf(*row.domain) : ""},
					{"count", count},
					{"radius_m", reach_m},
					{"lengths", lengthsJson(row)},
					{"sliders", slidersJson(row, shade)},
					{"block", blockBytes(blockOf(frame, samplesOfMethod(row, all.front().variants, shade), shade))},
					{"samples", LiveJson::array()},
					{"modules", LiveJson::array()}};
	for (const Sampled& sampled : all)
	{
		if (row.domain)
		{
			const ShadeSamples samples = samplesOf(row.method, sampled.variants);
			method["samples"].push_back({{"name", sampled.name},
										 {"file", sampled.file},
										 {"command", sampled.command},
										 {"text", sampled.text},
										 {"width", sampled.variants.size()},
										 {"height", samples.count},
										 {"texels", texelsJson(samples)}});
		}
	}
	const auto add = [&](const Sampled& sampled, bool one)
	{
		for (const ShadeFilter filter : filtersOf(row, one))
		{
			shade.filter = filter;
			method["modules"].push_back(moduleJson(frame, row, sampled, shade, version));
		}
	};
	add(all.back(), false); // of the tile, whose text is that of any other tile
	if (row.domain)
	{
		add(all.front(), true);
	}
	return method;
}

} // namespace

LiveJson liveModules(const LevelBench& level, const ViewBench& view, const std::string& version, const RunSettings& run)
{
	LiveJson members = LiveJson::object();
	for (const BlockMember& member : blockMembers())
	{
		members[member.name] = member.offset;
	}
	LiveJson methods = LiveJson::array();
	const ShadeFrame frame = frameOf(view.gbuffer());
	for (const MethodRow& row : methodTable())
	{
		if (row.emitted && row.kind == MethodKind::screen)
		{
			methods.push_back(methodJson(row, frame, level.radiusM(), version, run));
		}
	}
	return {{"members", std::move(members)}, {"methods", std::move(methods)}};
}

} // namespace nook
