// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit_features.h"

#include "options.h"
#include "statvo_options.h"

#include "core/error.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

using Methods = std::vector<ShadeMethod>;

constexpr std::array<std::string_view, 3> kFilters{"none", "bilateral", "window"};
constexpr std::array<std::string_view, 2> kResolutions{"full", "half"};

void addOfMethods(CLI::App& app, ShadeSettings& settings, std::vector<EmitFeature>& features)
{
	const Methods lines{ShadeMethod::vo_line, ShadeMethod::vo_area};
	const Methods volume{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area};
	const Methods oriented{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area, ShadeMethod::statvo};
	const Methods of_patterns{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area, ShadeMethod::alchemy};
	VoSettings& vo = settings.volume;
	features.push_back({addChoiceText(
							app, "--use-normal", kNormalUses, [&settings](std::size_t i) { settings.use_normal = i == 0; },
							"Volumetric obscurance above the tangent plane alone (default: yes); no: nothing reads normals, and an "
							"open flat surface reads 1/2"),
						oriented});
	features.push_back({app.add_flag(
							"--thick", [&vo](std::int64_t count) { vo.thickness_m = count > 0 ? 1.0 : 0.0; },
							"Volumetric obscurance: surfaces end behind nook_settings.thickness"),
						volume});
	features.push_back(
		{addChoiceText(
			 app, "--combine", kCombinations, [&vo](std::size_t i) { vo.radii = i == 0 ? TwoRadii::product : TwoRadii::minimum; },
			 "Volumetric obscurance of two radii: their product, or the lesser; nook_settings.second_radius"),
		 volume});
	features.push_back({addChoiceText(
							app, "--falloff", kFalloffs, [&vo](std::size_t i) { vo.quadratic = i == 1; },
							"Volumetric obscurance: matter counts alike in the whole ball (constant, default), or by "
							"1 - (d / radius)^2"),
						volume});
	features.push_back(
		{app.add_flag("--paired", vo.paired,
					  "Lines and areas: where a surface is out of range, a sample is as open as the one at the opposite "
					  "side; needs patterns made with --symmetric"),
		 lines});
	features.push_back(
		{app.add_flag("--cut", settings.cut, "Alchemy: leaves out what is further away than the radius"), {ShadeMethod::alchemy}});
	features.push_back(
		{addWhole(app, "--depth-levels", settings.depth_levels, 0, 8,
				  "Alchemy: samples that are far away in the picture read coarser depths, of that many passes (default 0)"),
		 {ShadeMethod::alchemy}});
	features.push_back(
		{addWhole(app, "--bands", settings.bands.count, 1, 3,
				  "Fewer samples where the radius is small in the picture, of patterns made with --order progressive: "
				  "nook_settings.first_band, second_band (default 1: all samples everywhere)"),
		 of_patterns});
}

void addOfStatVo(CLI::App& app, StatVoSettings& statvo, std::vector<EmitFeature>& features)
{
	const Methods methods{ShadeMethod::statvo};
	features.push_back(
		{addWhole(app, "--layers", statvo.layers, 1, 64, "StatVO: layers of depth, 1, 2 or 4 (default); uniform: 1 to 64"),
		 methods});
	features.push_back(
		{addChoiceText(
			 app, "--layering", kLayerings, [&statvo](std::size_t i) { statvo.layering = static_cast<StatVoLayering>(i); },
			 "StatVO: adaptive (default) or uniform"),
		 methods});
	features.push_back({app.add_flag("--quadrants", statvo.quadrants, "StatVO: four parts of the box by themselves"), methods});
	features.push_back({addChoiceText(
							app, "--tables", kStatVoTables, [&statvo](std::size_t i) { statvo.cell_px = 1 << i; },
							"StatVO: summed-area tables of full (default), half or quarter width and height"),
						methods});
	features.push_back({addChoiceText(
							app, "--skip", kSkips, [&statvo](std::size_t i) { statvo.skip = i == 0; },
							"StatVO: looks at no layers where a surface is smooth (default yes)"),
						methods});
}

} // namespace

std::vector<EmitFeature> addEmitFeatures(CLI::App& app, ShadeSettings& settings)
{
	std::vector<EmitFeature> features;
	addOfMethods(app, settings, features);
	addOfStatVo(app, settings.statvo, features);
	features.push_back(
		{addChoiceText(
			 app, "--filter", kFilters, [&settings](std::size_t i) { settings.filter = static_cast<ShadeFilter>(i); },
			 "What takes the noise out: none (default); bilateral, two passes of nookBilateral; or window, nookWindow, "
			 "the mean over the window of a tile. Both stay on each pixel's surface"),
		 {}});
	features.push_back(
		{addWhole(app, "--taps", settings.filter_taps, 5, 13, "Bilateral: of each pass, an odd number (default 5)"), {}});
	features.push_back({addChoiceText(
							app, "--resolution", kResolutions, [&settings](std::size_t i) { settings.half_resolution = i == 1; },
							"full (default), or half: method and filter for every second pixel of both axes, and a pass that makes "
							"the whole picture of them"),
						{}});
	return features;
}

void checkEmitFeatures(const std::vector<EmitFeature>& features, const ModuleSettings& settings,
					   const std::vector<ShadeMethod>& methods)
{
	for (const EmitFeature& feature : features)
	{
		const auto takes = [&feature](ShadeMethod method)
		{
			return std::find(feature.methods.begin(), feature.methods.end(), method) != feature.methods.end();
		};
		if (feature.option->count() > 0 && !feature.methods.empty() && std::none_of(methods.begin(), methods.end(), takes))
		{
			std::string names;
			for (const ShadeMethod method : feature.methods)
			{
				names += (names.empty() ? "" : " or ") + std::string(moduleNameOf(method));
			}
			throw Error(ExitCode::usage, feature.option->get_name() + ": found without a method that it changes, expected " +
											 names + " among --methods");
		}
		if (feature.option->count() > 0 && feature.option->get_name() == "--taps" &&
			settings.shade.filter != ShadeFilter::bilateral)
		{
			throw Error(ExitCode::usage, "--taps: found with another filter, expected --filter bilateral");
		}
	}
	const ShadeSettings& shade = settings.shade;
	if (shade.filter_taps % 2 == 0)
	{
		refuseValue("--taps", std::to_string(shade.filter_taps), "an odd number");
	}
	if (shade.bands.count > 1 && shade.volume.paired)
	{
		throw Error(ExitCode::usage, "--bands: found with --paired, expected one of them");
	}
	checkStatVo(shade.statvo);
}

std::string featuresText(const std::vector<EmitFeature>& features)
{
	std::string text;
	for (const EmitFeature& feature : features)
	{
		if (feature.option->count() > 0)
		{
			text += " " + feature.option->get_name();
			text += feature.option->get_expected_max() > 0 ? " " + feature.option->results().front() : "";
		}
	}
	return text;
}

} // namespace nook
