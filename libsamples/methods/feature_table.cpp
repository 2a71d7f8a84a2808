// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/feature_table.h"

#include "core/decimal.h"
#include "core/lists.h"
#include "methods/feature_parts.h"
#include "methods/method_table.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace nook
{
namespace
{

using namespace feature_parts;

using V = VoSettings;

void addThickness(std::vector<FeatureRow>& rows)
{
	addChoice(rows, kOfNormals, "--use-normal", kYesNo, yesNo<&S::use_normal>(),
			  "Volumetric obscurance, StatVO: only above the tangent plane (default: yes); without, normals are not read, and an "
			  "open flat surface reads 1/2")
		.word = [](const S& s)
	{
		return std::string(s.use_normal ? "" : "no-normal");
	};
	FeatureRow& thickness =
		addNumber(rows, kOfVolume, "--thickness", 1e-6, 1e6, "m", member<&S::volume, &V::thickness_m>(),
				  "Volumetric obscurance: thickness of surfaces in metres; open again behind (default: no end)");
	thickness.nothing = "no end";
	thickness.setting = "thickness";
	FeatureRow& thick = addFlag(rows, kOfVolume, "--thick",
								{[](const S& s) { return s.volume.thickness_m > 0.0 ? 1.0 : 0.0; },
								 [](S& s, double on)
								 {
									 s.volume.thickness_m = on;
								 }},
								"Volumetric obscurance: surfaces have a thickness, and are open again behind");
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
									"How to combine the visibilities of several radii: product or minimum");
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
	length("--thickness2", member<&S::volume, &V::second_thickness_m>(),
		   "Thickness for the second radius (default: as --thickness)", "as --thickness", "--thickness", "second_thickness");
	length("--thickness3", member<&S::volume, &V::third_thickness_m>(), "Thickness for the third radius (default: as --thickness)",
		   "as --thickness", "--thickness", "third_thickness");
	FeatureRow& third = addFlag(rows, kOfVolume, "--third-radius",
								{[](const S& s) { return s.volume.third_radius_m > 0.0 ? 1.0 : 0.0; },
								 [](S& s, double on)
								 {
									 s.volume.third_radius_m = on;
								 }},
								"Volumetric obscurance: a third radius, with --combine");
	third.places = kInEmit;
	third.base = "--combine";
	third.setting = "third_radius";
	third.word = [](const S& s)
	{
		return std::string(s.volume.third_radius_m > 0.0 ? "three-radii" : s.volume.radii != TwoRadii::none ? "two-radii" : "");
	};
}

void addVolumeRows(std::vector<FeatureRow>& rows)
{
	addThickness(rows);
	addSecondRadius(rows);
	addThirdRadius(rows);
	addChoice(rows, kOfVolume, "--falloff", {"constant", "quadratic"}, member<&S::volume, &V::quadratic>(),
			  "Volumetric obscurance: weight of matter in the ball: constant (default), or 1 - (d / radius)^2")
		.word = wordIf<"quadratic", &S::volume, &V::quadratic>;
	addFlag(rows, kOfPairs, "--paired", member<&S::volume, &V::paired>(),
			"Lines and areas: if a surface is out of range, a sample takes the openness of the opposite one "
			"(less halo); needs a pattern made with --symmetric")
		.word = wordIf<"paired", &S::volume, &V::paired>;
}

void addIntensity(std::vector<FeatureRow>& rows)
{
	const auto number = [&rows](std::string_view option, double least, double most, std::string_view unit, FeatureValue value,
								std::string_view help)
	{
		addNumber(rows, kOfIntensity, option, least, most, unit, value, help).setting = option.substr(2);
	};
	number("--sigma", 0.0, 1e6, "", member<&S::sigma>(), "Alchemy: intensity, with lengths in units of the radius (default 1)");
	number("--contrast", 1e-3, 1e3, "", member<&S::contrast>(), "Alchemy: exponent of the result (default 1)");
	number("--beta", 0.0, 1.0, "share of the depth", member<&S::beta>(), "Alchemy: bias relative to the depth (default 1e-4)");
	number("--epsilon", 1e-12, 1e6, "radii²", member<&S::epsilon>(),
		   "Alchemy: keeps the quotient finite, in squared radii (default 1e-4)");
	addFlag(rows, kOfIntensity, "--cut", member<&S::cut>(), "Alchemy: ignores surfaces beyond the radius").word =
		wordIf<"cut", &S::cut>;
	FeatureRow& levels =
		addWhole(rows, kOfIntensity, "--depth-levels", 0, 8, member<&S::depth_levels>(),
				 "Alchemy: coarser depth levels for samples from 16 pixels away, one level per doubling (default 0: none)");
	levels.places = kInShade | kInEmit;
	levels.word = wordIf<"levels", &S::depth_levels>;
	constexpr static std::array<int, 4> kBits{8, 10, 16, 32};
	const auto bits = [](const S& s)
	{
		return static_cast<double>(std::find(kBits.begin(), kBits.end(), s.normal_bits) - kBits.begin());
	};
	const auto set_bits = [](S& s, double i)
	{
		s.normal_bits = kBits[static_cast<std::size_t>(i)];
	};
	FeatureRow& normals =
		addChoice(rows, kOfIntensity, "--normal-bits", {"8", "10", "16", "32"}, {bits, set_bits},
				  "Alchemy: bits per component of the normals; occlusion within their rounding is ignored (default: 32)");
	normals.places = kInShade;
	normals.unit = "bits";
}

void addBands(std::vector<FeatureRow>& rows)
{
	using B = BandSettings;
	FeatureRow& bands =
		addWhole(rows, kOfBands, "--bands", 1, 3, member<&S::bands, &B::count>(),
				 "Fewer samples if the radius is small in the picture: the first half, or the first third and two thirds, of a "
				 "pattern made with --order progressive (default 1: all samples everywhere)");
	bands.places = kInShade | kInEmit;
	bands.conflict = "--paired";
	bands.setting = "first_band, second_band";
	bands.word = [](const S& s)
	{
		return std::string(s.bands.count > 1 ? "bands" : "");
	};
	addNumber(rows, kOfBands, "--band1-pixels", 0.5, 1e6, "px", member<&S::bands, &B::first_px>(),
			  "Bands: radius in pixels below which the first band is enough (default 16)");
	addNumber(rows, kOfBands, "--band2-pixels", 0.5, 1e6, "px", member<&S::bands, &B::second_px>(),
			  "Three bands: radius in pixels below which the first two are enough (default 48)");
}

void addShape(std::vector<FeatureRow>& rows)
{
	const auto number = [&rows](std::string_view option, FeatureValue value, std::string_view help)
	{
		FeatureRow& row = addNumber(rows, 0, option, 1e-3, 1e3, "", value, help);
		row.places = kInShade | kInEmit;
		row.setting = option.substr(2);
	};
	number("--strength", member<&S::strength>(), "Factor of the obscurance, after the method and its filter (default 1)");
	number("--power", member<&S::power>(), "Power of visibility, after the strength (default 1)");
}

void addFilters(std::vector<FeatureRow>& rows)
{
	addChoice(rows, 0, "--filter", {"none", "bilateral", "window"}, member<&S::filter>(),
			  "Filter against noise that stays on each pixel's surface: none (default in nook emit); bilateral, "
			  "two passes along x and y "
			  "(nookBilateralX, nookBilateralY); or window, one pass over the window of the tile (nookWindow)");
	FeatureRow& taps = addWhole(rows, 0, "--taps", 5, 13, member<&S::filter_taps>(), "Bilateral: taps per pass, odd (default 5)");
	taps.places = kInShade | kInEmit;
	taps.stated = true;
	taps.applies = [](const S& s)
	{
		return s.filter == ShadeFilter::bilateral;
	};
	FeatureRow& resolution =
		addChoice(rows, 0, "--resolution", {"full", "half"}, member<&S::half_resolution>(),
				  "full (default), or half: method and filter for every second pixel on both axes, and a pass that upsamples "
				  "the result");
	resolution.places = kInEmit;
	resolution.word = wordIf<"half", &S::half_resolution>;
}

std::vector<FeatureRow> featureRows()
{
	std::vector<FeatureRow> rows;
	addVolumeRows(rows);
	addIntensity(rows);
	addBands(rows);
	for (const MethodRow& method : methodTable())
	{
		for (const FeatureRow& option : method.options)
		{
			rows.push_back(option);
			rows.back().method = method.name;
		}
	}
	addShape(rows);
	addFilters(rows);
	return rows;
}

} // namespace

