// SPDX-License-Identifier: GPL-3.0-or-later
#include "aov_options.h"

#include "volume_methods.h"

#include "core/error.h"
#include "core/number.h"
#include "methods/method_table.h"
#include "volume/volume_glb.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <initializer_list>
#include <utility>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 3> kTargets{"r16f", "r8", "r32f"}; // of AovTarget, in its order
constexpr std::array<std::string_view, 2> kFaces{"chosen", "front"};

// The first of these that was given, or null.
const char* firstGiven(std::initializer_list<std::pair<const char*, bool>> options)
{
	for (const auto& [name, given] : options)
	{
		if (given)
		{
			return name;
		}
	}
	return nullptr;
}

} // namespace

void addAovOptions(CLI::App& app, AovOptions& options)
{
	AovSettings& settings = options.settings;
	addText(app, "--volumes", options.path, "FILE.glb",
			"Occlusion volumes of the level that the G-buffer shows (nook volumes): " + volumeMethods(" and ") +
				" draw them alone; with another method each pixel takes the lesser visibility of the two");
	options.directions = addDirections(app, settings.directions);
	options.accumulate = addChoiceText(
		app, "--accumulate", kTargets, [&settings](std::size_t i) { settings.target = static_cast<AovTarget>(i); },
		"Volumes, --device gl: what occlusion is added up in: r16f (default), r8, which saturates, or r32f");
	app.add_flag("--no-compensation", options.no_compensation,
				 "Volumes, but for " + maskMethod() + ": the plain sum of occlusion, without the curve for what is counted twice");
	app.add_flag("--draw-all", options.draw_all, "Volumes, --device gl: clusters that are out of sight, too");
	options.faces = addChoiceText(
		app, "--faces", kFaces, [&settings](std::size_t i) { settings.choose_faces = i == 0; },
		"Volumes, --device gl: which faces of each are drawn: chosen (default), those that cover fewer pixels, where the file has "
		"exact bounds; front, but for clusters that hold the eye; the picture is the same");
}

std::string_view methodName(const AovOptions& options)
{
	assert(options.alone);
	return volumeRow(options.settings.mask).name;
}

void checkAovOptions(const AovOptions& options, bool gl, const std::vector<const CLI::Option*>& others)
{
	const auto refuse = [](const std::string& option, const std::string& with, const std::string& expected)
	{
		throw Error(ExitCode::usage, option + ": found with " + with + ", expected " + expected);
	};
	const std::pair accumulate("--accumulate", options.accumulate->count() > 0);
	const std::pair no_compensation("--no-compensation", options.no_compensation);
	const std::pair draw_all("--draw-all", options.draw_all);
	const std::pair faces("--faces", options.faces->count() > 0);
	checkDirections(*options.directions, options.settings.directions, options.settings.mask);
	if (options.path.empty())
	{
		if (options.alone)
		{
			throw Error(ExitCode::usage, "--volumes: found none with --method " + std::string(methodName(options)) +
											 ", expected a file of nook volumes");
		}
		const char* const given = firstGiven({accumulate, no_compensation, draw_all, faces});
		if (given != nullptr)
		{
			refuse(given, "no volumes", "--volumes");
		}
	}
	const char* const adds = firstGiven({no_compensation, accumulate});
	if (options.settings.mask && adds != nullptr)
	{
		refuse(adds, "--method " + maskMethod() + ", which adds nothing up", "--method " + sumMethod());
	}
	const char* const of_gl = firstGiven({accumulate, draw_all, faces});
	if (!gl && of_gl != nullptr)
	{
		refuse(of_gl, "--device cpu", "--device gl");
	}
	if (options.alone)
	{
		for (const CLI::Option* const option : others)
		{
			if (option->count() > 0)
			{
				refuse(option->get_name(), "--method " + std::string(methodName(options)), "a screen-space method");
			}
		}
	}
}

Shaded drawVolumes(const AovOptions& options, bool gl, const GBuffer& gbuffer, const RunSettings& run, const DrawSettings& drawing,
				   AovFacts& facts)
{
	const VolumeSet volumes = readVolumes(options.path);
	AovSettings settings = options.settings;
	settings.compensate = !options.no_compensation;
	settings.cull = !options.draw_all;
	const AovShaded drawn = gl ? aovOnGl(gbuffer, volumes, settings, drawing) : aovOnCpu(gbuffer, volumes, settings, run, drawing);
	facts = {options.path, volumes.distance_m, volumes.ray_distance_m, settings.every_px, drawn.counts};
	return drawn.shaded;
}

void addAovNotes(Notes& notes, const AovOptions& options, const AovFacts& facts)
{
	notes.push_back({"nook:volumes", std::to_string(facts.counts.volumes)});
	notes.push_back({"nook:distance_m", numberText(facts.distance_m)});
	if (options.settings.mask)
	{
		notes.push_back({"nook:directions", std::to_string(options.settings.directions)});
	}
	else
	{
		notes.push_back({"nook:compensation", options.no_compensation ? "none" : "curve"});
	}
}

void addAovFacts(Summary& summary, const AovOptions& options, const AovFacts& facts, bool gl)
{
	summary.number("distance_m", facts.distance_m);
	// A mask's falloff is that of the reference at the volumes' own reach.
	summary.number("ray_distance_m", options.settings.mask ? facts.distance_m : facts.ray_distance_m);
	summary.whole("volumes", facts.counts.volumes);
	summary.whole("fragments", facts.counts.fragments);
	if (facts.every_px > 1)
	{
		summary.whole("pixels_alone", facts.counts.pixels_alone);
	}
	if (gl)
	{
		summary.whole("clusters_drawn", facts.counts.clusters_drawn);
		summary.whole("volumes_drawn", facts.counts.volumes_drawn);
	}
	if (options.settings.mask)
	{
		summary.whole("directions", static_cast<std::size_t>(options.settings.directions));
		return;
	}
	summary.text("compensation", options.no_compensation ? "none" : "curve");
	if (gl)
	{
		summary.text("accumulate", kTargets[static_cast<std::size_t>(options.settings.target)]);
	}
}

} // namespace nook
