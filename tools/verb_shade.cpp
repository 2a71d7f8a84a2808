// SPDX-License-Identifier: GPL-3.0-or-later
// nook shade: a G-buffer → visibility by a screen-space method, by occlusion volumes or by both, on the CPU or through OpenGL.
#include "aov_options.h"
#include "debug_options.h"
#include "feature_options.h"
#include "gbuffer_options.h"
#include "options.h"
#include "picture_options.h"
#include "recipe_options.h"
#include "shade_samples.h"
#include "still_options.h"
#include "summary.h"
#include "volume_methods.h"

#include "core/error.h"
#include "core/image.h"
#include "core/number.h"
#include "format/pattern_file.h"
#include "scene/reference_file.h"
#include "shade/shade.h"
#include "version.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 2> kShadeFormats{".exr", ".png"};
constexpr std::array<std::string_view, 2> kDevices{"cpu", "gl"};
constexpr int kRepetitions = 9; // drawings for --timing
constexpr std::array<std::string_view, 4> kResolutions{"full", "half", "third", "fifth"};
constexpr std::array<int, 4> kEvery{1, 2, 3, 5}; // pixels, of kResolutions

// Five taps halve the difference to 400 lines a pixel that nine lines have (builtin:courtyard, 960 x 540); with any pattern, and at
// a lower error than the window or 13 taps.
ShadeSettings filteredSettings()
{
	ShadeSettings settings;
	settings.filter = ShadeFilter::bilateral;
	return settings;
}

struct ShadeOptions
{
	std::string gbuffer;
	GBufferImport import;
	ShadeSettings settings = filteredSettings();
	std::string pattern; // a pattern or a tile; empty: 9 samples of our own
	bool gl = false;
	std::vector<FeatureOption> features;
	std::optional<int> frame;
	RecipeOption recipe;
	double reach_m = 0.0; // --radius
	CLI::Option* recipe_option = nullptr;
	PictureOptions picture;
	AovOptions aov;
	StillOptions still;
	std::size_t resolution = 0; // of kResolutions
	CLI::Option* pattern_option = nullptr;
	std::vector<const CLI::Option*> of_screen; // of no method of volumes
	CLI::Option* filter = nullptr;
	CLI::Option* taps = nullptr;
	CLI::Option* device_number = nullptr;
	int device = 0;
	bool timing = false;
	Outputs outputs;
	int threads = 0;
};

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