std::span<const FeatureRow> featureTable()
{
	static const std::vector<FeatureRow> table = featureRows();
	return table;
}

const FeatureRow& featureOf(std::string_view option)
{
	const FeatureRow* const found = firstWhere(featureTable(), [option](const FeatureRow& row) { return row.option == option; });
	assert(found != nullptr);
	return *found;
}

bool takesFeature(const MethodRow& method, const FeatureRow& feature)
{
	return method.kind == MethodKind::screen && (isForAll(feature) || (method.features & feature.features) != 0 ||
												 (!feature.method.empty() && feature.method == method.name));
}

double ownValue(const ShadeSettings& settings, std::string_view option)
{
	return featureOf(option).value.get(settings);
}

bool isOn(const FeatureRow& feature, const ShadeSettings& settings)
{
	return feature.value.get(settings) != feature.value.get(ShadeSettings{});
}

std::string valueText(const FeatureRow& feature, const ShadeSettings& settings)
{
	const double value = feature.value.get(settings);
	switch (feature.kind)
	{
	case FeatureKind::flag: break;
	case FeatureKind::whole: return std::to_string(static_cast<int>(value));
	case FeatureKind::number: return numberText(value);
	case FeatureKind::choice: return value < 0.0 ? std::string() : std::string(feature.choices[static_cast<std::size_t>(value)]);
	}
	return {};
}

std::string emitOptions(const ShadeSettings& settings)
{
	const MethodRow& method = rowOf(settings.method);
	std::string text;
	for (const FeatureRow& feature : featureTable())
	{
		const bool here = (feature.places & kInEmit) != 0 && takesFeature(method, feature) &&
						  (feature.applies == nullptr || feature.applies(settings));
		if (here && (feature.stated || isOn(feature, settings)))
		{
			text += " " + std::string(feature.option);
			text += feature.kind == FeatureKind::flag ? "" : " " + valueText(feature, settings);
		}
	}
	return text;
}

std::string featureWords(const ShadeSettings& settings)
{
	const MethodRow& method = rowOf(settings.method);
	std::string text;
	for (const FeatureRow& feature : featureTable())
	{
		const std::string word = feature.word != nullptr && takesFeature(method, feature) ? feature.word(settings) : std::string();
		text += word.empty() ? "" : " " + word;
	}
	return text;
}

} // namespace nook
