// SPDX-License-Identifier: GPL-3.0-or-later
// nook shade: a G-buffer → visibility by a screen-space method, on the CPU or through OpenGL.
#include "debug_options.h"
#include "gbuffer_options.h"
#include "method_options.h"
#include "options.h"
#include "picture_options.h"
#include "rival_options.h"
#include "statvo_options.h"
#include "summary.h"

#include "core/error.h"
#include "core/image.h"
#include "core/number.h"
#include "emit/emit.h"
#include "emit/input.h"
#include "pattern/generate.h"
#include "pattern/tile.h"
#include "scene/reference_file.h"
#include "shade/shade.h"
#include "version.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 2> kFormats{".exr", ".png"};
constexpr std::array<std::string_view, 2> kDevices{"cpu", "gl"};
constexpr int kRepetitions = 9; // drawings for --timing
constexpr std::array<std::string_view, 3> kFilters{"none", "bilateral", "window"};
constexpr std::array<std::string_view, 2> kResolutions{"full", "half"};

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
	std::vector<MethodOption> of_methods;
	PictureOptions picture;
	std::vector<RivalOption> of_rivals;
	CLI::Option* pattern_option = nullptr;
	CLI::Option* filter = nullptr;
	CLI::Option* taps = nullptr;
	CLI::Option* device_number = nullptr;
	int device = 0;
	bool timing = false;
	Outputs outputs;
	int threads = 0;
};

void declare(CLI::App& app, ShadeOptions& options)
{
	ShadeSettings& settings = options.settings;
	addText(app, "FILE", options.gbuffer, "FILE.exr", "A G-buffer, of nook or of an engine")->required();
	addChoiceText(
		app, "--method", methodNames(), [&settings](std::size_t i) { settings.method = static_cast<ShadeMethod>(i); },
		"Volumetric obscurance by lines, points or areas, Alchemy, or statistical volumetric obscurance; to compare with: Crytek's "
		"points, volumetric ambient "
		"occlusion in the tangent sphere, horizon-based, and scalable ambient obscurance (docs/comparison.md)")
		->required();
	options.pattern_option = addText(
		app, "--pattern", options.pattern, "FILE",
		"The samples: a pattern or a tile of nook (default: 9 of nook's own, crytek 16 of Crytek's, reflected at random in 4 x 4 "
		"pixels). Lines and areas take the disk, points the ball, Alchemy and volumetric-ao the hemisphere, seen from above");
	addNumber(app, "--radius", settings.radius_m, 1e-6, 1e6, "Radius in metres (default 0.5)");
	options.of_methods = addMethodOptions(app, settings);
	for (const MethodOption& option : addPictureOptions(app, settings, options.picture))
	{
		options.of_methods.push_back(option);
	}
	options.of_rivals = addRivalOptions(app, settings.rival);
	options.filter = addChoiceText(
		app, "--filter", kFilters, [&settings](std::size_t i) { settings.filter = static_cast<ShadeFilter>(i); },
		"What takes the noise out again, staying on each pixel's surface: none; bilateral (default, but for statvo, which has "
		"none), two passes along x "
		"and y; or window, one pass over the window of the tile");
	options.taps = addWhole(app, "--taps", settings.filter_taps, 5, 13, "Bilateral: of each pass, an odd number (default 5)");
	addChoiceText(
		app, "--resolution", kResolutions, [&settings](std::size_t i) { settings.half_resolution = i == 1; },
		"full (default), or half: every second pixel of both axes, the others from those of their surface");
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
	addOutputs(app, options.outputs, kFormats);
	addThreads(app, options.threads);
}

