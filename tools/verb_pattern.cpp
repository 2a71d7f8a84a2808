// SPDX-License-Identifier: GPL-3.0-or-later
// nook pattern: recipe → one pattern, in the formats asked for.
#include "options.h"
#include "summary.h"
#include "watch.h"

#include "core/file.h"
#include "format/pattern_file.h"
#include "pattern/generate.h"
#include "version.h"

namespace nook
{
namespace
{

struct PatternOptions
{
	Recipe recipe;
	std::string name;
	Outputs outputs;
	int threads = 0;
	CLI::Option* method = nullptr;
	CLI::Option* exponent = nullptr;
};

void declare(CLI::App& app, PatternOptions& options)
{
	Recipe& recipe = options.recipe;
	addDomain(app, recipe.domain, "Line samples in the disk, point samples in the ball, directions, or cosine-weighted directions")
		->required();
	addWhole(app, "--count", recipe.count, 1, kMaxCount, "Samples, 1 to 4096")->required();
	app.add_flag("--centre", recipe.centre, "Disk and ball: a sample at the centre");
	app.add_flag("--symmetric", recipe.symmetric, "Not hemisphere: p and -p with equal weights; a centre where the count is odd");
	options.method =
		addChoice(app, "--method", recipe.method,
				  "Default refine: gradient descent on a measure from the best of electro and others; the last five are "
				  "there to compare with");
	addChoice(app, "--minimise", recipe.minimise, "What refine lowers (default rms: the plane error)");
	addChoice(app, "--weights", recipe.weights, "Integrals of the cells (default), all equal, or least squares on the half-spaces");
	addChoice(app, "--voronoi", recipe.voronoi, "Exact cells (default), or the grids of Loos and Sloan 2010");
	addChoice(app, "--order", recipe.order, "As it comes (default), every prefix good, or neighbours together");
	addWhole(app, "--starts", recipe.starts, 1, 100000,
			 "Independent starting sets, the best is kept (default: by method and count)");
	addSeed(app, recipe.seed);
	options.exponent = addNumber(app, "--exponent", recipe.exponent, 0.1, 64.0,
								 "Sphere: repulsion by the energy of d^-X (1: Thomson's problem); means --method electro");
	addText(app, "--name", options.name, "IDENT", "Stem of the identifiers in source files (default: from the options)");
	addOutputs(app, options.outputs, patternFormats());
	addThreads(app, options.threads);
	addProgress(app, options.outputs.progress);
}

void check(PatternOptions& options)
{
	if (options.exponent->count() > 0 && options.method->count() == 0)
	{
		options.recipe.method = Method::electro;
	}
	checkRecipe(options.recipe);
	checkName(options.name);
	checkOutputs(options.outputs, patternFormats());
}

void run(PatternOptions& options, VerbProgress& progress)
{
	check(options);
	const RunSettings settings = progress.start("pattern", options.threads, options.outputs.progress);
	const Pattern pattern = generatePattern(options.recipe, settings, pageWatch());
	const Quality quality = measurePattern(pattern, settings, options.recipe.exponent);
	const EmitContext context{commandOf(options.recipe), NOOK_VERSION, options.name, ""};

	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, patternBytes(formatOf(path, patternFormats()), pattern, &options.recipe, quality, context));
	}
	Summary summary("pattern");
	summary.text("command", context.command);
	summary.text("domain", nameOf(pattern.domain));
	summary.whole("count", pattern.count());
	summary.measures("quality", measuresOf(quality));
	addSide(files, options.outputs, summary.json(), {});
	files.commit();
}

} // namespace

Verb addPatternVerb(CLI::App& nook)
{
	const auto options = std::make_shared<PatternOptions>();
	CLI::App* const app = nook.add_subcommand("pattern", "Makes one pattern");
	declare(*app, *options);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
