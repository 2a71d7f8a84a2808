// SPDX-License-Identifier: GPL-3.0-or-later
// nook tile: a pattern → its variants for the pixels of a blur window.
#include "options.h"
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
	TileRecipe recipe;
	std::string name;
	Outputs outputs;
	int threads = 0;
};

void declare(CLI::App& app, TileOptions& options)
{
	TileRecipe& recipe = options.recipe;
	addText(app, "--pattern", options.pattern, "FILE", "The base pattern, .json or .csv: disk, ball or hemisphere")->required();
	addWhole(app, "--size", recipe.size, 2, 8, "Width of the window in pixels: 2, 3, 4, 5 or 8")->required();
	addChoice(app, "--kind", recipe.kind,
			  "Points of their own for every variant (default), the base pattern turned and scaled, turned by even steps, or "
			  "reflected at random");
	addNumber(app, "--lambda", recipe.lambda, 1e-6, 1e6,
			  "Weight of the variants' own error against that of the window (default: by kind)");
	addWhole(app, "--starts", recipe.starts, 1, 1000, "Independent starts, the best is kept (default: by kind)");
	addSeed(app, recipe.seed);
	addText(app, "--name", options.name, "IDENT", "Stem of the identifiers in source files (default: from the pattern)");
	addOutputs(app, options.outputs, tileFormats());
	addThreads(app, options.threads);
}

void run(const TileOptions& options)
{
	checkName(options.name);
	checkOutputs(options.outputs, tileFormats(), {options.pattern});
	PatternFile file = readPattern(options.pattern);
	completeWeights(file);
	const Pattern& base = file.pattern;
	checkTileRecipe(options.recipe, base.domain);
	const RunSettings settings = runSettings(options.threads);
	const PatternTile tile = generateTile(base, options.recipe, settings);
	const TileQuality quality = measureTile(tile, base, settings);
	// The folder is this machine's affair; the base's own command says how to make it.
	const std::string command = commandOf(options.recipe, nativePath(options.pattern).filename().string());
	const EmitContext context{command, NOOK_VERSION, options.name, file.command};

	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, tileBytes(formatOf(path, tileFormats()), tile, &options.recipe, quality, context));
	}
	Summary summary("tile");
	summary.text("command", context.command);
	summary.text("base_command", context.base_command);
	summary.text("domain", nameOf(tile.domain));
	summary.whole("count", base.count());
	summary.whole("size", static_cast<std::size_t>(tile.size));
	summary.measures("quality", measuresOf(quality));
	addSide(files, options.outputs, summary.json(), {options.pattern});
	files.commit();
}

} // namespace

Verb addTileVerb(CLI::App& nook)
{
	const auto options = std::make_shared<TileOptions>();
	CLI::App* const app = nook.add_subcommand("tile", "Makes the variants of a pattern for the pixels of a blur window");
	declare(*app, *options);
	return {app, [options]
			{
				run(*options);
			}};
}

} // namespace nook