void check(const ShadeOptions& options)
{
	checkMethodOptions(options.of_methods, options.settings);
	checkPictureOptions(options.settings);
	checkRivalOptions(options.of_rivals, options.settings.method);
	checkDebug(options.settings);
	if (options.settings.debug && (options.filter->count() > 0 || options.taps->count() > 0))
	{
		throw Error(ExitCode::usage, "--debug: found with " + std::string(options.filter->count() > 0 ? "--filter" : "--taps") +
										 ", but views are drawn before any filter, expected one of them");
	}
	const std::string method(methodNames()[static_cast<std::size_t>(options.settings.method)]);
	if (options.pattern_option->count() > 0 && !takesPattern(options.settings.method))
	{
		throw Error(ExitCode::usage, "--pattern: found with --method " + method + ", whose samples are its own, expected none");
	}
	if (options.taps->count() > 0 && options.settings.filter != ShadeFilter::bilateral)
	{
		throw Error(ExitCode::usage, "--taps: found with another filter, expected --filter bilateral");
	}
	if (options.settings.filter_taps % 2 == 0)
	{
		refuseValue("--taps", std::to_string(options.settings.filter_taps), "an odd number");
	}
	if (options.device_number->count() > 0 && !options.gl)
	{
		throw Error(ExitCode::usage, "--gl-device: found with --device cpu, expected --device gl");
	}
	if (options.settings.statvo.builder == TableBuilder::compute && !options.gl)
	{
		throw Error(ExitCode::usage, "--tables-by: found compute with --device cpu, expected --device gl");
	}
	if (options.gl && options.threads > 0)
	{
		throw Error(ExitCode::usage, "--threads: found with --device gl, expected --device cpu");
	}
	checkGBufferImport(options.import);
	std::vector<std::string> inputs{options.gbuffer};
	if (!options.pattern.empty())
	{
		inputs.push_back(options.pattern);
	}
	checkOutputs(options.outputs, kFormats, inputs);
}

// Without --pattern.
Pattern defaultPattern(const ShadeSettings& settings, const RunSettings& run)
{
	if (settings.method == ShadeMethod::crytek)
	{
		return crytekPoints(16);
	}
	Recipe recipe;
	recipe.domain = domainOf(settings.method);
	recipe.count = 9;
	recipe.symmetric = settings.volume.paired;
	recipe.order = settings.bands.count > 1 ? Order::progressive : Order::none;
	return generatePattern(recipe, run);
}

std::vector<Pattern> variantsOf(const ShadeOptions& options, const RunSettings& run)
{
	const Domain domain = domainOf(options.settings.method);
	if (options.pattern.empty())
	{
		TileRecipe tile;
		tile.kind = TileKind::random;
		return generateTile(defaultPattern(options.settings, run), tile, run).variants;
	}
	std::variant<PatternFile, TileFile> input = readInput(options.pattern, domain);
	std::vector<Pattern> variants;
	if (PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		completeWeights(*file);
		variants = {file->pattern};
	}
	else
	{
		variants = std::get<TileFile>(input).tile.variants;
	}
	if (options.settings.bands.count > 1)
	{
		checkProgressive(input, options.pattern);
	}
	if (variants.front().domain != domain)
	{
		throw Error(ExitCode::invalid_input, options.pattern + ": domain: found " + std::string(nameOf(variants.front().domain)) +
												 ", expected " + std::string(nameOf(domain)) + " for --method " +
												 std::string(methodNames()[static_cast<std::size_t>(options.settings.method)]));
	}
	return variants;
}

ShadeSamples shadeSamples(const ShadeOptions& options, const RunSettings& run)
{
	if (!takesPattern(options.settings.method))
	{
		return ownSamples(options.settings);
	}
	std::vector<Pattern> variants = variantsOf(options, run);
	if (options.settings.volume.paired)
	{
		for (Pattern& variant : variants)
		{
			variant = pairedPattern(variant);
		}
	}
	return samplesOf(options.settings.method, variants);
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
	const std::string name(kFilters[static_cast<std::size_t>(settings.filter)]);
	return settings.filter == ShadeFilter::bilateral ? name + " " + std::to_string(settings.filter_taps) : name;
}

