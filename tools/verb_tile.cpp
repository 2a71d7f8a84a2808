// SPDX-License-Identifier: GPL-3.0-or-later
// nook tile: a pattern → its variants for the pixels of a blur window.
#include "options.h"

#include "core/system.h"
#include "format/pattern_file.h"
#include "format/tile_json.h"
#include "pattern/tile.h"
#include "version.h"

namespace nook
{
namespace
{

struct TileOptions
{
	std::string pattern;
	int slices = 1;                          // of a pixel, where slices are asked for
	std::optional<std::size_t> slice_domain; // 0 where it is given, in place of a pattern
	TileRecipe recipe;
	std::vector<std::string> filters;
	std::string name;
	Outputs outputs;
	uint64_t memory_bytes = uint64_t{4} << 30U;
};

void declare(CLI::App& app, TileOptions& options)
{
	TileRecipe& recipe = options.recipe;
	addOptions(
		app,
		{{"--pattern", takesText(options.pattern, "FILE"), "The base pattern, .json or .csv: disk, ball or hemisphere"},
		 {"--domain",
		  takesChoice(std::span(namesOf<Domain>()).subspan(static_cast<std::size_t>(Domain::slice)), options.slice_domain),
		  "In place of --pattern: azimuths and jitters for --method slices"},
		 {"--count", takesWhole(options.slices, 1, kMostSlices), "With --domain slice: slices a pixel (default 1)",
		  needs("--domain", "--domain slice", "with --pattern, whose count it is")},
		 {"--size", takesWhole(recipe.size, 2, kMaxTileSize), "Width of the window in pixels; above 8 with --filter alone",
		  kRequired},
		 {"--kind", takesChoice(namesOf<TileKind>(), recipe.kind),
		  "Points of their own for every variant (default), or the base pattern turned by even steps, or reflected at random"},
		 filterRow(options.filters,
				   "Makes the tile for what is seen behind a filter, in place of the window's mean: none, box:N, binomial:N, "
				   "gauss:SIGMA, bilateral:N or file:KERNEL.json; with @SHARE how much it counts; may be repeated"),
		 emaRow(recipe.ema, needs("--frames")),
		 {"--robust", takesFlag(recipe.robust), "With --filter: also where an edge cuts off half of its taps"},
		 {"--frames", takesWhole(recipe.frames, 2, kMaxTileFrames),
		  "With --filter: a tile for each frame of a cycle, for engines that average over frames"},
		 {"--moves", takesFlag(recipe.moves), "With --frames: one tile that moves from frame to frame, in place of one a frame"},
		 {"--progressive", takesFlag(recipe.progressive),
		  "--kind points: each variant's samples in the order whose prefixes err least, for --bands and --counts"},
		 {"--lambda", takesNumber(recipe.lambda, 1e-6, 1e6),
		  "Weight of the variants' own error against that of the window (default: by filters and frames)"},
		 {"--starts", takesWhole(recipe.starts, 1, 1000), "Independent starts, the best is kept (default: by domain and size)"},
		 seedRow(recipe.seed),
		 {"--memory", takesBytes(options.memory_bytes), "Refuses, before work starts, a tile that may take more (default 4GiB)"},
		 {"--name", takesText(options.name, "IDENT"), "Stem of the identifiers in source files (default: from the pattern)"}});
	addOutputs(app, options.outputs, tileFormats());
	addRun(app, options.outputs);
}

// The base, and the command that made it.
PatternFile baseOf(const TileOptions& options)
{
	PatternFile file;
	if (options.slice_domain)
	{
		file.pattern = slicePattern(options.slices);
		return file;
	}
	file = readPattern(options.pattern);
	completeWeights(file);
	return file;
}

void run(TileOptions& options, VerbProgress& progress)
{
	checkName(options.name);
	refuseIf(options.slice_domain.has_value() == !options.pattern.empty(),
			 std::string("--pattern: ") + (options.slice_domain ? "found with" : "missing without") +
				 " --domain slice, expected one of them");
	std::vector<std::string> inputs = filterFiles(options.filters);
	inputs.push_back(options.pattern);
	checkOutputs(options.outputs, tileFormats(), inputs);
	const RunSettings settings = progress.start("tile", options.outputs.threads, options.outputs.progress);
	const PatternFile file = baseOf(options);
	const Pattern& base = file.pattern;
	TileRecipe recipe = options.recipe;
	recipe.filters = readFilters(options.filters);
	checkTileRecipe(recipe, base.domain);
	checkTileSize(recipe, base, options.memory_bytes, settings.threads);
	const PatternTile tile = generateTile(base, recipe, settings);
	const TileQuality quality = measureTile(tile, base, settings);
	// The folder is this machine's affair; the base's own command says how to make it.
	const std::string command = base.domain == Domain::slice ? sliceTileCommand(recipe, base.count())
															 : tileCommand(recipe, nativePath(options.pattern).filename().string());
	const EmitContext context{command, NOOK_VERSION, options.name, file.command};

	Facts facts = verbFacts("tile");
	facts.text("command", context.command);
	facts.text("base_command", context.base_command);
	facts.text("domain", nameOf(tile.domain));
	facts.whole("count", base.count());
	facts.whole("size", tile.size);
	facts.measures("quality", measuresOf(quality));
	facts.measures("behind", measuresBehind(tile, recipe.filters, recipe.ema, kMaxShareSteps, settings));
	giveSamples(tile.variants, {tile.variants.size(), base.count()});
	const auto bytesOf = [&](const std::string& path)
	{
		return tileBytes(formatOf(path, tileFormats()), tile, &recipe, quality, context);
	};
	writeOutputs(options.outputs, bytesOf, facts.json(), inputs);
}

} // namespace

Verb addTileVerb(CLI::App& nook)
{
	return addVerb<TileOptions>(nook, "tile", "Makes the variants of a pattern for the pixels of a blur window", declare, run);
}

} // namespace nook
