// SPDX-License-Identifier: GPL-3.0-or-later
// nook info: a pattern, a tile, recipes, a level, volumes or an image, ours or someone else's → what it holds, measured again.
#include "scene_options.h"

#include "bake/bake.h"
#include "core/error.h"
#include "core/system.h"
#include "format/tile_json.h"
#include "methods/method_table.h"
#include "methods/recipes.h"
#include "pattern/quality.h"
#include "scene/describe.h"
#include "scene/gltf_edit.h"
#include "version.h"
#include "volume/build.h"
#include "volume/volume_glb.h"

#include <array>

namespace nook
{
namespace
{

struct InfoOptions
{
	const CLI::App* app = nullptr;
	std::string file;
	bool methods = false;    // instead of a file: the table of methods
	std::string features_of; // instead of a file: a method whose options are listed
	std::optional<Domain> domain;
	std::vector<std::string> filters;
	double ema = 0.1;
	LoadSettings load;
	Outputs outputs;
};

constexpr std::array<std::string_view, 1> kDomainOption{"--domain"};
constexpr std::array<std::string_view, 2> kTileOptions{"--filter", "--ema"};

// Kinds of files, by their endings.
constexpr const char* kKinds =
	"a pattern (.json .csv), a tile or recipes (.json), a level (.gltf .glb .obj .fbx .ply .stl) or builtin:NAME, "
	"volumes (.glb), a "
	"G-buffer or any other image (.exr .png .jpg .tif .hdr .tga .bmp)";

// Refuses options that say nothing about such a file.
void refuseOther(const InfoOptions& options, std::span<const std::string_view> names, const std::string& expected)
{
	refuseGiven(*options.app, names, "with another kind of file, expected " + expected);
}

void addKind(Facts& facts, const std::string& kind, Domain domain, std::size_t count, const std::string& more)
{
	facts.line(kind + ": " + std::string(nameOf(domain)) + ", " + std::to_string(count) + (count == 1 ? " sample" : " samples") +
			   more);
	facts.text("kind", kind);
	facts.text("domain", nameOf(domain));
	facts.whole("count", count);
}

// A fact whose name is its words, unless it is empty.
void addWords(Facts& facts, const std::string& name, const std::string& value)
{
	facts.when(!value.empty()).text(name, value, name);
}

void describe(PatternFile& file, const InfoOptions& options, const RunSettings& settings, Facts& facts)
{
	refuseOther(options, kTileOptions, "a tile");
	completeWeights(file);
	addKind(facts, "pattern", file.pattern.domain, file.pattern.count(), "");
	addWords(facts, "command", file.command);
	addWords(facts, "made by version", file.version);
	addWords(facts, "weights", file.weights_given ? "" : "none in the file; integrals of the cells are taken");
	facts.measures("quality", measuresOf(measurePattern(file.pattern, settings, file.recipe ? file.recipe->exponent : 0.0)),
				   "measured");
	if (file.quality)
	{
		facts.measures("quality_in_file", measuresOf(*file.quality));
	}
}

void describe(TileFile& file, const InfoOptions& options, const RunSettings& settings, Facts& facts)
{
	const PatternTile& tile = file.tile;
	addKind(facts, "tile", tile.domain, tile.variants.front().count(),
			" in each of " + std::to_string(tile.size) + " x " + std::to_string(tile.size) + " variants" +
				(tile.frames == 1     ? ""
				 : tile.moves.empty() ? " for each of " + std::to_string(tile.frames) + " frames"
									  : " that move in " + std::to_string(tile.frames) + " frames"));
	facts.whole("size", tile.size);
	facts.whole("frames", tile.frames);
	addWords(facts, "command", file.command);
	addWords(facts, "base command", file.base_command);
	addWords(facts, "made by version", file.version);
	// The base pattern is not in the file: what concerns it alone is known only from there.
	TileQuality quality = measureTile(tile, tile.variants.front(), settings);
	std::vector<Measure> measures = measuresOf(quality);
	std::erase_if(measures, [](const Measure& measure) { return measure.name == "base_plane"; });
	facts.measures("quality", measures, "measured");
	// The filters asked for, else those that the file says that it was made for.
	std::vector<TileFilter> filters = readFilters(options.filters);
	if (filters.empty() && file.recipe)
	{
		filters = file.recipe->filters;
	}
	const bool ema_given = isGiven(*options.app, "--ema");
	refuseIf(ema_given && (tile.frames == 1 || filters.empty()),
			 "--ema: found with a tile of one frame or without --filter, expected both");
	if (!filters.empty())
	{
		const std::vector<Measure> behind =
			measuresBehind(tile, filters, file.recipe && !ema_given ? file.recipe->ema : options.ema,
						   options.filters.empty() ? kQuickSteps : kMaxShareSteps, settings);
		refuseIf(behind.empty() && !options.filters.empty(),
				 options.file + ": --filter: found too many taps, frames and samples to measure, expected fewer",
				 ExitCode::invalid_input);
		facts.when(behind.empty()).line("behind filters: not measured, --filter asks for it");
		facts.measures("behind", behind, behind.empty() ? "" : "behind filters");
	}
	if (file.quality)
	{
		facts.measures("quality_in_file", measuresOf(*file.quality));
	}
}

void describeRecipes(const std::string& path, Facts& facts)
{
	const std::vector<MethodRecipe> recipes = readRecipes(path);
	facts.line("recipes: of " + std::to_string(recipes.size()) + (recipes.size() == 1 ? " method" : " methods") +
			   ", lengths in reaches of the rays");
	facts.text("kind", "recipes");
	facts.whole("count", recipes.size());
	for (const MethodRecipe& recipe : recipes)
	{
		addWords(facts, std::string(nameOf(recipe.method)), recipeText(recipe));
	}
}

// The record of nook bake in a file, if there is one. A template, like the next.
void describeBake(const auto& record, Facts& facts)
{
	const auto text = [&](const char* name)
	{
		const nlohmann::ordered_json value = record.value(name, nlohmann::ordered_json());
		return value.is_string() ? value.get<std::string>() : value.is_null() ? "inf" : value.dump();
	};
	if (record.is_null())
	{
		return;
	}
	facts.line("baked: " + text("to") + ", radius " + text("radius_m") + " m, falloff " + text("falloff") + ", " + text("rays") +
			   " rays, by nook " + text("version"));
	for (const char* const name : {"to", "radius_m", "falloff", "rays", "version"})
	{
		facts.text(std::string("bake_") + name, text(name));
	}
	facts.text("bake_command", text("command"), "bake command");
}

// A level, volumes or an image; false for another file. A template, so that only a build with levels needs what it
// calls.
template <class Options> bool describeOfLevels(const Options& options, const RunSettings& settings, Facts& facts)
{
	if (options.file.ends_with(".glb") && holdsVolumes(readFile(options.file))) // a level may have the same ending
	{
		refuseOther(options, kDomainOption, "a pattern without a domain");
		refuseOther(options, kLoadOptions, "a level");
		VolumeFileFacts file;
		const VolumeSet volumes = readVolumes(options.file, file);
		describeVolumes(volumes, file, facts);
	}
	else if (isLevelName(options.file))
	{
		refuseOther(options, kDomainOption, "a pattern without a domain");
		const LoadedLevel loaded = loadLevel(options.file, options.load, settings);
		checkRead(options.outputs, loaded.level.files);
		const ProgressCounter stage(settings.progress, "advice");
		const LevelFacts found = levelFacts(loaded.level, settings.threads);
		describeLevel(loaded, found, masksEstimate(loaded.level, found, settings), bakeEstimate(loaded.level, found), facts);
		describeBake(bakeRecordOf(options.file), facts);
	}
	else if (isImageName(options.file))
	{
		refuseOther(options, kDomainOption, "a pattern without a domain");
		refuseOther(options, kLoadOptions, "a level");
		describeImage(readImage(options.file), facts);
	}
	else
	{
		return false;
	}
	return true;
}

// Tables of the program itself, in place of a file.
void writeTables(const InfoOptions& options)
{
	std::string text = options.methods ? methodsText() : "";
	if (!options.features_of.empty())
	{
		const MethodRow* const row = methodNamed(options.features_of);
		refuseValueIf(row == nullptr, "--options", options.features_of,
					  "one of " + methodNames([](const MethodRow&) { return true; }));
		text += optionsText(*row);
	}
	writeFile("-", text);
}

// A file that is of no level: a pattern, a tile or recipes.
void describePlain(const InfoOptions& options, const RunSettings& settings, Facts& facts)
{
	const std::string ending = nativePath(options.file).extension().string();
	const bool builtin = options.file.starts_with("builtin:");
	if (builtin || (!ending.empty() && ending != ".json" && ending != ".csv"))
	{
		if (!builtin)
		{
			readFile(options.file); // that it is not there comes first
		}
		if (!kHasLevels)
		{
			refuseWithout("levels", "info " + options.file);
		}
		throw Error(ExitCode::invalid_input, options.file + ": found the ending '" + ending + "', expected " + kKinds);
	}
	refuseOther(options, kLoadOptions, "a level");
	if (ending != ".json" || !holdsRecipes(readFile(options.file), options.file))
	{
		std::variant<PatternFile, TileFile> file = readInput(options.file, options.domain);
		std::visit([&](auto& held) { describe(held, options, settings, facts); }, file);
		return;
	}
	refuseOther(options, kDomainOption, "a pattern without a domain");
	refuseOther(options, kTileOptions, "a tile");
	describeRecipes(options.file, facts);
}

void run(InfoOptions& options, VerbProgress& progress)
{
	const bool tables = options.methods || !options.features_of.empty();
	refuseIf(tables != options.file.empty(), tables ? "FILE: found with --methods or --options, expected one of them"
													: "FILE is required, expected what 'nook info --help' lists");
	refuseIf(tables && !options.outputs.progress.empty(),
			 "--progress: found with --methods or --options, which take no time, expected FILE");
	if (tables)
	{
		writeTables(options);
		return;
	}
	checkNames(options.outputs, {options.file});
	const RunSettings settings = progress.start("info", options.outputs.threads, options.outputs.progress);
	Facts facts = verbFacts("info");
	bool described = false;
	if constexpr (kHasLevels)
	{
		described = describeOfLevels(options, settings, facts);
	}
	if (described)
	{
		refuseOther(options, kTileOptions, "a tile");
	}
	else
	{
		describePlain(options, settings, facts);
	}
	writeOutputs(options.outputs, {}, facts.json(), {}, facts.lines());
}

void declare(CLI::App& app, InfoOptions& options)
{
	addOptions(
		app,
		{{"FILE", takesText(options.file, "FILE"), std::string("Of nook or of someone else: ") + kKinds},
		 {"--methods", takesFlag(options.methods), "Without FILE: the table of methods, as Markdown"},
		 {"--options", takesText(options.features_of, "METHOD"), "Without FILE: the options that a method alone has, as Markdown"},
		 {"--domain", takesChoice(patternDomains(), options.domain), "Domain of a file that does not say it"},
		 filterRow(options.filters,
				   "Tiles: the error behind a filter (default: those that it was made for): none, box:N, binomial:N, gauss:SIGMA, "
				   "bilateral:N or file:KERNEL.json; may be repeated"),
		 emaRow(options.ema)});
	addLoadOptions(app, options.load);
	addJson(app, options.outputs.json);
	addRun(app, options.outputs);
	options.app = &app;
}

} // namespace

Verb addInfoVerb(CLI::App& nook)
{
	return addVerb<InfoOptions>(
		nook, "info", "Says what a pattern, a tile, recipes, a level, volumes or an image hold, measured again", declare, run);
}

} // namespace nook