void run(const ShadeOptions& options)
{
	check(options);
	const RunSettings settings = runSettings(options.threads);
	const GBuffer gbuffer = readGBuffer(options.gbuffer, options.import);
	const ShadeSamples samples = shadeSamples(options, settings);
	if (options.settings.filter == ShadeFilter::window && samples.size == 1)
	{
		const bool given = !options.pattern.empty();
		throw Error(ExitCode::usage,
					"--filter: found 'window' with " +
						(given ? options.pattern
							   : "--method " + std::string(methodNames()[static_cast<std::size_t>(options.settings.method)])) +
						", whose samples have no window, expected " + (given ? "--pattern with a tile" : "another filter"));
	}
	checkDebug(options.settings, samples);
	DrawSettings drawing;
	drawing.repetitions = options.timing ? kRepetitions : 0;
	if (options.device_number->count() > 0)
	{
		drawing.gl_device = options.device;
	}
	const Shaded shaded = options.gl ? shadeOnGl(gbuffer, samples, options.settings, drawing)
									 : shadeOnCpu(gbuffer, samples, options.settings, settings, drawing);

	const Picture picture = withoutGuard(options.gbuffer, gbuffer, shaded.visibility, options.picture);
	const std::string method(methodNames()[static_cast<std::size_t>(options.settings.method)]);
	const bool statvo = options.settings.method == ShadeMethod::statvo;
	const Notes notes{
		{"Software", "nook " NOOK_VERSION},
		{"nook:method", method},
		{"nook:radius_m", numberText(options.settings.radius_m)},
		{statvo ? "nook:layers" : "nook:samples", statvo ? layersText(options.settings.statvo) : std::to_string(samples.count)},
		{"nook:filter", filterText(options.settings)},
		{"nook:shows", std::string(debugName(options.settings))},
		{"nook:resolution", std::string(kResolutions[options.settings.half_resolution ? 1 : 0])}};
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, formatOf(path, kFormats) == ".png"
							? visibilityPng(picture.width_px, picture.height_px, picture.values, notes)
							: exrBytes({picture.width_px,
										picture.height_px,
										{std::string(debugName(options.settings))},
										picture.values,
										notes,
										{}}));
	}
	Summary summary("shade");
	summary.text("method", method);
	summary.text("renderer", shaded.renderer);
	summary.number("radius_m", options.settings.radius_m);
	const LimitedRadii limited = limitedRadii(gbuffer, options.settings);
	summary.whole("radius_limited_near", limited.near);
	summary.whole("radius_limited_far", limited.far);
	if (statvo)
	{
		summary.text("layers", layersText(options.settings.statvo));
		summary.text("tables_by", shaded.tables_by);
	}
	else
	{
		summary.whole("samples", static_cast<std::size_t>(samples.count));
	}
	if (options.settings.debug)
	{
		summary.text("debug", debugName(options.settings));
		summary.number("mean", meanOf(picture.values));
	}
	summary.text("filter", filterText(options.settings));
	summary.text("resolution", kResolutions[options.settings.half_resolution ? 1 : 0]);
	summary.whole("window", static_cast<std::size_t>(samples.size));
	if (options.timing)
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
	std::vector<std::string> read{options.gbuffer};
	if (!options.pattern.empty())
	{
		read.push_back(options.pattern);
	}
	addSide(files, options.outputs, summary.json(), read);
	files.commit();
	if (options.timing && options.outputs.json != "-")
	{
		std::string text = shaded.renderer + ": " + numberText(1e3 * shaded.seconds) + " ms\n";
		for (const PassTime& pass : shaded.passes)
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
	CLI::App* const app = nook.add_subcommand("shade", "Visibility by a screen-space method, on the CPU or through OpenGL");
	declare(*app, *options);
	return {app, [options]
			{
				if ((options->settings.method == ShadeMethod::statvo || options->settings.debug) && options->filter->count() == 0)
				{
					options->settings.filter = ShadeFilter::none;
				}
				run(*options);
			}};
}

} // namespace nook
