// SPDX-License-Identifier: GPL-3.0-or-later
// nook shade: a G-buffer → visibility by a screen-space method, by occlusion volumes or by both, on the CPU or through OpenGL.
#include "call.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/image.h"
#include "core/lists.h"
#include "emit/module.h"
#include "format/pattern_file.h"
#include "scene/reference.h"
#include "shade/compose.h"
#include "version.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 3> kShadeFormats{".exr", ".png", ".json"};
constexpr std::array<std::string_view, 2> kDevices{"cpu", "gl"};
constexpr std::array<std::string_view, 4> kResolutions{"full", "half", "third", "fifth"};
constexpr std::array<int, 4> kEvery{1, 2, 3, 5};                          // pixels, of kResolutions
constexpr std::array<std::string_view, 3> kTargets{"r16f", "r8", "r32f"}; // of AovTarget, in its order
constexpr std::array<std::string_view, 2> kFaces{"chosen", "front"};
constexpr int kRepetitions = 9; // drawings for --timing

struct ShadeOptions
{
	const CLI::App* app = nullptr;
	std::string gbuffer;
	GBufferImport import;
	std::size_t method = 0; // of the table; behind its end: of kindsBesideMethods()
	ComposeSettings compose;
	std::string recipe = "rays"; // paper, rays or a file
	double radius_m = 0.5;
	int guard_px = 0;           // on each side
	std::size_t resolution = 0; // of kResolutions
	bool timing = false;
	Outputs outputs;
};

// The kind of asset that is drawn by itself; null: a row of the table.
const AssetKind* kindAlone(const ShadeOptions& options)
{
	const std::size_t rows = methodTable().size();
	return options.method < rows ? nullptr : kindsBesideMethods()[options.method - rows];
}

std::string nameOfMethod(const ShadeOptions& options)
{
	const AssetKind* const kind = kindAlone(options);
	return std::string(kind != nullptr ? kind->name : methodTable()[options.method].name);
}

// The option keeps no copy.
std::span<const std::string_view> allMethods()
{
	static const std::vector<std::string_view> methods = []
	{
		std::vector<std::string_view> all = mapped(methodTable(), [](const MethodRow& row) { return row.name; });
		for (const AssetKind* const kind : kindsBesideMethods())
		{
			all.push_back(kind->name);
		}
		return all;
	}();
	return methods;
}

// "vo-line: volumetric obscurance by lines; ...; bake: of --bake"
std::string whatMethodsAre()
{
	return joinedText(methodTable(), "; ",
					  [](const MethodRow& row) { return std::string(row.name) + ": " + std::string(row.what); }) +
		   joinedText(kindsBesideMethods(), "",
					  [](const AssetKind* kind) { return "; " + std::string(kind->name) + ": of " + std::string(kind->option); });
}

// "--method bake": the kinds of assets that are drawn by themselves.
std::string methodsAlone()
{
	return "--method " + joinedText(kindsBesideMethods(), "|", [](const AssetKind* kind) { return kind->name; });
}

// Rules of options that screen-space methods alone have.
OptionRules ofScreen()
{
	return {.excludes = {{"--method " + volumeMethods("|"), "a screen-space method"}, {methodsAlone(), "a screen-space method"}}};
}

// Features of the methods that nook emits, or of those to compare with.
std::vector<OptionRow> methodFeatures(bool emitted, ShadeSettings& settings)
{
	const auto fits = [emitted](const FeatureRow& row)
	{
		const auto takes = [&row](const MethodRow& method)
		{
			return method.emitted && takesFeature(method, row);
		};
		return !isForAll(row) && std::any_of(methodTable().begin(), methodTable().end(), takes) == emitted;
	};
	return featureOptions(kInShade, fits, settings, ofScreen());
}

