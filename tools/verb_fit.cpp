// SPDX-License-Identifier: GPL-3.0-or-later
// nook fit: levels → a recipe of each method, fitted to rays.
#include "options.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "core/text.h"
#include "core/work_units.h"
#include "methods/method_table.h"
#include "methods/recipes.h"
#include "study/fit.h"
#include "version.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kFitFormats{".json"};

struct FitOptions
{
	std::vector<std::string> levels;
	std::vector<std::string> held_out;
	std::string methods;
	std::string start;
	LoadSettings load;
	FitSettings settings;
	Outputs outputs;
};

std::string fittedNames()
{
	return methodNames([](const MethodRow& row)
					   { return row.kind == MethodKind::screen && recipeFor(raysRecipes(), row.method) != nullptr; });
}

void declare(CLI::App& app, FitOptions& options)
{
	FitSettings& settings = options.settings;
	app.add_option("LEVEL", options.levels, "Levels to fit to: files that nook reads, or builtin:NAME")->required();
	app.add_option("--held-out", options.held_out, "Levels to try the recipes on that they are not fitted to")
		->type_name("LEVEL ...");
	addOptions(app, {{"--methods", takesText(options.methods, "LIST"), "With commas between: " + fittedNames() + " (default: all)"},
					 {"--start", takesText(options.start, "FILE.json"), "Recipes to begin with (default: those of --recipe rays)"},
					 {"--radius", takesNumber(settings.radius_m, 1e-6, 1e9, "M"),
					  "Reach of occlusion in metres, with linear falloff (default: by each level's size, 1.5 m at most)"}});
	addOptions(app, {sizeRow(settings.width_px, settings.height_px),
					 {"--views", takesWhole(settings.views, 1, 64), "Views of each level, the most informative ones (default 2)"},
					 {"--rays", takesWhole(settings.reference_rays, 1, 1 << 20), "Rays a pixel of the reference (default 256)"}});
	addLoadOptions(app, options.load);
	addOutputs(app, options.outputs, kFitFormats);
	addRun(app, options.outputs, true);
}

std::vector<MethodRecipe> startsOf(const FitOptions& options)
{
	const std::vector<MethodRecipe> all =
		options.start.empty() ? std::vector<MethodRecipe>(raysRecipes().begin(), raysRecipes().end()) : readRecipes(options.start);
	if (options.methods.empty())
	{
		return all;
	}
	std::vector<MethodRecipe> chosen;
	for (const std::string& name : partsOf(options.methods))
	{
		const MethodRow* const row = methodNamed(name);
		const MethodRecipe* const start = row != nullptr && row->kind == MethodKind::screen ? recipeFor(all, row->method) : nullptr;
		refuseValueIf(start == nullptr || recipeFor(chosen, row->method) != nullptr, "--methods", name,
					  "some of " + fittedNames() + ", each once, with a recipe to begin with");
		chosen.push_back(*start);
	}
	return chosen;
}

std::string fitCommand(const FitOptions& options)
{
	const FitSettings& settings = options.settings;
	std::string command = "nook fit " + joinedText(options.levels, " ", shellWord);
	command += options.held_out.empty() ? "" : " --held-out " + joinedText(options.held_out, " ", shellWord);
	command += options.methods.empty() ? "" : " --methods " + options.methods;
	command += options.start.empty() ? "" : " --start " + shellWord(options.start);
	command += settings.radius_m > 0.0 ? " --radius " + numberText(settings.radius_m) : "";
	command += " --size " + std::to_string(settings.width_px) + "x" + std::to_string(settings.height_px) + " --views " +
			   std::to_string(settings.views) + " --rays " + std::to_string(settings.reference_rays);
	return command + loadOptions(options.load);
}

// A line a method, then one a level of it.
std::string linesOf(const FitReport& report)
{
	std::string text;
	for (const MethodFit& fit : report.fits)
	{
		const MethodRecipe& recipe = *fit.candidate.recipe;
		text += std::string(nameOf(recipe.method)) + ": " + std::to_string(fit.tried) + " tried, " + recipeText(recipe);
		text += "\n";
		for (std::size_t i = 0; i < report.levels.size(); ++i)
		{
			text += "  " + report.levels[i].name + (report.levels[i].held_out ? " (held out)" : "") + ": rmse " +
					fixedText(fit.errors[i].paper, 4) + " -> " + fixedText(fit.errors[i].rays, 4) + "\n";
		}
	}
	return text;
}

void run(FitOptions& options, VerbProgress& progress)
{
	std::vector<std::string> inputs = options.levels;
	append(inputs, options.held_out);
	inputs.push_back(options.start);
	checkOutputs(options.outputs, kFitFormats, inputs);
	const RunSettings how = progress.start("fit", options.outputs.threads, options.outputs.progress);
	options.settings.starts = startsOf(options);
	if (!options.start.empty())
	{
		addInputs({options.start}, how);
	}
	const FitReport report = fitRecipes(options.levels, options.held_out, options.load, options.settings, how);
	std::vector<std::string> read;
	for (const FitLevel& level : report.levels)
	{
		append(read, level.files);
	}
	checkRead(options.outputs, read);
	if (isShare(how))
	{
		return;
	}
	const std::string json = fitJson(report, fitCommand(options), NOOK_VERSION);
	read.push_back(options.start);
	writeOutputs(
		options.outputs, [&](const std::string&) { return json; }, json, read, linesOf(report));
}

} // namespace

Verb addFitVerb(CLI::App& nook)
{
	return addVerb<FitOptions>(nook, "fit", "Fits the settings of methods to ray tracing: recipes for nook shade and nook emit",
							   declare, run);
}

} // namespace nook
