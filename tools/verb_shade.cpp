// SPDX-License-Identifier: GPL-3.0-or-later
// nook shade: a G-buffer → visibility by a screen-space method, by occlusion volumes or by both, on the CPU or through OpenGL.
#include "debug_options.h"
#include "shade_options.h"
#include "shade_samples.h"
#include "summary.h"

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

constexpr int kRepetitions = 9; // drawings for --timing

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
		of_volumes.settings.every_px = options.aov.alone ? everyPx(options) : 1;
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
	notes.push_back({"nook:resolution", std::string(resolutionOf(options))});
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
	summary.text("resolution", resolutionOf(options));
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
	declareShade(*app, *options);
	return {app, [options](VerbProgress& progress)
			{
				settle(*options);
				run(*options, progress);
			}};
}

} // namespace nook