std::vector<OptionRow> volumeRows(ComposeSettings& compose)
{
	const OptionRule volumes{"--volumes", "--volumes", "with no volumes"};
	const OptionRule gl{"--device gl", "--device gl", "with --device cpu"};
	const OptionRule sums{"--method " + maskMethod(), "--method " + sumMethod(),
						  "with --method " + maskMethod() + ", which adds nothing up"};
	return {
		{"--volumes", takesText(compose.volumes, "FILE.glb"),
		 "Occlusion volumes of the level that the G-buffer shows (nook volumes): " + volumeMethods(" and ") +
			 " draw them alone; with another method each pixel takes the lesser visibility of the two",
		 excludes(methodsAlone(), "--method " + volumeMethods(" or "))},
		directionsRow(compose.aov.directions, needs("--method " + maskMethod(), maskMethod(), "with another method")),
		{"--accumulate",
		 takesChoice(kTargets, compose.aov.target),
		 "Volumes, --device gl: what occlusion is added up in: r16f (default), r8, which saturates, or r32f",
		 {.excludes = {sums}, .needs = {volumes, gl}}},
		{"--no-compensation",
		 takesFlag(compose.aov.compensate, false),
		 "Volumes, but for " + maskMethod() + ": the plain sum of occlusion, without the curve for what is counted twice",
		 {.excludes = {sums}, .needs = {volumes}}},
		{"--draw-all",
		 takesFlag(compose.aov.cull, false),
		 "Volumes, --device gl: clusters that are out of sight, too",
		 {.needs = {volumes, gl}}},
		{"--faces",
		 takesIndex(kFaces, [&compose](std::size_t i) { compose.aov.choose_faces = i == 0; }),
		 "Volumes, --device gl: which faces of each are drawn: chosen (default), those that cover fewer pixels, where the file has "
		 "exact bounds; front, but for clusters that hold the eye; the picture is the same",
		 {.needs = {volumes, gl}}},
		{"--bake", takesText(compose.bake, "FILE.glb"),
		 "Values at the vertices of the level that the G-buffer shows (nook bake): --method bake draws them alone, " +
			 volumeMethods(" and ") +
			 " add those that were made beside their volumes; with another method only what moves darkens them"},
		{"--static",
		 takesText(compose.fixed, "FILE.exr"),
		 "With --volumes and a screen-space method: a G-buffer of the same camera without what moves (with --bake it is known)",
		 {.excludes = {{"--bake", "one of them", "with --bake, which says it"},
					   {"--method " + volumeMethods("|"), "both", "without a screen-space method"}},
		  .needs = {{"--volumes"}}}}};
}

OptionRow debugRow(ShadeSettings& settings)
{
	OptionRules rules = ofScreen();
	const std::string nothing = ", of which views say nothing";
	rules.excludes.push_back({"--bake", "one of them", "with --bake" + nothing});
	rules.excludes.push_back({"--volumes", "one of them", "with --volumes" + nothing});
	rules.excludes.push_back({"--filter or --taps", "one of them, since views are drawn before any filter"});
	return {
		"--debug", takesChoice(namesOf<DebugView>(), settings.debug),
		"Draws what happens instead of visibility, before any filter, 0 to 1: edges, where a filter finds another surface beside "
		"a pixel; lod, the mean level of coarser depths that samples read, of all; layers, those that StatVO looks at, of all; "
		"samples, those taken, of all; noise, the standard deviation over all variants of the window",
		rules};
}

