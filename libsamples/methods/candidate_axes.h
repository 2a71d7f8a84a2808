// SPDX-License-Identifier: GPL-3.0-or-later
// What is tried of a method where methods are compared: counts, samples, filters, features and resolutions to multiply out.
#pragma once

#include "methods/settings.h"

#include <span>
#include <string_view>
#include <vector>

namespace nook
{

// Whose form of a method a candidate is.
enum class Origin
{
	paper, // as the paper that proposes the method has it, or a method that such papers compare with
	ours,  // patterns and tiles of nook, filters and resolutions chosen for them, volumes merged, dropped and fitted
	rays,
};
template <> std::span<const std::string_view> namesOf<Origin>();

// Where the samples of a screen-space method come from.
enum class SampleSource
{
	own,     // of the method itself
	electro, // VO §4.5: repulsion, equal weights, one pattern reflected at random in 4 × 4 pixels (§4.6)
	uniform, // ALC §3: independent, uniform on the disk; another set for each of 4 × 4 pixels
	refined, // nook's pattern, reflected at random in 4 × 4 pixels
	tile,    // nook's pattern, a variant of it for each of 4 × 4 pixels, made together; at most kMaxTileCount samples
	spiral,  // golden-angle spiral, the same for all pixels: for definitions
};
template <> std::span<const std::string_view> namesOf<SampleSource>();
inline constexpr int kMaxTileCount = 16;

enum class GridSize
{
	quick,  // 84: what a first look needs, all methods among them
	normal, // 337
	full,   // 1054: all products of counts, sources, filters, resolutions and features
};
template <> std::span<const std::string_view> namesOf<GridSize>();

struct FilterChoice
{
	ShadeFilter filter = ShadeFilter::none;
	int taps = 5;
};

// Multiplied out, the last one fastest.
struct CandidateAxes
{
	Origin origin = Origin::ours;
	std::vector<int> counts;
	std::vector<SampleSource> sources{SampleSource::own};
	std::vector<FilterChoice> filters{FilterChoice{}};
	std::vector<double> thickness{0.0}; // in radii
	std::vector<bool> half{false};
	std::vector<bool> rays{false};                     // by the recipe fitted to rays; thickness is the recipe's then
	std::vector<ShadeSettings> forms{ShadeSettings{}}; // features beside these; the method's count and the above are set in them
	bool only_form = false;                            // of a paper, and nook has no other form of it
};

// What a method's row names (method_table.h), in the order of their candidates.
std::vector<CandidateAxes> axesOfLines(GridSize size);
std::vector<CandidateAxes> axesOfPoints(GridSize size);
std::vector<CandidateAxes> axesOfAreas(GridSize size);
std::vector<CandidateAxes> axesOfAlchemy(GridSize size);
std::vector<CandidateAxes> axesOfLayers(GridSize size);
std::vector<CandidateAxes> axesOfSlices(GridSize size);
std::vector<CandidateAxes> axesOfCrytek(GridSize size);
std::vector<CandidateAxes> axesOfVolumetric(GridSize size);
std::vector<CandidateAxes> axesOfHorizon(GridSize size);
std::vector<CandidateAxes> axesOfSpiral(GridSize size);
std::vector<CandidateAxes> axesOfGtao(GridSize size);
std::vector<CandidateAxes> axesOfBitmask(GridSize size);

} // namespace nook
