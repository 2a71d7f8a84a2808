// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the table of features, a function a group of methods.
#include "methods/feature_rows.h"

#include "core/number.h"
#include "methods/method_table.h"

#include <algorithm>
#include <array>
#include <type_traits>

namespace nook
{
namespace
{

// A member of the settings, through the members that hold it.
template <auto... path> FeatureValue member()
{
	const auto get = [](const ShadeSettings& settings)
	{
		return static_cast<double>((settings.*....*path));
	};
	const auto set = [](ShadeSettings& settings, double value)
	{
		auto& held = (settings.*....*path);
		held = static_cast<std::remove_reference_t<decltype(held)>>(value);
	};
	return {get, set};
}

// The same for choices of yes, then no.
template <auto... path> FeatureValue yesNo()
{
	const auto get = [](const ShadeSettings& settings)
	{
		return (settings.*....*path) ? 0.0 : 1.0;
	};
	const auto set = [](ShadeSettings& settings, double value)
	{
		(settings.*....*path) = value == 0.0;
	};
	return {get, set};
}

const std::vector<std::string_view> kYesNo{"yes", "no"};

void addVolume(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	using V = VoSettings;
	rows.push_back(
		{.option = "--use-normal",
		 .kind = FeatureKind::choice,
		 .features = kOfNormals,
		 .choices = kYesNo,
		 .value = yesNo<&S::use_normal>(),
		 .help =
			 "Volumetric obscurance, StatVO: above the tangent plane alone (default: yes); without, nothing reads normals, and an "
			 "open flat surface reads 1/2",
		 .word = [](const S& s)
		 {
			 return std::string(s.use_normal ? "" : "no-normal");
		 }});
	rows.push_back({.option = "--thickness",
					.kind = FeatureKind::number,
					.places = kInShade,
					.features = kOfVolume,
					.least = 1e-6,
					.most = 1e6,
					.unit = "m",
					.value = member<&S::volume, &V::thickness_m>(),
					.help = "Volumetric obscurance: metres that surfaces are thick; open again behind (default: no end)",
					.nothing = "no end",
					.setting = "thickness"});
	rows.push_back({.option = "--thick",
					.places = kInEmit,
					.features = kOfVolume,
					.value = {[](const S& s) { return s.volume.thickness_m > 0.0 ? 1.0 : 0.0; },
							  [](S& s, double on)
							  {
								  s.volume.thickness_m = on;
							  }},
					.help = "Volumetric obscurance: surfaces are thick, and open again behind",
					.setting = "thickness, second_thickness, third_thickness",
					.word = [](const S& s)
					{
						return std::string(s.volume.thickness_m > 0.0 ? "thick" : "");
					}});
	rows.push_back({.option = "--radius2",
					.kind = FeatureKind::number,
					.places = kInShade,
					.features = kOfVolume,
					.least = 1e-6,
					.most = 1e6,
					.unit = "m",
					.value = member<&S::volume, &V::second_radius_m>(),
					.help = "Volumetric obscurance: a second radius in metres",
					.nothing = "none",
					.needs = "--combine",
					.setting = "second_radius"});
	rows.push_back({.option = "--combine",
					.kind = FeatureKind::choice,
					.features = kOfVolume,
					.choices = {"product", "minimum"},
					.value = {[](const S& s) { return static_cast<double>(s.volume.radii) - 1.0; },
							  [](S& s, double i)
							  {
								  s.volume.radii = static_cast<TwoRadii>(i + 1.0);
							  }},
					.help = "Of the visibilities of several radii: their product, or the least",
					.needs = "--radius2",
					.setting = "second_radius"});
	const auto length = [&rows](std::string_view option, FeatureValue value, std::string_view help, std::string_view nothing,
								std::string_view base, std::string_view setting)
	{
		rows.push_back({.option = option,
						.kind = FeatureKind::number,
						.places = kInShade,
						.features = kOfVolume,
						.least = 1e-6,
						.most = 1e6,
						.unit = "m",
						.value = value,
						.help = help,
						.nothing = nothing,
						.base = base,
						.setting = setting});
	};
	length("--radius3", member<&S::volume, &V::third_radius_m>(), "Volumetric obscurance: a third radius in metres (default: none)",
		   "none", "--radius2", "third_radius");
	length("--thickness2", member<&S::volume, &V::second_thickness_m>(), "The same for the second radius (default: as --thickness)",
		   "as --thickness", "--thickness", "second_thickness");
	length("--thickness3", member<&S::volume, &V::third_thickness_m>(), "The same for the third radius (default: as --thickness)",
		   "as --thickness", "--thickness", "third_thickness");
	rows.push_back({.option = "--third-radius",
					.places = kInEmit,
					.features = kOfVolume,
					.value = {[](const S& s) { return s.volume.third_radius_m > 0.0 ? 1.0 : 0.0; },
							  [](S& s, double on)
							  {
								  s.volume.third_radius_m = on;
							  }},
					.help = "Volumetric obscurance: a third radius, beside --combine",
					.base = "--combine",
					.setting = "third_radius",
					.word = [](const S& s)
					{
						return std::string(s.volume.third_radius_m > 0.0      ? "three-radii"
										   : s.volume.radii != TwoRadii::none ? "two-radii"
																			  : "");
					}});
	rows.push_back(
		{.option = "--falloff",
		 .kind = FeatureKind::choice,
		 .features = kOfVolume,
		 .choices = {"constant", "quadratic"},
		 .value = member<&S::volume, &V::quadratic>(),
		 .help = "Volumetric obscurance: matter counts alike in the whole ball (constant, default), or by 1 - (d / radius)^2",
		 .word = [](const S& s)
		 {
			 return std::string(s.volume.quadratic ? "quadratic" : "");
		 }});
	rows.push_back({.option = "--paired",
					.features = kOfPairs,
					.value = member<&S::volume, &V::paired>(),
					.help = "Lines and areas: where a surface is out of range, a sample is as open as the one at the opposite side "
							"(less halo); needs a pattern made with --symmetric",
					.word = [](const S& s)
					{
						return std::string(s.volume.paired ? "paired" : "");
					}});
}

void addIntensity(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	const auto number = [&rows](std::string_view option, double least, double most, std::string_view unit, FeatureValue value,
								std::string_view help)
	{
		rows.push_back({.option = option,
						.kind = FeatureKind::number,
						.places = kInShade,
						.features = kOfIntensity,
						.least = least,
						.most = most,
						.unit = unit,
						.value = value,
						.help = help,
						.setting = option.substr(2)});
	};
	number("--sigma", 0.0, 1e6, "", member<&S::sigma>(), "Alchemy: intensity, with lengths in units of the radius (default 1)");
	number("--contrast", 1e-3, 1e3, "", member<&S::contrast>(), "Alchemy: the power at the end (default 1)");
	number("--beta", 0.0, 1.0, "share of the depth", member<&S::beta>(), "Alchemy: bias, a share of the depth (default 1e-4)");
	number("--epsilon", 1e-12, 1e6, "radii²", member<&S::epsilon>(),
		   "Alchemy: keeps the quotient finite, in squares of the radius (default 1e-4)");
	rows.push_back({.option = "--cut",
					.features = kOfIntensity,
					.value = member<&S::cut>(),
					.help = "Alchemy: leaves out what is further away than the radius",
					.word = [](const S& s)
					{
						return std::string(s.cut ? "cut" : "");
					}});
	rows.push_back(
		{.option = "--depth-levels",
		 .kind = FeatureKind::whole,
		 .features = kOfIntensity,
		 .most = 8.0,
		 .value = member<&S::depth_levels>(),
		 .help = "Alchemy: coarser depths for samples 16 pixels away and more, one more with every doubling (default 0: none)",
		 .word = [](const S& s)
		 {
			 return std::string(s.depth_levels > 0 ? "levels" : "");
		 }});
	constexpr static std::array<int, 4> kBits{8, 10, 16, 32};
	const auto bits = [](const S& s)
	{
		return static_cast<double>(std::find(kBits.begin(), kBits.end(), s.normal_bits) - kBits.begin());
	};
	rows.push_back(
		{.option = "--normal-bits",
		 .kind = FeatureKind::choice,
		 .places = kInShade,
		 .features = kOfIntensity,
		 .choices = {"8", "10", "16", "32"},
		 .unit = "bits",
		 .value = {bits,
				   [](S& s, double i)
				   {
					   s.normal_bits = kBits[static_cast<std::size_t>(i)];
				   }},
		 .help = "Alchemy: bits of a component of the normals; what rounding may turn them by does not occlude (default: 32)"});
}

void addBands(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	using B = BandSettings;
	rows.push_back({.option = "--bands",
					.kind = FeatureKind::whole,
					.features = kOfBands,
					.least = 1.0,
					.most = 3.0,
					.value = member<&S::bands, &B::count>(),
					.help = "Fewer samples where the radius is small in the picture: the first half, or third and two thirds, of a "
							"pattern made with --order progressive (default 1: all samples everywhere)",
					.conflict = "--paired",
					.setting = "first_band, second_band",
					.word = [](const S& s)
					{
						return std::string(s.bands.count > 1 ? "bands" : "");
					}});
	const auto limit = [&rows](std::string_view option, FeatureValue value, std::string_view help)
	{
		rows.push_back({.option = option,
						.kind = FeatureKind::number,
						.places = kInShade,
						.features = kOfBands,
						.least = 0.5,
						.most = 1e6,
						.unit = "px",
						.value = value,
						.help = help});
	};
	limit("--band1-pixels", member<&S::bands, &B::first_px>(),
		  "Of the bands: radius in pixels below which the first one is enough (default 16)");
	limit("--band2-pixels", member<&S::bands, &B::second_px>(),
		  "Of three bands: radius in pixels below which the first two are enough (default 48)");
}

void addTables(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	using T = StatVoSettings;
	rows.push_back({.option = "--layers",
					.kind = FeatureKind::whole,
					.features = kOfLayers,
					.least = 1.0,
					.most = 64.0,
					.value = member<&S::statvo, &T::layers>(),
					.help = "StatVO: layers of depth, 1, 2 or 4 (default); uniform: 1 to 64",
					.range = "1, 2, 4; uniform: 1 to 64",
					.stated = true});
	rows.push_back({.option = "--layering",
					.kind = FeatureKind::choice,
					.features = kOfLayers,
					.choices = {"adaptive", "uniform"},
					.value = member<&S::statvo, &T::layering>(),
					.help =
						"StatVO: adaptive (default), by the mean depth around each pixel; or uniform, equal parts of the picture's "
						"depths",
					.word = [](const S& s)
					{
						return std::string(s.statvo.layering == StatVoLayering::uniform ? "uniform" : "");
					}});
	rows.push_back({.option = "--quadrants",
					.features = kOfLayers,
					.value = member<&S::statvo, &T::quadrants>(),
					.help = "StatVO: four parts of the box by themselves; better, and dearer",
					.word = [](const S& s)
					{
						return std::string(s.statvo.quadrants ? "quadrants" : "");
					}});
	rows.push_back({.option = "--tables",
					.kind = FeatureKind::choice,
					.features = kOfLayers,
					.choices = {"full", "half", "quarter"},
					.value = {[](const S& s) { return static_cast<double>(s.statvo.cell_px / 2); },
							  [](S& s, double i)
							  {
								  s.statvo.cell_px = 1 << static_cast<int>(i);
							  }},
					.help = "StatVO: summed-area tables of full (default), half or quarter width and height",
					.word = [](const S& s)
					{
						return s.statvo.cell_px > 1 ? "cells-" + std::to_string(s.statvo.cell_px) : std::string();
					}});
	rows.push_back(
		{.option = "--slope",
		 .kind = FeatureKind::number,
		 .places = kInShade,
		 .features = kOfLayers,
		 .least = 1e-3,
		 .most = 1e3,
		 .unit = "per height",
		 .value = member<&S::statvo, &T::slope>(),
		 .help = "StatVO: how fast what is farther in front than the box is high stops counting, per height (default 1)"});
	rows.push_back({.option = "--height",
					.kind = FeatureKind::number,
					.places = kInShade,
					.features = kOfLayers,
					.least = 0.05,
					.most = 100.0,
					.unit = "radii",
					.value = member<&S::statvo, &T::height>(),
					.help = "StatVO: height of the box over the surface, in radii (default 1)"});
	rows.push_back(
		{.option = "--largest",
		 .kind = FeatureKind::whole,
		 .places = kInShade,
		 .features = kOfLayers,
		 .least = 1.0,
		 .most = 255.0,
		 .unit = "px",
		 .value = member<&S::statvo, &T::largest_px>(),
		 .help = "StatVO: half side of the box in the picture at most, in pixels; smaller boxes near the camera, and coarser "
				 "tables the larger it is (default 127)"});
	rows.push_back({.option = "--skip",
					.kind = FeatureKind::choice,
					.features = kOfLayers,
					.choices = kYesNo,
					.value = yesNo<&S::statvo, &T::skip>(),
					.help = "StatVO: looks at no layers where a surface is smooth, which changes nothing that shows (default yes)",
					.word = [](const S& s)
					{
						return std::string(s.statvo.skip ? "skip" : "");
					}});
	rows.push_back(
		{.option = "--tables-by",
		 .kind = FeatureKind::choice,
		 .places = kInShade,
		 .features = kOfLayers,
		 .choices = {"automatic", "compute", "fragments"},
		 .value = member<&S::statvo, &T::builder>(),
		 .help = "StatVO, --device gl: sums by compute shaders or by fragments; automatic (default): compute shaders where a "
				 "GPU has them"});
}

void addSlices(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	using P = SliceSettings;
	rows.push_back({.option = "--slices",
					.kind = FeatureKind::whole,
					.features = kOfSlices,
					.least = 1.0,
					.most = 16.0,
					.value = member<&S::slices, &P::count>(),
					.help = "Slices: planes through the view ray, 1 (default) to 16",
					.stated = true});
	rows.push_back({.option = "--slice-steps",
					.kind = FeatureKind::whole,
					.features = kOfSlices,
					.least = 1.0,
					.most = 32.0,
					.value = member<&S::slices, &P::steps>(),
					.help = "Slices: depths on either side of each, 1 to 32 (default 4)",
					.stated = true,
					.word = [](const S& s)
					{
						return "steps-" + std::to_string(s.slices.steps);
					}});
	rows.push_back({.option = "--slice-thickness",
					.kind = FeatureKind::number,
					.places = kInShade,
					.features = kOfSlices,
					.least = 1e-3,
					.most = 1e3,
					.unit = "radii",
					.value = member<&S::slices, &P::thickness>(),
					.help = "Slices: how thick surfaces at the reach are, near ones down to an eighth of it; light comes from "
							"behind (default 0.65)",
					.setting = "slice_thickness"});
}

// Of the methods to compare with.
void addRivals(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	using R = RivalSettings;
	const auto add = [&rows](unsigned features, FeatureKind kind, std::string_view option, double least, double most,
							 std::string_view unit, FeatureValue value, std::string_view help)
	{
		rows.push_back({.option = option,
						.kind = kind,
						.places = kInShade,
						.features = features,
						.least = least,
						.most = most,
						.unit = unit,
						.value = value,
						.help = help});
	};
	constexpr FeatureKind whole = FeatureKind::whole;
	constexpr FeatureKind number = FeatureKind::number;
	add(kOfRange, number, "--crytek-range", 1e-3, 1e6, "radii", member<&S::rival, &R::range>(),
		"crytek: what is that many radii in front counts as 1/2 (default 2.7)");
	add(kOfHorizon, whole, "--hbao-directions", 1, 64, "", member<&S::rival, &R::directions>(),
		"hbao: directions in the picture (default 6)");
	add(kOfHorizon, whole, "--hbao-steps", 1, 64, "", member<&S::rival, &R::steps>(),
		"hbao: steps along each direction (default 6)");
	add(kOfHorizon, number, "--hbao-angle-bias", 0.0, 89.0, "degrees", member<&S::rival, &R::angle_bias_deg>(),
		"hbao: degrees over the tangent plane that count for nothing (default 30)");
	rows.back().word = [](const S& s)
	{
		const bool published = s.rival.angle_bias_deg == R{}.angle_bias_deg;
		return published ? std::string() : "bias-" + numberText(s.rival.angle_bias_deg);
	};
	add(kOfSpiral, whole, "--sao-samples", 1, 256, "", member<&S::rival, &R::spiral_samples>(),
		"sao: samples of the spiral (default 11)");
	add(kOfSpiral, whole, "--sao-turns", 1, 256, "", member<&S::rival, &R::spiral_turns>(), "sao: turns of the spiral (default 7)");
	add(kOfSpiral, number, "--sao-intensity", 1e-6, 1e6, "", member<&S::rival, &R::intensity>(),
		"sao: factor of the obscurance, with lengths in units of the radius (default 1)");
	add(kOfSpiral, number, "--sao-bias", 0.0, 1.0, "radii", member<&S::rival, &R::bias>(),
		"sao: height over the tangent plane that counts for nothing, in radii (default 0.012)");
	add(kOfSpiral, number, "--sao-epsilon", 1e-12, 1e6, "radii²", member<&S::rival, &R::epsilon>(),
		"sao: keeps the quotient finite, in squares of the radius (default 0.01)");
	add(kOfSpiral, whole, "--sao-levels", 0, 8, "", member<&S::rival, &R::levels>(),
		"sao: coarser depths for samples that are far away (default 5)");
	add(kOfGtao, whole, "--gtao-slices", 1, 16, "", member<&S::rival, &R::gtao_slices>(),
		"gtao: planes through the view ray (default 3)");
	add(kOfGtao, whole, "--gtao-steps", 1, 32, "", member<&S::rival, &R::gtao_steps>(),
		"gtao: depths on either side of each (default 6)");
	add(kOfGtao, number, "--gtao-falloff", 0.0, 0.99, "radii", member<&S::rival, &R::gtao_falloff>(),
		"gtao: radii from which on horizons fade to the tangent (default 0.385)");
	add(kOfGtao, number, "--gtao-thickness", 0.0, 1.0, "", member<&S::rival, &R::gtao_thickness>(),
		"gtao: share of the way down that a step below the horizon brings it (default 0.01)");
	add(kOfBitmask, whole, "--bitmask-slices", 1, 16, "", member<&S::rival, &R::bitmask_slices>(),
		"bitmask: planes through the view ray (default 3)");
	add(kOfBitmask, whole, "--bitmask-steps", 1, 32, "", member<&S::rival, &R::bitmask_steps>(),
		"bitmask: depths on either side of each (default 6)");
	add(kOfBitmask, number, "--bitmask-thickness", 1e-3, 1e3, "radii", member<&S::rival, &R::bitmask_thickness>(),
		"bitmask: how thick surfaces are (default 0.25)");
	rows.push_back({.option = "--bitmask-hit",
					.kind = FeatureKind::choice,
					.places = kInShade,
					.features = kOfBitmask,
					.choices = {"half", "whole", "touched"},
					.value = member<&S::rival, &R::bitmask_hit>(),
					.help =
						"bitmask: how much of a sector a surface covers before that counts as covered: half of it (default), all "
						"of it, or any part"});
}

// Of every method.
void addShape(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	const auto number = [&rows](std::string_view option, FeatureValue value, std::string_view help)
	{
		rows.push_back({.option = option,
						.kind = FeatureKind::number,
						.least = 1e-3,
						.most = 1e3,
						.value = value,
						.help = help,
						.setting = option.substr(2)});
	};
	number("--strength", member<&S::strength>(), "Factor of the obscurance, after the method and its filter (default 1)");
	number("--power", member<&S::power>(), "Power of visibility, after the strength (default 1)");
}

void addFilters(std::vector<FeatureRow>& rows)
{
	using S = ShadeSettings;
	rows.push_back({.option = "--filter",
					.kind = FeatureKind::choice,
					.choices = {"none", "bilateral", "window"},
					.value = member<&S::filter>(),
					.help = "What takes the noise out, staying on each pixel's surface: none (default in nook emit); bilateral, "
							"two passes along x and y "
							"(nookBilateralX, nookBilateralY); or window, one pass over the window of the tile (nookWindow)"});
	rows.push_back({.option = "--taps",
					.kind = FeatureKind::whole,
					.least = 5.0,
					.most = 13.0,
					.value = member<&S::filter_taps>(),
					.help = "Bilateral: of each pass, an odd number (default 5)",
					.stated = true,
					.applies = [](const S& s)
					{
						return s.filter == ShadeFilter::bilateral;
					}});
	rows.push_back({.option = "--resolution",
					.kind = FeatureKind::choice,
					.places = kInEmit,
					.choices = {"full", "half"},
					.value = member<&S::half_resolution>(),
					.help =
						"full (default), or half: method and filter for every second pixel of both axes, and a pass that makes the "
						"whole picture of them",
					.word = [](const S& s)
					{
						return std::string(s.half_resolution ? "half" : "");
					}});
}

} // namespace

std::vector<FeatureRow> featureRows()
{
	std::vector<FeatureRow> rows;
	addVolume(rows);
	addIntensity(rows);
	addBands(rows);
	addTables(rows);
	addSlices(rows);
	addRivals(rows);
	addShape(rows);
	addFilters(rows);
	return rows;
}

} // namespace nook
