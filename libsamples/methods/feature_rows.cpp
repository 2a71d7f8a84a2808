// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the table of features, a function a group of methods.
#include "methods/feature_rows.h"

#include "methods/feature_parts.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

using namespace feature_parts;

void addIntensity(std::vector<FeatureRow>& rows)
{
	const auto number = [&rows](std::string_view option, double least, double most, std::string_view unit, FeatureValue value,
								std::string_view help)
	{
		addNumber(rows, kOfIntensity, option, least, most, unit, value, help).setting = option.substr(2);
	};
	number("--sigma", 0.0, 1e6, "", member<&S::sigma>(), "Alchemy: intensity, with lengths in units of the radius (default 1)");
	number("--contrast", 1e-3, 1e3, "", member<&S::contrast>(), "Alchemy: the power at the end (default 1)");
	number("--beta", 0.0, 1.0, "share of the depth", member<&S::beta>(), "Alchemy: bias, a share of the depth (default 1e-4)");
	number("--epsilon", 1e-12, 1e6, "radii²", member<&S::epsilon>(),
		   "Alchemy: keeps the quotient finite, in squares of the radius (default 1e-4)");
	addFlag(rows, kOfIntensity, "--cut", member<&S::cut>(), "Alchemy: leaves out what is further away than the radius").word =
		wordIf<"cut", &S::cut>;
	FeatureRow& levels =
		addWhole(rows, kOfIntensity, "--depth-levels", 0, 8, member<&S::depth_levels>(),
				 "Alchemy: coarser depths for samples 16 pixels away and more, one more with every doubling (default 0: none)");
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
				  "Alchemy: bits of a component of the normals; what rounding may turn them by does not occlude (default: 32)");
	normals.places = kInShade;
	normals.unit = "bits";
}

void addBands(std::vector<FeatureRow>& rows)
{
	using B = BandSettings;
	FeatureRow& bands =
		addWhole(rows, kOfBands, "--bands", 1, 3, member<&S::bands, &B::count>(),
				 "Fewer samples where the radius is small in the picture: the first half, or third and two thirds, of a "
				 "pattern made with --order progressive (default 1: all samples everywhere)");
	bands.places = kInShade | kInEmit;
	bands.conflict = "--paired";
	bands.setting = "first_band, second_band";
	bands.word = [](const S& s)
	{
		return std::string(s.bands.count > 1 ? "bands" : "");
	};
	addNumber(rows, kOfBands, "--band1-pixels", 0.5, 1e6, "px", member<&S::bands, &B::first_px>(),
			  "Of the bands: radius in pixels below which the first one is enough (default 16)");
	addNumber(rows, kOfBands, "--band2-pixels", 0.5, 1e6, "px", member<&S::bands, &B::second_px>(),
			  "Of three bands: radius in pixels below which the first two are enough (default 48)");
}

// Of every method.
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
			  "What takes the noise out, staying on each pixel's surface: none (default in nook emit); bilateral, "
			  "two passes along x and y "
			  "(nookBilateralX, nookBilateralY); or window, one pass over the window of the tile (nookWindow)");
	FeatureRow& taps =
		addWhole(rows, 0, "--taps", 5, 13, member<&S::filter_taps>(), "Bilateral: of each pass, an odd number (default 5)");
	taps.places = kInShade | kInEmit;
	taps.stated = true;
	taps.applies = [](const S& s)
	{
		return s.filter == ShadeFilter::bilateral;
	};
	FeatureRow& resolution =
		addChoice(rows, 0, "--resolution", {"full", "half"}, member<&S::half_resolution>(),
				  "full (default), or half: method and filter for every second pixel of both axes, and a pass that makes the "
				  "whole picture of them");
	resolution.places = kInEmit;
	resolution.word = wordIf<"half", &S::half_resolution>;
}

} // namespace

std::vector<FeatureRow> featureRows()
{
	std::vector<FeatureRow> rows;
	addVolumeRows(rows);
	addIntensity(rows);
	addBands(rows);
	addTableRows(rows);
	addRivalRows(rows);
	addShape(rows);
	addFilters(rows);
	return rows;
}

} // namespace nook