void declare(CLI::App& app, ShadeOptions& options)
{
	ComposeSettings& compose = options.compose;
	ShadeSettings& settings = compose.shade;
	// Five taps halve the difference to 400 lines per pixel that nine lines have (builtin:courtyard, 960 x 540); with any pattern,
	// and at a lower error than the window or 13 taps.
	settings.filter = ShadeFilter::bilateral;
	const auto feature = [&settings](const char* name, const std::string& more = "")
	{
		return featureOption(featureOf(name), settings, more, ofScreen());
	};
	const auto quiet = [](const MethodRow& row)
	{
		return row.kind == MethodKind::screen && !hasNoise(row);
	};
	addOptions(
		app,
		{{"FILE", takesText(options.gbuffer, "FILE.exr"), "A G-buffer, of nook or of an engine", kRequired},
		 {"--method", takesChoice(allMethods(), options.method), whatMethodsAre(), kRequired},
		 {"--pattern", takesText(compose.pattern, "FILE"),
		  "The samples: a pattern or a tile of nook (default: 9 of nook's own, crytek 16 of Crytek's, reflected at random in 4 x 4 "
		  "pixels). Lines and areas take the disk, points the ball, Alchemy and volumetric-ao the hemisphere, seen from above",
		  ofScreen()},
		 {"--frame", takesWhole(compose.frame, 0, 16777216),
		  "With a tile of several frames: which of them, counted on from cycle to cycle (default 0)", ofScreen()},
		 {"--radius", takesNumber(options.radius_m, 1e-6, 1e6), "Radius in metres (default 0.5)", ofScreen()},
		 recipeRow(options.recipe, ofScreen())});
	addOptions(app, methodFeatures(true, settings));
	addOptions(
		app,
		{{"--guard", takesWhole(options.guard_px, 0, 4096),
		  "Pixels on each side of FILE that are neighbours but no part of the picture: the output is smaller by them (default 0)"},
		 {"--max-pixels", takesNumber(settings.max_radius_px, 1.0, 65536.0),
		  "The greatest radius in the picture, near the camera (default: its height); the summary counts the pixels it changes",
		  ofScreen()},
		 {"--min-pixels", takesNumber(settings.min_radius_px, 0.0, 65536.0),
		  "The least radius in the picture, far away (default 0)", ofScreen()}});
	addOptions(app, methodFeatures(false, settings));
	addOptions(app, {feature("--filter", ". Default here: bilateral, but for " + methodNames(quiet) + ", which has no noise"),
					 feature("--strength"), feature("--power")});
	addOptions(app, volumeRows(compose));
	addOptions(app, {feature("--taps"),
					 {"--resolution", takesChoice(kResolutions, options.resolution),
					  "full (default), or half: every second pixel of both axes, the others from those of their surface; " +
						  volumeMethods(" and ") + ": third or fifth"},
					 {"--device", takesChoice(kDevices, compose.gl), "cpu (default), or gl: OpenGL 3.3 without a display"},
					 glDeviceRow(compose.drawing.gl_device, needs("--device gl", "--device gl", "with --device cpu")),
					 debugRow(settings),
					 {"--timing", takesFlag(options.timing),
					  "Prints the renderer and the milliseconds of the picture and of each pass: medians of 9 drawings after a "
					  "warm-up, by the GPU's timers, by the clock on a CPU",
					  excludes("--progress -", "--progress FILE", "with --progress -, where it prints")}});
	addGBufferImport(app, options.import);
	addOutputs(app, options.outputs, kShadeFormats);
	addRun(app, options.outputs);
	options.app = &app;
}

// An asset that is drawn by itself needs nothing but its file.
void checkAlone(const ShadeOptions& options, const AssetKind& kind)
{
	const ComposeSettings& compose = options.compose;
	const std::string method = "--method " + std::string(kind.name);
	refuseIf(compose.bake.empty(), std::string(kind.option) + ": found none with " + method + ", expected a file of nook bake");
	const std::string other = compose.gl ? "--device" : options.timing ? "--timing" : "--resolution";
	refuseIf(compose.gl || options.timing || options.resolution != 0,
			 other + ": found with " + method + ", which draws no pass, expected none");
}

void checkResolution(const ShadeOptions& options)
{
	const bool screen = options.compose.screen;
	refuseIf(screen ? options.resolution > 1 : options.resolution == 1,
			 "--resolution: found " + std::string(kResolutions[options.resolution]) + " with --method " + nameOfMethod(options) +
				 ", expected " + (screen ? "full or half" : "full, third or fifth"));
}

