// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of volumetric obscurance.
#include "methods/feature_parts.h"

namespace nook::feature_parts
{
namespace
{

using V = VoSettings;

void addThickness(std::vector<FeatureRow>& rows)
{
	addChoice(rows, kOfNormals, "--use-normal", kYesNo, yesNo<&S::use_normal>(),
			  "Volumetric obscurance, StatVO: above the tangent plane alone (default: yes); without, nothing reads normals, and an "
			  "open flat surface reads 1/2")
		.word = [](const S& s)
	{
		return std::string(s.use_normal ? "" : "no-normal");
	};
	FeatureRow& thickness = addNumber(rows, kOfVolume, "--thickness", 1e-6, 1e6, "m", member<&S::volume, &V::thickness_m>(),
									  "Volumetric obscurance: metres that surfaces are thick; open again behind (default: no end)");
	thickness.nothing = "no end";
	thickness.setting = "thickness";
	FeatureRow& thick = addFlag(rows, kOfVolume, "--thick",
								{[](const S& s) { return s.volume.thickness_m > 0.0 ? 1.0 : 0.0; },
								 [](S& s, double on)
								 {
									 s.volume.thickness_m = on;
								 }},
								"Volumetric obscurance: surfaces are thick, and open again behind");
	thick.places = kInEmit;
	thick.setting = "thickness, second_thickness, third_thickness";
	thick.word = wordIf<"thick", &S::volume, &V::thickness_m>;
}

void addSecondRadius(std::vector<FeatureRow>& rows)
{
	FeatureRow& radius = addNumber(rows, kOfVolume, "--radius2", 1e-6, 1e6, "m", member<&S::volume, &V::second_radius_m>(),
								   "Volumetric obscurance: a second radius in metres");
	radius.nothing = "none";
	radius.needs = "--combine";
	radius.setting = "second_radius";
	FeatureRow& combine = addChoice(rows, kOfVolume, "--combine", {"product", "minimum"},
									{[](const S& s) { return static_cast<double>(s.volume.radii) - 1.0; },
									 [](S& s, double i)
									 {
										 s.volume.radii = static_cast<TwoRadii>(i + 1.0);
									 }},
									"Of the visibilities of several radii: their product, or the least");
	combine.needs = "--radius2";
	combine.setting = "second_radius";
}

void addThirdRadius(std::vector<FeatureRow>& rows)
{
	const auto length = [&rows](std::string_view option, FeatureValue value, std::string_view help, std::string_view nothing,
								std::string_view base, std::string_view setting)
	{
		FeatureRow& row = addNumber(rows, kOfVolume, option, 1e-6, 1e6, "m", value, help);
		row.nothing = nothing;
		row.base = base;
		row.setting = setting;
	};
	length("--radius3", member<&S::volume, &V::third_radius_m>(), "Volumetric obscurance: a third radius in metres (default: none)",
		   "none", "--radius2", "third_radius");
	length("--thickness2", member<&S::volume, &V::second_thickness_m>(), "The same for the second radius (default: as --thickness)",
		   "as --thickness", "--thickness", "second_thickness");
	length("--thickness3", member<&S::volume, &V::third_thickness_m>(), "The same for the third radius (default: as --thickness)",
		   "as --thickness", "--thickness", "third_thickness");
	FeatureRow& third = addFlag(rows, kOfVolume, "--third-radius",
								{[](const S& s) { return s.volume.third_radius_m > 0.0 ? 1.0 : 0.0; },
								 [](S& s, double on)
								 {
									 s.volume.third_radius_m = on;
								 }},
								"Volumetric obscurance: a third radius, beside --combine");
	third.places = kInEmit;
	third.base = "--combine";
	third.setting = "third_radius";
	third.word = [](const S& s)
	{
		return std::string(s.volume.third_radius_m > 0.0 ? "three-radii" : s.volume.radii != TwoRadii::none ? "two-radii" : "");
	};
}

} // namespace

void addVolumeRows(std::vector<FeatureRow>& rows)
{
	addThickness(rows);
	addSecondRadius(rows);
	addThirdRadius(rows);
	addChoice(rows, kOfVolume, "--falloff", {"constant", "quadratic"}, member<&S::volume, &V::quadratic>(),
			  "Volumetric obscurance: matter counts alike in the whole ball (constant, default), or by 1 - (d / radius)^2")
		.word = wordIf<"quadratic", &S::volume, &V::quadratic>;
	addFlag(rows, kOfPairs, "--paired", member<&S::volume, &V::paired>(),
			"Lines and areas: where a surface is out of range, a sample is as open as the one at the opposite side "
			"(less halo); needs a pattern made with --symmetric")
		.word = wordIf<"paired", &S::volume, &V::paired>;
}

} // namespace nook::feature_parts
