// SPDX-License-Identifier: GPL-3.0-or-later
// nook pattern: recipe → one pattern, in the formats asked for.
#include "options.h"

#include "core/file.h"
#include "format/pattern_file.h"
#include "pattern/recipe.h"
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
	std::optional<Method> method;
};

void declare(CLI::App& app, PatternOptions& options)
{
	Recipe& recipe = options.recipe;
	addOptions(
		app,
		{{"--domain", takesChoice(patternDomains(), recipe.domain),
		  "Line samples in the disk, point samples in the ball, directions, or cosine-weighted directions", kRequired},
		 {"--count", takesWhole(recipe.count, 1, kMaxCount), "Samples, 1 to 4096", kRequired},
		 {"--centre", takesFlag(recipe.centre), "Disk and ball: a sample at the centre"},
		 {"--symmetric", takesFlag(recipe.symmetric),
		  "Not hemisphere: p and -p with equal weights; a centre where the count is odd"},
		 {"--method", takesChoice(namesOf<Method>(), options.method),
		  "Default refine: gradient descent on a measure from the best of electro and others; the last five are there to compare "
		  "with"},
		 {"--minimise", takesChoice(namesOf<Minimise>(), recipe.minimise), "What refine lowers (default rms: the plane error)"},
		 {"--weights", takesChoice(namesOf<WeightRule>(), recipe.weights),
		  "Integrals of the cells (default), all equal, or least squares on the half-spaces"},
		 {"--order", takesChoice(namesOf<Order>(), recipe.order), "As it comes (default), or every prefix good"},
		 {"--starts", takesWhole(recipe.starts, 1, 100000),
		  "Independent starting sets, the best is kept (default: by method and count)"},
		 seedRow(recipe.seed),
		 {"--exponent", takesNumber(recipe.exponent, 0.1, 64.0),
		  "Sphere: repulsion by the energy of d^-X (1: Thomson's problem); means --method electro"},
		 {"--name", takesText(options.name, "IDENT"), "Stem of the identifiers in source files (default: from the options)"}});
	addOutputs(app, options.outputs, patternFormats());
	addRun(app, options.outputs);
}

void check(PatternOptions& options)
{
	options.recipe.method = options.method.value_or(options.recipe.exponent > 0.0 ? Method::electro : options.recipe.method);
	checkRecipe(options.recipe);
	checkName(options.name);
	checkOutputs(options.outputs, patternFormats());
}

void run(PatternOptions& options, VerbProgress& progress)
{
	check(options);
	const RunSettings settings = progress.start("pattern", options.outputs.threads, options.outputs.progress);
	const Pattern pattern = generatePattern(options.recipe, settings, pageWatch());
	const Quality quality = measurePattern(pattern, settings, options.recipe.exponent);
	const EmitContext context{patternCommand(options.recipe), NOOK_VERSION, options.name, ""};

	Facts facts = verbFacts("pattern");
	facts.text("command", context.command);
	facts.text("domain", nameOf(pattern.domain));
	facts.whole("count", pattern.count());
	facts.measures("quality", measuresOf(quality));
	giveSamples({&pattern, 1}, {pattern.count()});
	const auto bytesOf = [&](const std::string& path)
	{
		return patternBytes(formatOf(path, patternFormats()), pattern, &options.recipe, quality, context);
	};
	writeOutputs(options.outputs, bytesOf, facts.json(), {});
}

} // namespace

Verb addPatternVerb(CLI::App& nook)
{
	return addVerb<PatternOptions>(nook, "pattern", "Makes one pattern", declare, run);
}

} // namespace nook
