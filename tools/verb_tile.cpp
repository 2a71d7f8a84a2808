// SPDX-License-Identifier: GPL-3.0-or-later
// nook tile: a pattern → its variants for the pixels of a blur window.
#include "filter_options.h"
#include "memory_option.h"
#include "summary.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "format/input.h"
#include "format/pattern_file.h"
#include "pattern/tile.h"
#include "version.h"

#include <filesystem>

namespace nook
{
namespace
{

struct TileOptions
{
	std::string pattern;
	int slices = 1; // of a pixel, where slices are asked for
	CLI::Option* slice_given = nullptr;
	CLI::Option* count_given = nullptr;
	TileRecipe recipe;
	FilterOptions filters;
	std::string name;
	Outputs outputs;
	uint64_t memory_bytes = uint64_t{4} << 30U;
	int threads = 0;
};

void declare(CLI::App& app, TileOptions& options)
{
	TileRecipe& recipe = options.recipe;
	addText(app, "--pattern", options.pattern, "FILE", "The base pattern, .json or .csv: disk, ball or hemisphere");
	options.slice_given = addChoiceText(
		app, "--domain", std::span(namesOf<Domain>()).subspan(static_cast<std::size_t>(Domain::slice)), [](std::size_t) {},
		"In place of --pattern: azimuths and jitters for --method slices");
	options.count_given =
		addWhole(app, "--count", options.slices, 1, kMostSlices, "With --domain slice: slices a pixel (default 1)");
	addWhole(app, "--size", recipe.size, 2, kMaxTileSize, "Width of the window in pixels; above 8 with --filter alone")->required();
	addChoice(app, "--kind", recipe.kind,
			  "Points of their own for every variant (default), the base pattern turned and scaled, turned by even steps, or "
			  "reflected at random");
	addFilters(
		app, options.filters,
		"Makes the tile for what is seen behind a filter, in place of the window's mean: none, box:N, binomial:N, gauss:SIGMA, "
		"bilateral:N or file:KERNEL.json; with @SHARE how much it counts; may be repeated");
	app.add_flag("--robust", recipe.robust, "With --filter: also where an edge cuts off half of its taps");
	addWhole(app, "--frames", recipe.frames, 2, kMaxTileFrames,
			 "With --filter: a tile for each frame of a cycle, for engines that average over frames");
	app.add_flag("--moves", recipe.moves, "With --frames: one tile that moves from frame to frame, in place of one a frame");
	app.add_flag("--progressive", recipe.progressive,
				 "--kind points: each variant's samples in the order whose prefixes err least, for --bands and --counts");
	addNumber(app, "--lambda", recipe.lambda, 1e-6, 1e6,
			  "Weight of the variants' own error against that of the window (default: by kind)");
	addWhole(app, "--starts", recipe.starts, 1, 1000, "Independent starts, the best is kept (default: by kind)");
	addSeed(app, recipe.seed);
	addMemory(app, options.memory_bytes, "Refuses, before work starts, a tile that may take more (default 4GiB)");
	addText(app, "--name", options.name, "IDENT", "Stem of the identifiers in source files (default: from the pattern)");
	addOutputs(app, options.outputs, tileFormats());
	addThreads(app, options.threads);
	addProgress(app, options.outputs.progress);
}

// The base, and the command that made it.
PatternFile baseOf(const TileOptions& options)
{
	PatternFile file;
	if (options.slice_given->count() > 0)
	{
		file.pattern = slicePattern(options.slices);
		return file;
	}
	file = readPattern(options.pattern);
	completeWeights(file);
	return file;
}

void checkBase(const TileOptions& options)
{
	const bool slices = options.slice_given->count() > 0;
	if (slices == !options.pattern.empty())
	{
		throw Error(ExitCode::usage, std::string("--pattern: ") + (slices ? "found with" : "missing without") +
										 " --domain slice, expected one of them");
	}
	if (options.count_given->count() > 0 && !slices)
	{
		throw Error(ExitCode::usage, "--count: found with --pattern, whose count it is, expected --domain slice");
	}
}

void run(const TileOptions& options, VerbProgress& progress)
{
	checkName(options.name);
	checkBase(options);
	std::vector<std::string> inputs = filterFiles(options.filters.names);
	if (!options.pattern.empty())
	{
		inputs.push_back(options.pattern);
	}
	checkOutputs(options.outputs, tileFormats(), inputs);
	const RunSettings settings = progress.start("tile", options.threads, options.outputs.progress);
	const PatternFile file = baseOf(options);
	const Pattern& base = file.pattern;
	TileRecipe recipe = options.recipe;
	recipe.filters = filtersOf(options.filters.names);
	recipe.ema = options.filters.ema;
	if (recipe.frames == 1 && options.filters.ema_given->count() > 0)
	{
		throw Error(ExitCode::usage, "--ema: found without --frames, expected both");
	}
	checkTileRecipe(recipe, base.domain);
	checkTileSize(recipe, base, options.memory_bytes, settings.threads);
	const PatternTile tile = generateTile(base, recipe, settings);
	const TileQuality quality = measureTile(tile, base, settings);
	// The folder is this machine's affair; the base's own command says how to make it.
	const std::string command = base.domain == Domain::slice ? sliceCommandOf(recipe, base.count())
															 : commandOf(recipe, nativePath(options.pattern).filename().string());
	const EmitContext context{command, NOOK_VERSION, options.name, file.command};

	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, tileBytes(formatOf(path, tileFormats()), tile, &recipe, quality, context));
	}
	Summary summary("tile");
	summary.text("command", context.command);
	summary.text("base_command", context.base_command);
	summary.text("domain", nameOf(tile.domain));
	summary.whole("count", base.count());
	summary.whole("size", static_cast<std::size_t>(tile.size));
	summary.measures("quality", measuresOf(quality));
	summary.measures("behind", measuresBehind(tile, recipe.filters, recipe.ema, kMaxShareSteps, settings));
	addSide(files, options.outputs, summary.json(), inputs);
	files.commit();
}

} // namespace

Verb addTileVerb(CLI::App& nook)
{
	const auto options = std::make_shared<TileOptions>();
	CLI::App* const app = nook.add_subcommand("tile", "Makes the variants of a pattern for the pixels of a blur window");
	declare(*app, *options);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
