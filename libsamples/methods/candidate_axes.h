// SPDX-License-Identifier: GPL-3.0-or-later
// Variants of a method to compare: counts, samples, filters, features and resolutions, in all combinations.
#pragma once

#include "methods/settings.h"

#include <string_view>
#include <vector>

namespace nook
{

// Origin of a candidate's form of a method.
enum class Origin
{
	paper, // as published by the paper that proposes the method, or a published method that such papers compare with
	ours,  // nook's patterns and tiles, with matching filters and resolutions, and merged, dropped and fitted volumes
	rays,
};
template <> inline constexpr std::array<std::string_view, 3> kNamesOf<Origin>{"paper", "ours", "rays"};

// Where the samples of a screen-space method come from.
enum class SampleSource
{
	own,     // the method's own
	electro, // VO §4.5: repulsion, equal weights, one pattern reflected at random in 4 × 4 pixels (§4.6)
	uniform, // ALC §3: independent, uniform on the disk; a different set for each of 4 × 4 pixels
	refined, // nook's pattern, reflected at random in 4 × 4 pixels
	tile,    // nook's pattern, with jointly optimised variants for 4 × 4 pixels; at most kMaxTileCount samples
	spiral,  // golden-angle spiral, the same for all pixels: for definitions
};
template <>
inline constexpr std::array<std::string_view, 6> kNamesOf<SampleSource>{"own", "electro", "uniform", "refined", "tile", "spiral"};
inline constexpr int kMaxTileCount = 16;

enum class GridSize
{
	quick,  // 84: enough for a first look, with all methods
	normal, // 337
	full,   // 1054: all products of counts, sources, filters, resolutions and features
};
template <> inline constexpr std::array<std::string_view, 3> kNamesOf<GridSize>{"quick", "normal", "full"};

struct FilterChoice
{
	ShadeFilter filter = ShadeFilter::none;
	int taps = 5;
};

// Expanded to all combinations, the last axis fastest.
struct CandidateAxes
{
	Origin origin = Origin::ours;
	std::vector<int> counts;
	std::vector<SampleSource> sources{SampleSource::own};
	std::vector<FilterChoice> filters{FilterChoice{}};
	std::vector<double> thickness{0.0}; // in radii
	std::vector<bool> half{false};
	std::vector<bool> rays{false};                     // use the recipe fitted to rays, including its thickness
	std::vector<ShadeSettings> forms{ShadeSettings{}}; // further features; the method's count and the axes above are set in them
	bool only_form = false;                            // a paper's form of which nook has no other
};

constexpr FilterChoice kNoFilter{ShadeFilter::none, 5};
constexpr FilterChoice kWindow{ShadeFilter::window, 5};
constexpr FilterChoice kFive{ShadeFilter::bilateral, 5};
constexpr FilterChoice kNine{ShadeFilter::bilateral, 9};
constexpr FilterChoice kThirteen{ShadeFilter::bilateral, 13};

inline const std::vector<bool> kBothResolutions{false, true};

// Selects the list for a size.
template <class Item>
std::vector<Item> upTo(GridSize size, const std::vector<Item>& quick, const std::vector<Item>& normal,
					   const std::vector<Item>& full)
{
	return size == GridSize::quick ? quick : size == GridSize::normal ? normal : full;
}

} // namespace nook
