// SPDX-License-Identifier: GPL-3.0-or-later
// nook info: a pattern, a tile, recipes, a level, volumes or an image, ours or someone else's → what it holds, measured again.
#include "components.h"
#include "info_of_levels.h"
#include "recipe_options.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "core/text.h"
#include "format/input.h"
#include "measure/quality.h"
#include "methods/table_text.h"

#include <filesystem>

namespace nook
{
namespace
{

// What a file may be, by its ending.
constexpr const char* kKinds =
	"a pattern (.json .csv), a tile or recipes (.json), a level (.gltf .glb .obj .fbx .ply .stl) or builtin:NAME, "
	"volumes (.glb), a "
	"G-buffer or any other image (.exr .png .jpg .tif .hdr .tga .bmp), or a part of a command (.part)";

void describe(PatternFile& file, const InfoOptions& options, const RunSettings& settings, Answer& answer)
{
	refuseGiven({options.filters.filter_given, options.filters.ema_given}, "a tile");
	completeWeights(file);
	answer.kind("pattern", file.pattern.domain, file.pattern.count());
	answer.lines += "\n";
	answer.fact("command", file.command);
	answer.fact("made by version", file.version);
	answer.fact("weights", file.weights_given ? "" : "none in the file; integrals of the cells are taken");
	answer.measures(measuresOf(measurePattern(file.pattern, settings, file.recipe ? file.recipe->exponent : 0.0)));
	if (file.quality)
	{
		answer.summary.measures("quality_in_file", measuresOf(*file.quality));
	}
}

void describe(TileFile& file, const InfoOptions& options, const RunSettings& settings, Answer& answer)
{
	const PatternTile& tile = file.tile;
	answer.kind("tile", tile.domain, tile.variants.front().count());
	answer.lines += " in each of " + std::to_string(tile.size) + " x " + std::to_string(tile.size) + " variants" +
					(tile.frames == 1     ? ""
					 : tile.moves.empty() ? " for each of " + std::to_string(tile.frames) + " frames"
										  : " that move in " + std::to_string(tile.frames) + " frames") +
					"\n";
	answer.summary.whole("size", static_cast<std::size_t>(tile.size));
	answer.summary.whole("frames", static_cast<std::size_t>(tile.frames));
	answer.fact("command", file.command);
	answer.fact("base command", file.base_command);
	answer.fact("made by version", file.version);
	// The base pattern is not in the file: what concerns it alone is known only from there.
	TileQuality quality = measureTile(tile, tile.variants.front(), settings);
	std::vector<Measure> measures = measuresOf(quality);
	std::erase_if(measures, [](const Measure& measure) { return measure.name == "base_plane"; });
	answer.measures(measures);
	// Behind what is asked for, else behind what the file says that it was made for.
	std::vector<TileFilter> filters = filtersOf(options.filters.names);
	if (filters.empty() && file.recipe)
	{
		filters = file.recipe->filters;
	}
	const bool ema_given = options.filters.ema_given->count() > 0;
	if (ema_given && (tile.frames == 1 || filters.empty()))
	{
		throw Error(ExitCode::usage, "--ema: found with a tile of one frame or without --filter, expected both");
	}
	if (!filters.empty())
	{
		const std::vector<Measure> behind =
			measuresBehind(tile, filters, file.recipe && !ema_given ? file.recipe->ema : options.filters.ema,
						   options.filters.names.empty() ? kQuickSteps : kMaxShareSteps, settings);
		if (behind.empty() && !options.filters.names.empty())
		{
			throw Error(ExitCode::invalid_input, options.file + ": --filter: found too many taps, frames and samples to measure, "
																"expected fewer");
		}
		answer.lines +=
			behind.empty() ? "behind filters: not measured, --filter asks for it\n" : "behind filters:\n" + measureLines(behind);
		answer.summary.measures("behind", behind);
	}
	if (file.quality)
	{
		answer.summary.measures("quality_in_file", measuresOf(*file.quality));
	}
}

bool isRecipes(const std::string& path)
{
	return nativePath(path).extension() == ".json" && holdsRecipes(readFile(path), path);
}

void describeRecipes(const std::string& path, Answer& answer)
{
	const std::vector<MethodRecipe> recipes = readRecipes(path);
	answer.lines += "recipes: of " + std::to_string(recipes.size()) + (recipes.size() == 1 ? " method" : " methods") +
					", lengths in reaches of the rays\n";
	answer.summary.text("kind", "recipes");
	answer.summary.whole("count", recipes.size());
	for (const MethodRecipe& recipe : recipes)
	{
		answer.fact(std::string(nameOf(recipe.method)), recipeText(recipe));
	}
}

// What a part has done, and of what.
void describePart(const std::string& path, Answer& answer)
{
	const PartFile part = partFrom(readFile(path), path);
	const std::string place = std::to_string(part.part.number) + " of " + std::to_string(part.part.of);
	std::string command = "nook";
	for (const std::string& word : part.command)
	{
		command += " " + word;
	}
	answer.lines += "part: " + place + "\n";
	answer.summary.text("kind", "part");
	answer.summary.whole("part", static_cast<std::size_t>(part.part.number));
	answer.summary.whole("parts", static_cast<std::size_t>(part.part.of));
	answer.fact("command", oneLine(command));
	answer.fact("made by version", oneLine(part.version));
	std::vector<std::string> inputs;
	for (const PartInput& input : part.inputs)
	{
		inputs.push_back(input.path);
		answer.lines += "input: " + oneLine(input.path) + "\n";
	}
	answer.summary.texts("inputs", inputs);
	for (const auto& [name, units] : part.stages)
	{
		answer.lines +=
			"stage: " + oneLine(name) + ", " + std::to_string(units.size()) + (units.size() == 1 ? " unit\n" : " units\n");
	}
}

} // namespace

void refuseGiven(const std::vector<CLI::Option*>& options, const std::string& expected)
{
	for (const CLI::Option* option : options)
	{
		if (option->count() > 0)
		{
			throw Error(ExitCode::usage, option->get_name() + ": found with another kind of file, expected " + expected);
		}
	}
}

namespace
{

// Tables of the program itself, in place of a file.
void writeTables(const InfoOptions& options)
{
	std::string text = options.methods ? methodsText() : "";
	if (!options.features_of.empty())
	{
		const MethodRow* const row = methodNamed(options.features_of);
		if (row == nullptr)
		{
			refuseValue("--options", options.features_of, "one of " + methodNames([](const MethodRow&) { return true; }));
		}
		text += optionsText(*row);
	}
	writeFile("-", text);
}

void describeSamples(const InfoOptions& options, const RunSettings& settings, Answer& answer)
{
	const std::optional<Domain> domain = options.domain_given->count() > 0 ? std::optional(options.domain) : std::nullopt;
	std::variant<PatternFile, TileFile> file = readInput(options.file, domain);
	std::visit([&](auto& held) { describe(held, options, settings, answer); }, file);
}

// A file that is of no level: a pattern or a tile, recipes, a part of a command.
void describePlain(const InfoOptions& options, const RunSettings& settings, Answer& answer)
{
	const std::string ending = nativePath(options.file).extension().string();
	const bool builtin = options.file.starts_with("builtin:");
	const bool part = !builtin && ending == ".part";
	if (builtin || (!part && !ending.empty() && ending != ".json" && ending != ".csv"))
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
	refuseGiven(options.load_given, "a level");
	if (!part && !isRecipes(options.file))
	{
		describeSamples(options, settings, answer);
		return;
	}
	refuseGiven({options.domain_given}, "a pattern without a domain");
	refuseGiven({options.filters.filter_given, options.filters.ema_given}, "a tile");
	part ? describePart(options.file, answer) : describeRecipes(options.file, answer);
}

void run(const InfoOptions& options, VerbProgress& progress)
{
	const bool tables = options.methods || !options.features_of.empty();
	if (tables != options.file.empty())
	{
		throw Error(ExitCode::usage, tables ? "FILE: found with --methods or --options, expected one of them"
											: "FILE is required, expected what 'nook info --help' lists");
	}
	if (tables && !options.progress.empty())
	{
		throw Error(ExitCode::usage, "--progress: found with --methods or --options, which take no time, expected FILE");
	}
	if (tables)
	{
		writeTables(options);
		return;
	}
	checkNames({{}, options.json, {}, options.progress}, {options.file});
	const RunSettings settings = progress.start("info", options.threads, options.progress);
	Answer answer;
	bool described = false;
	if constexpr (kHasLevels)
	{
		described = describeOfLevels(options, settings, answer);
	}
	if (described)
	{
		refuseGiven({options.filters.filter_given, options.filters.ema_given}, "a tile");
	}
	else
	{
		describePlain(options, settings, answer);
	}
	OutputSet files;
	if (!options.json.empty())
	{
		files.add(options.json, answer.summary.json());
	}
	if (options.json != "-" && options.progress != "-")
	{
		files.add("-", answer.lines);
	}
	files.commit();
}

} // namespace

Verb addInfoVerb(CLI::App& nook)
{
	const auto options = std::make_shared<InfoOptions>();
	CLI::App* const app =
		nook.add_subcommand("info", "Says what a pattern, a tile, recipes, a level, volumes or an image hold, measured again");
	addText(*app, "FILE", options->file, "FILE", std::string("Of nook or of someone else: ") + kKinds);
	app->add_flag("--methods", options->methods, "Without FILE: the table of methods, as Markdown");
	addText(*app, "--options", options->features_of, "METHOD", "Without FILE: the options that a method alone has, as Markdown");
	options->domain_given = addDomain(*app, options->domain, "Domain of a file that does not say it");
	addFilters(
		*app, options->filters,
		"Tiles: the error behind a filter (default: those that it was made for): none, box:N, binomial:N, gauss:SIGMA, bilateral:N "
		"or file:KERNEL.json; may be repeated");
	options->load_given = addLoadOptions(*app, options->load);
	addJson(*app, options->json);
	addThreads(*app, options->threads);
	addProgress(*app, options->progress);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
