// SPDX-License-Identifier: GPL-3.0-or-later
#include "method_options.h"

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

void addVolume(CLI::App& app, ShadeSettings& settings, std::vector<MethodOption>& options)
{
	const Methods all{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area};
	const Methods with_boxes{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area, ShadeMethod::statvo};
	VoSettings& volume = settings.volume;
	options.push_back(
		{addChoiceText(
			 app, "--use-normal", kNormalUses, [&settings](std::size_t i) { settings.use_normal = i == 0; },
			 "Volumetric obscurance, StatVO: above the tangent plane alone (default: yes); without, an open flat surface "
			 "reads 1/2"),
		 with_boxes});
	options.push_back({addNumber(app, "--thickness", volume.thickness_m, 1e-6, 1e6,
								 "Volumetric obscurance: metres that surfaces are thick; open again behind (default: no end)"),
					   all});
	options.push_back({addNumber(app, "--radius2", volume.second_radius_m, 1e-6, 1e6,
								 "Volumetric obscurance: a second radius in metres; needs --combine"),
					   all});
	options.push_back({addChoiceText(
						   app, "--combine", kCombinations,
						   [&volume](std::size_t i) { volume.radii = i == 0 ? TwoRadii::product : TwoRadii::minimum; },
						   "Of the visibilities of two radii: their product, or the lesser; needs --radius2"),
					   all});
	options.push_back({addChoiceText(
						   app, "--falloff", kFalloffs, [&volume](std::size_t i) { volume.quadratic = i == 1; },
						   "Volumetric obscurance: matter counts alike in the whole ball (constant, default), or by "
						   "1 - (d / radius)^2"),
					   all});
	options.push_back(
		{app.add_flag("--paired", volume.paired,
					  "Lines and areas: where a surface is out of range, a sample is as open as the one at the opposite "
					  "side (less halo); needs a pattern made with --symmetric"),
		 {ShadeMethod::vo_line, ShadeMethod::vo_area}});
}

void addAlchemy(CLI::App& app, ShadeSettings& settings, std::vector<MethodOption>& options)
{
	const Methods alchemy{ShadeMethod::alchemy};
	options.push_back(
		{addNumber(app, "--sigma", settings.sigma, 0.0, 1e6, "Alchemy: intensity, with lengths in units of the radius (default 1)"),
		 alchemy});
	options.push_back(
		{addNumber(app, "--contrast", settings.contrast, 1e-3, 1e3, "Alchemy: the power at the end (default 1)"), alchemy});
	options.push_back(
		{addNumber(app, "--beta", settings.beta, 0.0, 1.0, "Alchemy: bias, a share of the depth (default 1e-4)"), alchemy});
	options.push_back({addNumber(app, "--epsilon", settings.epsilon, 1e-12, 1e6,
								 "Alchemy: keeps the quotient finite, in squares of the radius (default 1e-4)"),
					   alchemy});
	options.push_back({app.add_flag("--cut", settings.cut, "Alchemy: leaves out what is further away than the radius"), alchemy});
	options.push_back({addWhole(app, "--depth-levels", settings.depth_levels, 0, 8,
								"Alchemy: coarser depths for samples 16 pixels away and more, one more with every doubling "
								"(default 0: none)"),
					   alchemy});
}

void addBands(CLI::App& app, ShadeSettings& settings, std::vector<MethodOption>& options)
{
	const Methods of_patterns{ShadeMethod::vo_line, ShadeMethod::vo_point, ShadeMethod::vo_area, ShadeMethod::alchemy};
	BandSettings& bands = settings.bands;
	options.push_back(
		{addWhole(app, "--bands", bands.count, 1, 3,
				  "Fewer samples where the radius is small in the picture: the first half, or third and two thirds, of "
				  "a pattern made with --order progressive (default 1: all samples everywhere)"),
		 of_patterns});
	options.push_back({addNumber(app, "--band1-pixels", bands.first_px, 0.5, 1e6,
								 "Of the bands: radius in pixels below which the first one is enough (default 16)"),
					   of_patterns});
	options.push_back({addNumber(app, "--band2-pixels", bands.second_px, 0.5, 1e6,
								 "Of three bands: radius in pixels below which the first two are enough (default 48)"),
					   of_patterns});
}

bool given(const std::vector<MethodOption>& options, const std::string& name)
{
	return std::any_of(options.begin(), options.end(),
					   [&name](const MethodOption& one) { return one.option->get_name() == name && one.option->count() > 0; });
}

} // namespace

std::vector<MethodOption> addMethodOptions(CLI::App& app, ShadeSettings& settings)
{
	std::vector<MethodOption> options;
	addVolume(app, settings, options);
	addAlchemy(app, settings, options);
	addBands(app, settings, options);
	addStatVoOptions(app, settings.statvo, options);
	return options;
}

void checkMethodOptions(const std::vector<MethodOption>& options, const ShadeSettings& settings)
{
	for (const MethodOption& one : options)
	{
		const bool fits = std::find(one.methods.begin(), one.methods.end(), settings.method) != one.methods.end();
		if (one.option->count() > 0 && !fits)
		{
			std::string names;
			for (const ShadeMethod method : one.methods)
			{
				names += (names.empty() ? "" : " or ") + std::string(nameOf(method));
			}
			throw Error(ExitCode::usage, one.option->get_name() + ": found with another method, expected --method " + names);
		}
	}
	if (given(options, "--radius2") != given(options, "--combine"))
	{
		throw Error(ExitCode::usage, "--radius2, --combine: found one of them, expected both or none");
	}
	checkStatVo(settings.statvo);
	const BandSettings& bands = settings.bands;
	if (bands.count > 1 && settings.volume.paired)
	{
		throw Error(ExitCode::usage, "--bands: found with --paired, expected one of them");
	}
	if ((given(options, "--band1-pixels") && bands.count < 2) || (given(options, "--band2-pixels") && bands.count < 3))
	{
		throw Error(ExitCode::usage, "--bands: found " + std::to_string(bands.count) + ", expected more bands than limits given");
	}
	if (bands.count == 3 && !(bands.first_px < bands.second_px))
	{
		throw Error(ExitCode::usage, "--band1-pixels: found no less than --band2-pixels, expected less");
	}
}

} // namespace nook