// Refuses options that do not go with the screen-space method.
void checkScreen(const ShadeOptions& options)
{
	const ComposeSettings& compose = options.compose;
	const ShadeSettings& settings = compose.shade;
	const GivenFeatures given = givenFeatures(*options.app, kInShade);
	checkShadeFeatures(given, settings);
	const std::string with = !compose.volumes.empty() ? "--volumes" : !compose.bake.empty() ? "--bake" : "--debug";
	refuseIf(settings.slices.bent && (!compose.volumes.empty() || !compose.bake.empty() || settings.debug),
			 "--bent: found with " + with + ", which has none, expected one of them");
	refuseValueIf(settings.max_radius_px > 0.0 && settings.min_radius_px > settings.max_radius_px, "--min-pixels",
				  numberText(settings.min_radius_px), "at most --max-pixels");
	checkDebug(settings);
	refuseIf(!compose.pattern.empty() && !takesPattern(settings.method) && !mayTakeTile(settings.method),
			 "--pattern: found with --method " + nameOfMethod(options) + ", whose samples are its own, expected none");
	if (!compose.pattern.empty() && mayTakeTile(settings.method))
	{
		refuseSlicesWithTile(given);
	}
	refuseIf(settings.statvo.builder == TableBuilder::compute && !compose.gl,
			 "--tables-by: found compute with --device cpu, expected --device gl");
}

// The recipe, the filter that goes with the method, how often volumes are drawn.
void settle(ShadeOptions& options)
{
	ComposeSettings& compose = options.compose;
	ShadeSettings& settings = compose.shade;
	const AssetKind* const kind = kindAlone(options);
	const MethodRow* const row = kind != nullptr ? nullptr : &methodTable()[options.method];
	compose.screen = row != nullptr && row->kind == MethodKind::screen;
	compose.drawing.repetitions = options.timing ? kRepetitions : 0;
	if (!compose.screen)
	{
		compose.aov.mask = row != nullptr && row->masks;
		compose.aov.every_px = row != nullptr ? kEvery[options.resolution] : 1;
		return;
	}
	settings.method = row->method;
	settings.half_resolution = options.resolution == 1;
	if ((!hasNoise(*row) || settings.debug) && !isGiven(*options.app, "--filter"))
	{
		settings.filter = ShadeFilter::none;
	}
	settings.radius_m = options.radius_m;
	settings = withRecipe(settings, chosenRecipe(options.recipe, settings.method), options.radius_m,
						  givenFeatures(*options.app, kInShade));
}

// Files that options name, but for those of what does not move.
std::vector<std::string> filesOf(const ShadeOptions& options)
{
	return {options.gbuffer, options.compose.pattern, isRecipeFile(options.recipe) ? options.recipe : "", options.compose.volumes};
}

// Throws Error (usage) where options contradict each other.
void check(const ShadeOptions& options)
{
	const ComposeSettings& compose = options.compose;
	if (const AssetKind* const kind = kindAlone(options); kind != nullptr)
	{
		checkAlone(options, *kind);
	}
	else if (!compose.screen && compose.volumes.empty())
	{
		refuse("--volumes: found none with --method " + nameOfMethod(options) + ", expected a file of nook volumes");
	}
	checkResolution(options);
	if (compose.screen)
	{
		checkScreen(options);
	}
	refuseIf(compose.gl && options.outputs.threads > 0, "--threads: found with --device gl, expected --device cpu");
	checkGBufferImport(options.import);
	std::vector<std::string> inputs = filesOf(options);
	inputs.insert(inputs.end(), {compose.bake, compose.fixed});
	checkOutputs(options.outputs, kShadeFormats, inputs);
	const bool alone = compose.screen && compose.volumes.empty() && compose.bake.empty() && !compose.shade.debug;
	for (const std::string& path : options.outputs.files)
	{
		refuseIf(!alone && formatOf(path, kShadeFormats) == ".json",
				 path + ": found with volumes, a bake or --debug, expected a screen-space method alone, whose passes it lists");
	}
}

std::string filterText(const ShadeSettings& settings)
{
	const std::string name = valueText(featureOf("--filter"), settings);
	return settings.filter == ShadeFilter::bilateral ? name + " " + std::to_string(settings.filter_taps) : name;
}

