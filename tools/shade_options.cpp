// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade_options.h"

#include "debug_options.h"
#include "volume_methods.h"

#include "core/error.h"

#include <algorithm>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 2> kDevices{"cpu", "gl"};
constexpr std::array<std::string_view, 4> kResolutions{"full", "half", "third", "fifth"};
constexpr std::array<int, 4> kEvery{1, 2, 3, 5}; // pixels, of kResolutions

// The option keeps no copy.
std::span<const std::string_view> allMethods()
{
	static const std::vector<std::string_view> methods = []
	{
		std::vector<std::string_view> all;
		for (const MethodRow& row : methodTable())
		{
			all.push_back(row.name);
		}
		all.push_back("bake");
		return all;
	}();
	return methods;
}

void chooseMethod(ShadeOptions& options, const MethodRow& row)
{
	options.aov.alone = row.kind == MethodKind::volumes;
	if (options.aov.alone)
	{
		options.aov.settings.mask = row.masks;
		options.settings.filter = ShadeFilter::none;
		return;
	}
	options.settings.method = row.method;
}

// Features of the methods that nook emits, then of those to compare with; filters are of all.
void addMethodOptions(CLI::App& app, ShadeOptions& options)
{
	const auto add = [&](bool emitted)
	{
		const auto fits = [emitted](const FeatureRow& row)
		{
			const auto takes = [&row](const MethodRow& method)
			{
				return method.emitted && takesFeature(method, row);
			};
			return row.features != 0 && std::any_of(methodTable().begin(), methodTable().end(), takes) == emitted;
		};
		const std::vector<FeatureOption> added = addFeatures(app, kInShade, fits, options.settings);
		options.features.insert(options.features.end(), added.begin(), added.end());
	};
	add(true);
	addPictureOptions(app, options.settings, options.picture);
	add(false);
	const auto quiet = [](const MethodRow& row)
	{
		return row.kind == MethodKind::screen && !hasNoise(row);
	};
	options.features.push_back(addFeature(app, featureOf("--filter"), options.settings,
										  ". Default here: bilateral, but for " + methodNames(quiet) + ", which has no noise"));
	options.filter = options.features.back().option;
}

// "vo-line: volumetric obscurance by lines; ..."
std::string whatMethodsAre()
{
	std::string text;
	for (const MethodRow& row : methodTable())
	{
		text += (text.empty() ? "" : "; ") + std::string(row.name) + ": " + std::string(row.what);
	}
	return text;
}

void addMethod(CLI::App& app, ShadeOptions& options)
{
	addChoiceText(
		app, "--method", allMethods(),
		[&options](std::size_t i)
		{
			options.still.alone = i == methodTable().size();
			if (!options.still.alone)
			{
				chooseMethod(options, methodTable()[i]);
			}
		},
		whatMethodsAre() + "; bake: of --bake")
		->required();
}

// The bake needs nothing else: it is read by rays on the CPU.
void checkBakeAlone(const ShadeOptions& options, const std::vector<const CLI::Option*>& others)
{
	for (const CLI::Option* const option : others)
	{
		if (option->count() > 0)
		{
			throw Error(ExitCode::usage, option->get_name() + ": found with --method bake, expected a screen-space method");
		}
	}
	if (options.gl || options.timing || options.resolution != 0)
	{
		throw Error(ExitCode::usage, std::string(options.gl       ? "--device"
												 : options.timing ? "--timing"
																  : "--resolution") +
										 ": found with --method bake, which draws no pass, expected none");
	}
	AovOptions without_volumes = options.aov;
	without_volumes.alone = false;
	checkAovOptions(without_volumes, options.gl, {});
}

// Bent normals are of the one method alone.
void checkBent(const ShadeOptions& options)
{
	if (!options.settings.slices.bent)
	{
		return;
	}
	const std::string other = !options.aov.path.empty()     ? "--volumes"
							  : !options.still.bake.empty() ? "--bake"
							  : options.settings.debug      ? "--debug"
															: "";
	if (!other.empty())
	{
		throw Error(ExitCode::usage, "--bent: found with " + other + ", which has none, expected one of them");
	}
}

// Options of one method or kind of methods.
void checkMethod(const ShadeOptions& options)
{
	std::vector<const CLI::Option*> others = options.of_screen;
	for (const FeatureOption& one : options.features)
	{
		others.push_back(one.option);
	}
	checkStill(options.still, !options.aov.path.empty(), !options.aov.alone && !options.still.alone);
	if (options.still.alone)
	{
		checkBakeAlone(options, others);
		return;
	}
	checkAovOptions(options.aov, options.gl, others);
	if (options.settings.debug && !options.still.bake.empty())
	{
		throw Error(ExitCode::usage, "--debug: found with --bake, of which views say nothing, expected one of them");
	}
	if (options.settings.debug && !options.aov.path.empty())
	{
		throw Error(ExitCode::usage, "--debug: found with --volumes, of which views say nothing, expected one of them");
	}
	if ((options.resolution == 1 && options.aov.alone) || (options.resolution > 1 && !options.aov.alone))
	{
		throw Error(ExitCode::usage, "--resolution: found " + std::string(kResolutions[options.resolution]) + " with --method " +
										 nameOfMethod(options) + ", expected " +
										 (options.aov.alone ? "full, third or fifth" : "full or half"));
	}
	if (options.aov.alone)
	{
		return;
	}
	if (options.settings.debug && (options.filter->count() > 0 || options.taps->count() > 0))
	{
		throw Error(ExitCode::usage, "--debug: found with " + std::string(options.filter->count() > 0 ? "--filter" : "--taps") +
										 ", but views are drawn before any filter, expected one of them");
	}
	checkShadeFeatures(options.features, options.settings);
	checkBent(options);
	checkPictureOptions(options.settings);
	checkDebug(options.settings);
	if (options.pattern_option->count() > 0 && !takesPattern(options.settings.method) && !mayTakeTile(options.settings.method))
	{
		throw Error(ExitCode::usage,
					"--pattern: found with --method " + nameOfMethod(options) + ", whose samples are its own, expected none");
	}
	if (options.pattern_option->count() > 0 && mayTakeTile(options.settings.method))
	{
		refuseSlicesBesideTile(options.features);
	}
	if (options.settings.statvo.builder == TableBuilder::compute && !options.gl)
	{
		throw Error(ExitCode::usage, "--tables-by: found compute with --device cpu, expected --device gl");
	}
}

} // namespace