void declare(CLI::App& app, ShadeOptions& options)
{
	ShadeSettings& settings = options.settings;
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

double meanOf(const std::vector<float>& values)
{
	double sum = 0.0;
	for (const float value : values)
	{
		sum += static_cast<double>(value);
	}
	return sum / static_cast<double>(values.size());
}

std::string filterText(const ShadeSettings& settings)
{
	const std::string name = valueText(featureOf("--filter"), settings);
	return settings.filter == ShadeFilter::bilateral ? name + " " + std::to_string(settings.filter_taps) : name;
}

// What was drawn, and of what.
struct Drawn
{
	Shaded shaded;
	ShadeSamples samples; // of a screen-space method
	AovFacts volumes;     // where there are some
	Still still;          // what is known of what does not move
};

void addSeconds(Shaded& shaded, const Shaded& more)
{
	shaded.seconds += more.seconds;
	shaded.passes.insert(shaded.passes.end(), more.passes.begin(), more.passes.end());
}

// Screen space over volumes and bake; once more without what moves, where that is known.
void drawTogether(const ShadeOptions& options, const std::vector<float>& known, const RunSettings& run, const DrawSettings& drawing,
				  Drawn& drawn)
{
	std::vector<float> without;
	if (drawn.still.gbuffer)
	{
		const Shaded still = options.gl ? shadeOnGl(*drawn.still.gbuffer, drawn.samples, options.settings, drawing)
										: shadeOnCpu(*drawn.still.gbuffer, drawn.samples, options.settings, run, drawing);
		addSeconds(drawn.shaded, still);
		without = still.visibility;
	}
	drawn.shaded.visibility = overStill(drawn.still, known, drawn.shaded.visibility, without);
}

void drawScreen(const ShadeOptions& options, const GBuffer& gbuffer, const RunSettings& run, const DrawSettings& drawing,
				Drawn& drawn)
{
	drawn.samples = shadeSamples(options.pattern, options.frame, options.settings, run);
	if (options.settings.filter == ShadeFilter::window && drawn.samples.size == 1)
	{
		const bool given = !options.pattern.empty();
		throw Error(ExitCode::usage,
					"--filter: found 'window' with " + (given ? options.pattern : "--method " + nameOfMethod(options)) +
						", whose samples have no window, expected " + (given ? "--pattern with a tile" : "another filter"));
	}
	checkDebug(options.settings, drawn.samples);
	drawn.shaded = options.gl ? shadeOnGl(gbuffer, drawn.samples, options.settings, drawing)
							  : shadeOnCpu(gbuffer, drawn.samples, options.settings, run, drawing);
}

Drawn draw(const ShadeOptions& options, const GBuffer& gbuffer, const RunSettings& run)
{
	DrawSettings drawing;
	drawing.repetitions = options.timing ? kRepetitions : 0;
	if (options.device_number->count() > 0)
	{
		drawing.gl_device = options.device;
	}
	// Telling of rows would be seen in the times that are taken of them, and OpenGL has none.
	const bool whole = options.gl || options.timing;
	const ProgressCounter stage(run.progress, options.gl ? "OpenGL" : "drawings", whole ? 1 : 0);
	const RunSettings told = whole ? silent(run) : run;
	Drawn drawn;
	const bool has_volumes = !options.aov.path.empty();
	const bool alone = options.aov.alone || options.still.alone;
	drawn.still = readStill(options.still, has_volumes, options.aov.settings.mask, gbuffer, told);
	if (!alone)
	{
		drawScreen(options, gbuffer, told, drawing, drawn);
	}
	Shaded volumes;
	if (has_volumes)
	{
		AovOptions of_volumes = options.aov;
		of_volumes.settings.every_px = options.aov.alone ? kEvery[options.resolution] : 1;
		volumes = drawVolumes(of_volumes, options.gl, gbuffer, told, drawing, drawn.volumes);
	}
	std::vector<float> known = visibilityOfStill(drawn.still, volumes.visibility, gbuffer.depth.size());
	if (alone)
	{
		drawn.shaded = has_volumes ? volumes : Shaded{};
		drawn.shaded.renderer = has_volumes ? volumes.renderer : "CPU";
		drawn.shaded.visibility = std::move(known);
	}
	else if (has_volumes || drawn.still.baked)
	{
		addSeconds(drawn.shaded, volumes);
		drawTogether(options, known, told, drawing, drawn);
	}
	return drawn;
}

Notes notesOf(const ShadeOptions& options, const Drawn& drawn)
{
	Notes notes{{"Software", "nook " NOOK_VERSION}, {"nook:method", nameOfMethod(options)}};
	if (isOfScreen(options))
	{
		const MethodRow& row = rowOf(options.settings.method);
		notes.push_back({"nook:recipe", options.recipe.name});
		notes.push_back({"nook:radius_m", numberText(options.reach_m)});
		notes.push_back({row.layers_text != nullptr ? "nook:layers" : "nook:samples",
						 row.layers_text != nullptr ? row.layers_text(options.settings) : std::to_string(drawn.samples.count)});
		notes.push_back({"nook:filter", filterText(options.settings)});
	}
	notes.push_back({"nook:shows", std::string(debugName(options.settings))});
	notes.push_back({"nook:resolution", std::string(kResolutions[options.resolution])});
	if (!options.still.bake.empty())
	{
		notes.push_back({"nook:baked_pixels", std::to_string(drawn.still.baked_pixels)});
	}
	if (!options.aov.path.empty())
	{
		addAovNotes(notes, options.aov, drawn.volumes);
	}
	return notes;
}

void addScreenFacts(Summary& summary, const ShadeOptions& options, const GBuffer& gbuffer, const Drawn& drawn)
{
	summary.text("recipe", options.recipe.name);
	summary.number("radius_m", options.reach_m);
	const LimitedRadii limited = limitedRadii(gbuffer, options.settings);
	summary.whole("radius_limited_near", limited.near);
	summary.whole("radius_limited_far", limited.far);
	if (const MethodRow& row = rowOf(options.settings.method); row.layers_text != nullptr)
	{
		summary.text("layers", row.layers_text(options.settings));
		summary.text("tables_by", drawn.shaded.tables_by);
	}
	else
	{
		summary.whole("samples", static_cast<std::size_t>(drawn.samples.count));
	}
}

void addTimes(Summary& summary, const Shaded& shaded)
{
	summary.number("milliseconds", 1e3 * shaded.seconds);
	std::vector<Summary> passes(shaded.passes.size());
	for (std::size_t i = 0; i < passes.size(); ++i)
	{
		passes[i].text("pass", shaded.passes[i].name);
		passes[i].number("milliseconds", 1e3 * shaded.passes[i].seconds);
	}
	summary.items("passes", passes);
}

Summary summaryOf(const ShadeOptions& options, const GBuffer& gbuffer, const Drawn& drawn, const Picture& picture)
{
	Summary summary("shade");
	summary.text("method", nameOfMethod(options));
	summary.text("renderer", drawn.shaded.renderer);
	if (isOfScreen(options))
	{
		addScreenFacts(summary, options, gbuffer, drawn);
	}
	if (options.settings.debug)
	{
		summary.text("debug", debugName(options.settings));
		summary.number("mean", meanOf(picture.values));
	}
	if (!options.aov.path.empty())
	{
		addAovFacts(summary, options.aov, drawn.volumes, options.gl);
	}
	addStillFacts(summary, options.still, drawn.still);
	if (isOfScreen(options))
	{
		summary.text("filter", filterText(options.settings));
	}
	summary.text("resolution", kResolutions[options.resolution]);
	if (isOfScreen(options))
	{
		summary.whole("window", static_cast<std::size_t>(drawn.samples.size));
	}
	if (options.timing)
	{
		addTimes(summary, drawn.shaded);
	}
	return summary;
}

std::string bentBytes(bool png, const Picture& picture, const std::vector<glm::vec3>& bent, const Notes& notes)
{
	return png ? bentPng(picture.width_px, picture.height_px, bent, notes)
			   : bentExr(picture.width_px, picture.height_px, bent, picture.values, notes);
}

std::string imageBytes(bool png, const Picture& picture, const std::string& channel, const Notes& notes)
{
	return png ? visibilityPng(picture.width_px, picture.height_px, picture.values, notes)
			   : exrBytes({picture.width_px, picture.height_px, {channel}, picture.values, notes, {}});
}

void run(const ShadeOptions& options, VerbProgress& progress)
{
	check(options);
	const RunSettings settings = progress.start("shade", options.threads, options.outputs.progress);
	const GBuffer gbuffer = readGBuffer(options.gbuffer, options.import);
	const Drawn drawn = draw(options, gbuffer, settings);
	const Picture picture = withoutGuard(options.gbuffer, gbuffer, drawn.shaded.visibility, options.picture);
	const Notes notes = notesOf(options, drawn);
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		const bool png = formatOf(path, kShadeFormats) == ".png";
		files.add(path, options.settings.slices.bent
							? bentBytes(png, picture, withoutGuard(gbuffer, drawn.shaded.bent, options.picture), notes)
							: imageBytes(png, picture, std::string(debugName(options.settings)), notes));
	}
	std::vector<std::string> read{options.gbuffer};
	for (const std::string& path :
		 {options.pattern, isRecipeFile(options.recipe) ? options.recipe.name : std::string(), options.aov.path})
	{
		if (!path.empty())
		{
			read.push_back(path);
		}
	}
	read.insert(read.end(), drawn.still.files.begin(), drawn.still.files.end());
	addSide(files, options.outputs, summaryOf(options, gbuffer, drawn, picture).json(), read);
	files.commit();
	if (options.timing && options.outputs.json != "-")
	{
		std::string text = drawn.shaded.renderer + ": " + numberText(1e3 * drawn.shaded.seconds) + " ms\n";
		for (const PassTime& pass : drawn.shaded.passes)
		{
			text += "  " + pass.name + ": " + numberText(1e3 * pass.seconds) + " ms\n";
		}
		writeFile("-", text);
	}
}

} // namespace

Verb addShadeVerb(CLI::App& nook)
{
	const auto options = std::make_shared<ShadeOptions>();
	CLI::App* const app =
		nook.add_subcommand("shade", "Visibility by a screen-space method, by volumes or by a bake, on the CPU or through OpenGL");
	declare(*app, *options);
	return {app, [options](VerbProgress& progress)
			{
				options->settings.half_resolution = options->resolution == 1;
				if ((!hasNoise(rowOf(options->settings.method)) || options->settings.debug) && options->filter->count() == 0)
				{
					options->settings.filter = ShadeFilter::none;
				}
				if (isOfScreen(*options))
				{
					options->reach_m = options->settings.radius_m;
					options->settings = withRecipe(options->settings, chosenRecipe(options->recipe, options->settings.method),
												   options->reach_m, options->features);
				}
				run(*options, progress);
			}};
}

} // namespace nook