Composed draw(const ShadeOptions& options, const GBuffer& gbuffer, const RunSettings& run)
{
	// Reporting rows would show in the times that are taken of them, and OpenGL has none.
	const bool whole = options.compose.gl || options.timing;
	const ProgressCounter stage(run.progress, options.compose.gl ? "OpenGL" : "drawings", whole ? 1 : 0);
	return compose(options.compose, gbuffer, whole ? silent(run) : run);
}

Notes notesOf(const ShadeOptions& options, const Composed& drawn)
{
	const ComposeSettings& compose = options.compose;
	Notes notes{{"Software", "nook " NOOK_VERSION}, {"nook:method", nameOfMethod(options)}};
	if (compose.screen)
	{
		const MethodRow& row = rowOf(compose.shade.method);
		notes.push_back({"nook:recipe", options.recipe});
		notes.push_back({"nook:radius_m", numberText(options.radius_m)});
		notes.push_back({row.layers_text != nullptr ? "nook:layers" : "nook:samples",
						 row.layers_text != nullptr ? row.layers_text(compose.shade) : std::to_string(drawn.samples.count)});
		notes.push_back({"nook:filter", filterText(compose.shade)});
	}
	notes.push_back({"nook:shows", std::string(debugName(compose.shade))});
	notes.push_back({"nook:resolution", std::string(kResolutions[options.resolution])});
	if (drawn.baked_pixels)
	{
		notes.push_back({"nook:baked_pixels", std::to_string(*drawn.baked_pixels)});
	}
	if (!compose.volumes.empty())
	{
		notes.push_back({"nook:volumes", std::to_string(drawn.volumes.volumes)});
		notes.push_back({"nook:distance_m", numberText(drawn.distance_m)});
		notes.push_back(compose.aov.mask ? Note{"nook:directions", std::to_string(compose.aov.directions)}
										 : Note{"nook:compensation", compose.aov.compensate ? "curve" : "none"});
	}
	return notes;
}

void addScreenFacts(Facts& facts, const ShadeOptions& options, const GBuffer& gbuffer, const Composed& drawn)
{
	const ShadeSettings& settings = options.compose.shade;
	facts.text("recipe", options.recipe);
	facts.number("radius_m", options.radius_m);
	const LimitedRadii limited = limitedRadii(gbuffer, settings);
	facts.whole("radius_limited_near", limited.near);
	facts.whole("radius_limited_far", limited.far);
	if (const MethodRow& row = rowOf(settings.method); row.layers_text != nullptr)
	{
		facts.text("layers", row.layers_text(settings));
		facts.text("tables_by", drawn.shaded.tables_by);
	}
	else
	{
		facts.whole("samples", drawn.samples.count);
	}
}

void addVolumeFacts(Facts& facts, const ComposeSettings& compose, const Composed& drawn)
{
	facts.number("distance_m", drawn.distance_m);
	// A mask's falloff is that of the reference at the volumes' own reach.
	facts.number("ray_distance_m", compose.aov.mask ? drawn.distance_m : drawn.ray_distance_m);
	facts.whole("volumes", drawn.volumes.volumes);
	facts.whole("fragments", drawn.volumes.fragments);
	facts.when(compose.aov.every_px > 1).whole("pixels_alone", drawn.volumes.pixels_alone);
	if (compose.gl)
	{
		facts.whole("clusters_drawn", drawn.volumes.clusters_drawn);
		facts.whole("volumes_drawn", drawn.volumes.volumes_drawn);
	}
	if (compose.aov.mask)
	{
		facts.whole("directions", compose.aov.directions);
		return;
	}
	facts.text("compensation", compose.aov.compensate ? "curve" : "none");
	facts.when(compose.gl).text("accumulate", kTargets[static_cast<std::size_t>(compose.aov.target)]);
}

void addTimes(Facts& facts, const Shaded& shaded)
{
	facts.number("milliseconds", 1e3 * shaded.seconds);
	facts.line(shaded.renderer + ": " + numberText(1e3 * shaded.seconds) + " ms");
	std::vector<Facts> passes;
	for (const PassTime& pass : shaded.passes)
	{
		facts.line("  " + pass.name + ": " + numberText(1e3 * pass.seconds) + " ms");
		Facts& item = passes.emplace_back();
		item.text("pass", pass.name);
		item.number("milliseconds", 1e3 * pass.seconds);
	}
	facts.items("passes", std::move(passes));
}