bool isOfScreen(const ShadeOptions& options)
{
	return !options.aov.alone && !options.still.alone;
}

std::string nameOfMethod(const ShadeOptions& options)
{
	if (options.still.alone)
	{
		return "bake";
	}
	return std::string(options.aov.alone ? methodName(options.aov) : nameOf(options.settings.method));
}

std::string_view resolutionOf(const ShadeOptions& options)
{
	return kResolutions[options.resolution];
}

int everyPx(const ShadeOptions& options)
{
	return kEvery[options.resolution];
}

void declareShade(CLI::App& app, ShadeOptions& options)
{
	ShadeSettings& settings = options.settings;
	// Five taps halve the difference to 400 lines a pixel that nine lines have (builtin:courtyard, 960 x 540); with any pattern,
	// and at a lower error than the window or 13 taps.
	settings.filter = ShadeFilter::bilateral;
	addText(app, "FILE", options.gbuffer, "FILE.exr", "A G-buffer, of nook or of an engine")->required();
	addMethod(app, options);
	options.pattern_option = addText(
		app, "--pattern", options.pattern, "FILE",
		"The samples: a pattern or a tile of nook (default: 9 of nook's own, crytek 16 of Crytek's, reflected at random in 4 x 4 "
		"pixels). Lines and areas take the disk, points the ball, Alchemy and volumetric-ao the hemisphere, seen from above");
	addWhole(
		app, "--frame", [&options](int frame) { options.frame = frame; }, 0, 16777216,
		"With a tile of several frames: which of them, counted on from cycle to cycle (default 0)");
	addNumber(app, "--radius", settings.radius_m, 1e-6, 1e6, "Radius in metres (default 0.5)");
	options.recipe_option = addRecipe(app, options.recipe);
	addMethodOptions(app, options);
	for (const char* const name : {"--strength", "--power"})
	{
		options.features.push_back(addFeature(app, featureOf(name), settings));
	}
	addAovOptions(app, options.aov);
	addStillOptions(app, options.still);
	options.features.push_back(addFeature(app, featureOf("--taps"), settings));
	options.taps = options.features.back().option;
	addChoiceText(
		app, "--resolution", kResolutions, [&options](std::size_t i) { options.resolution = i; },
		"full (default), or half: every second pixel of both axes, the others from those of their surface; " +
			volumeMethods(" and ") + ": third or fifth");
	addChoiceText(
		app, "--device", kDevices, [&options](std::size_t i) { options.gl = i == 1; },
		"cpu (default), or gl: OpenGL 3.3 without a display");
	options.device_number = addWhole(app, "--gl-device", options.device, 0, 255,
									 "Of EGL's list, from 0 (default: the driver's choice, often a software renderer's)");
	addDebugOption(app, settings);
	app.add_flag(
		"--timing", options.timing,
		"Prints the renderer and the milliseconds of the picture and of each pass: medians of 9 drawings after one to warm "
		"up, by the GPU's timers, by the clock on a CPU");
	addGBufferImport(app, options.import);
	addOutputs(app, options.outputs, kShadeFormats);
	addThreads(app, options.threads);
	addProgress(app, options.outputs.progress);
	for (const char* const name : {"--pattern", "--frame", "--radius", "--recipe", "--max-pixels", "--min-pixels", "--debug"})
	{
		options.of_screen.push_back(app.get_option(name));
	}
}

void settle(ShadeOptions& options)
{
	options.settings.half_resolution = options.resolution == 1;
	if ((!hasNoise(rowOf(options.settings.method)) || options.settings.debug) && options.filter->count() == 0)
	{
		options.settings.filter = ShadeFilter::none;
	}
	if (isOfScreen(options))
	{
		options.reach_m = options.settings.radius_m;
		options.settings =
			withRecipe(options.settings, chosenRecipe(options.recipe, options.settings.method), options.reach_m, options.features);
	}
}

void check(const ShadeOptions& options)
{
	checkMethod(options);
	if (options.device_number->count() > 0 && !options.gl)
	{
		throw Error(ExitCode::usage, "--gl-device: found with --device cpu, expected --device gl");
	}
	if (options.gl && options.threads > 0)
	{
		throw Error(ExitCode::usage, "--threads: found with --device gl, expected --device cpu");
	}
	if (options.timing && options.outputs.progress == "-")
	{
		throw Error(ExitCode::usage, "--timing: found with --progress -, where it prints, expected --progress FILE");
	}
	checkGBufferImport(options.import);
	std::vector<std::string> inputs{options.gbuffer};
	if (!options.pattern.empty())
	{
		inputs.push_back(options.pattern);
	}
	if (isRecipeFile(options.recipe))
	{
		inputs.push_back(options.recipe.name);
	}
	for (const std::string& path : {options.aov.path, options.still.bake, options.still.still})
	{
		if (!path.empty())
		{
			inputs.push_back(path);
		}
	}
	checkOutputs(options.outputs, kShadeFormats, inputs);
}

} // namespace nook