Facts factsOf(const ShadeOptions& options, const GBuffer& gbuffer, const Composed& drawn, const Picture& picture)
{
	const ComposeSettings& compose = options.compose;
	Facts facts = verbFacts("shade");
	facts.text("method", nameOfMethod(options));
	facts.text("renderer", drawn.shaded.renderer);
	if (compose.screen)
	{
		addScreenFacts(facts, options, gbuffer, drawn);
	}
	if (compose.shade.debug)
	{
		facts.text("debug", debugName(compose.shade));
		facts.number("mean", meanOf(picture.values));
	}
	if (!compose.volumes.empty())
	{
		addVolumeFacts(facts, compose, drawn);
	}
	facts.when(drawn.baked_pixels.has_value()).whole("baked_pixels", drawn.baked_pixels.value_or(0));
	facts.when(drawn.moving_pixels.has_value()).whole("moving_pixels", drawn.moving_pixels.value_or(0));
	facts.when(compose.screen).text("filter", filterText(compose.shade));
	facts.text("resolution", kResolutions[options.resolution]);
	facts.when(compose.screen).whole("window", drawn.samples.size);
	if (options.timing)
	{
		addTimes(facts, drawn.shaded);
	}
	return facts;
}

std::string imageBytes(bool png, const Picture& picture, const std::vector<glm::vec3>& bent, const std::string& channel,
					   const Notes& notes)
{
	if (!bent.empty())
	{
		return png ? bentPng(picture.width_px, picture.height_px, bent, notes)
				   : bentExr(picture.width_px, picture.height_px, bent, picture.values, notes);
	}
	return png ? visibilityPng(picture.width_px, picture.height_px, picture.values, notes)
			   : exrBytes({picture.width_px, picture.height_px, {channel}, picture.values, notes, {}});
}

void run(ShadeOptions& options, VerbProgress& progress)
{
	settle(options);
	check(options);
	const RunSettings settings = progress.start("shade", options.outputs.threads, options.outputs.progress);
	const GBuffer gbuffer = gbufferOf(options.gbuffer, options.import);
	const Composed drawn = draw(options, gbuffer, settings);
	const Picture picture = withoutGuard(options.gbuffer, gbuffer, drawn.shaded.visibility, options.guard_px);
	const std::vector<glm::vec3> bent =
		options.compose.shade.slices.bent ? withoutGuard(gbuffer, drawn.shaded.bent, options.guard_px) : std::vector<glm::vec3>{};
	const std::vector<std::size_t> size{static_cast<std::size_t>(picture.height_px), static_cast<std::size_t>(picture.width_px)};
	give<float>("visibility", picture.values, size);
	give<float>("bent", bent, {size[0], size[1], 3});
	const Notes notes = notesOf(options, drawn);
	const auto bytesOf = [&](const std::string& path)
	{
		const std::string_view format = formatOf(path, kShadeFormats);
		const ShadeSettings& shade = options.compose.shade;
		return format == ".json" ? passesJson(frameOf(gbuffer), drawn.samples, shade, NOOK_VERSION)
								 : imageBytes(format == ".png", picture, bent, std::string(debugName(shade)), notes);
	};
	std::vector<std::string> read = filesOf(options);
	append(read, drawn.files);
	const Facts facts = factsOf(options, gbuffer, drawn, picture);
	writeOutputs(options.outputs, bytesOf, facts.json(), read);
	if (options.timing && options.outputs.json != "-")
	{
		writeFile("-", facts.lines());
	}
}

} // namespace

Verb addShadeVerb(CLI::App& nook)
{
	return addVerb<ShadeOptions>(
		nook, "shade", "Visibility by a screen-space method, by volumes or by a bake, on the CPU or through OpenGL", declare, run);
}

} // namespace nook
