// SPDX-License-Identifier: GPL-3.0-or-later
// Papers' own recipes, and nook's forms of the same methods.
#include "methods/candidate_axes.h"

#include <array>

namespace nook
{

template <> std::span<const std::string_view> namesOf<Origin>()
{
	static constexpr std::array<std::string_view, 3> kNames{"paper", "ours", "rays"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<SampleSource>()
{
	static constexpr std::array<std::string_view, 6> kNames{"own", "electro", "uniform", "refined", "tile", "spiral"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<GridSize>()
{
	static constexpr std::array<std::string_view, 3> kNames{"quick", "normal", "full"};
	return kNames;
}

namespace
{

constexpr FilterChoice kNone{ShadeFilter::none, 5};
constexpr FilterChoice kWindow{ShadeFilter::window, 5};
constexpr FilterChoice kFive{ShadeFilter::bilateral, 5};
constexpr FilterChoice kNine{ShadeFilter::bilateral, 9};
constexpr FilterChoice kThirteen{ShadeFilter::bilateral, 13};

// The list for a size.
template <class Item>
std::vector<Item> upTo(GridSize size, const std::vector<Item>& quick, const std::vector<Item>& normal,
					   const std::vector<Item>& full)
{
	return size == GridSize::quick ? quick : size == GridSize::normal ? normal : full;
}

const std::vector<bool> kBothResolutions{false, true};
const std::vector<double> kThin{0.0, 0.5}; // VO §4.3

// VO §4.6: 4 × 4 pixels share a random texture, an edge-aware blur.
CandidateAxes paperOfVolume(GridSize size, const std::vector<int>& counts)
{
	CandidateAxes axes;
	axes.origin = Origin::paper;
	axes.counts = counts;
	axes.sources = {SampleSource::electro};
	axes.filters = upTo<FilterChoice>(size, {kWindow}, {kWindow, kThirteen}, {kNone, kWindow, kThirteen});
	return axes;
}

CandidateAxes ours(GridSize size, const std::vector<int>& counts)
{
	CandidateAxes axes;
	axes.counts = counts;
	axes.sources =
		upTo<SampleSource>(size, {SampleSource::tile}, {SampleSource::tile}, {SampleSource::tile, SampleSource::refined});
	axes.filters = upTo<FilterChoice>(size, {kFive}, {kFive, kWindow}, {kNone, kFive, kNine, kWindow});
	return axes;
}

// By the recipe `rays`: of volumetric obscurance three radii, so many samples at each.
CandidateAxes fitted(GridSize size, SampleSource source, const std::vector<int>& counts)
{
	CandidateAxes axes;
	axes.counts = counts;
	axes.sources = {source};
	axes.filters = upTo<FilterChoice>(size, {kFive}, {kFive, kWindow}, {kNone, kFive, kNine, kWindow});
	axes.half = kBothResolutions;
	axes.rays = {true};
	return axes;
}

// docs/reference/comparison.md; raw, and with what is fitted to rays as ours is.
CandidateAxes rival(SampleSource source, const FilterChoice& filter, const std::vector<int>& counts)
{
	CandidateAxes axes;
	axes.origin = Origin::paper;
	axes.counts = counts;
	axes.sources = {source};
	axes.filters = {filter};
	axes.rays = {false, true};
	return axes;
}

} // namespace

std::vector<CandidateAxes> axesOfLines(GridSize size)
{
	CandidateAxes paper = paperOfVolume(size, upTo<int>(size, {5, 9, 16}, {5, 9, 16, 33}, {5, 7, 9, 13, 16, 33}));
	paper.thickness = kThin;
	CandidateAxes own = ours(size, upTo<int>(size, {5, 9, 16}, {3, 5, 7, 9, 12, 16}, {2, 3, 4, 5, 7, 9, 12, 16}));
	own.thickness = kThin;
	own.half = kBothResolutions;
	return {paper, own, fitted(size, SampleSource::tile, upTo<int>(size, {3, 5}, {2, 3, 4, 5, 7}, {2, 3, 4, 5, 7, 9}))};
}

std::vector<CandidateAxes> axesOfPoints(GridSize size)
{
	CandidateAxes paper = paperOfVolume(size, upTo<int>(size, {6, 12, 33}, {6, 12, 33}, {6, 12, 33, 64}));
	paper.thickness = kThin;
	CandidateAxes own = ours(size, upTo<int>(size, {6, 12}, {6, 9, 12, 16}, {4, 6, 9, 12, 16}));
	own.thickness = kThin;
	own.half = upTo<bool>(size, {false}, kBothResolutions, kBothResolutions);
	return {paper, own, fitted(size, SampleSource::tile, upTo<int>(size, {6}, {6, 9}, {4, 6, 9, 12}))};
}

std::vector<CandidateAxes> axesOfAreas(GridSize size)
{
	CandidateAxes own = ours(size, upTo<int>(size, {5}, {3, 5, 9}, {3, 5, 9, 16}));
	own.half = upTo<bool>(size, {false}, kBothResolutions, kBothResolutions);
	return {paperOfVolume(size, upTo<int>(size, {5}, {5, 9}, {5, 9, 16})), own,
			fitted(size, SampleSource::tile, upTo<int>(size, {3}, {3, 5}, {3, 5, 9}))};
}

// ALC §3: random samples on the disk, two passes of 13 taps.
std::vector<CandidateAxes> axesOfAlchemy(GridSize size)
{
	CandidateAxes paper;
	paper.origin = Origin::paper;
	paper.counts = upTo<int>(size, {4, 12}, {4, 8, 12, 24}, {4, 8, 12, 24});
	paper.sources = {SampleSource::uniform};
	paper.filters = upTo<FilterChoice>(size, {kThirteen}, {kThirteen}, {kNone, kThirteen});
	CandidateAxes own = ours(size, upTo<int>(size, {4, 12}, {3, 4, 6, 9, 12, 16}, {3, 4, 6, 9, 12, 16}));
	own.half = kBothResolutions;
	return {paper, own, fitted(size, SampleSource::tile, upTo<int>(size, {4, 12}, {4, 6, 9, 12}, {3, 4, 6, 9, 12, 16}))};
}

namespace
{

// Adaptive layers with tables of whole, half and quarter pictures, four quadrants; no filter.
CandidateAxes layers(Origin origin, const std::vector<int>& counts, const std::vector<int>& cells,
					 const std::vector<bool>& quadrants)
{
	CandidateAxes axes;
	axes.origin = origin;
	axes.counts = counts;
	axes.forms.clear();
	for (const int cell_px : cells)
	{
		for (const bool four : quadrants)
		{
			ShadeSettings form;
			form.statvo.cell_px = cell_px;
			form.statvo.quadrants = four;
			form.statvo.skip = origin == Origin::ours;
			axes.forms.push_back(form);
		}
	}
	return axes;
}

} // namespace

// SVO: 1, 2 or 4 layers. Ours skip layers; of one there is none to skip.
std::vector<CandidateAxes> axesOfLayers(GridSize size)
{
	std::vector<CandidateAxes> all;
	if (size == GridSize::quick)
	{
		for (const Origin origin : {Origin::paper, Origin::ours})
		{
			all.push_back(layers(origin, {2}, {2}, {false}));
			all.push_back(layers(origin, {4}, {1, 2}, {false}));
		}
		return all;
	}
	const std::vector<int> cells{1, 2, 4};
	const std::vector<bool> quadrants{false, true};
	all.push_back(layers(Origin::paper, {1}, cells, quadrants));
	all.back().only_form = true;
	all.push_back(layers(Origin::paper, {2, 4}, cells, quadrants));
	all.push_back(layers(Origin::ours, {2, 4}, cells, quadrants));
	return all;
}

namespace
{

CandidateAxes slices(GridSize size, const std::vector<int>& counts, const std::vector<int>& steps)
{
	CandidateAxes axes;
	axes.counts = counts;
	axes.filters = upTo<FilterChoice>(size, {kFive}, {kFive, kWindow}, {kNone, kFive, kNine, kWindow});
	axes.half = kBothResolutions;
	axes.forms.clear();
	for (const int a_side : steps)
	{
		ShadeSettings form;
		form.slices.steps = a_side;
		axes.forms.push_back(form);
	}
	axes.rays = {false, true};
	return axes;
}

} // namespace

// Eight depths a pixel, up to 36.
std::vector<CandidateAxes> axesOfSlices(GridSize size)
{
	if (size == GridSize::quick)
	{
		return {slices(size, {1}, {4}), slices(size, {3}, {6})};
	}
	return {slices(size, upTo<int>(size, {}, {1, 2, 3}, {1, 2, 3}), upTo<int>(size, {}, {4, 6}, {3, 4, 6}))};
}

std::vector<CandidateAxes> axesOfCrytek(GridSize size)
{
	return {rival(SampleSource::own, kWindow, upTo<int>(size, {16}, {8, 16, 32}, {8, 16, 32, 64}))};
}

std::vector<CandidateAxes> axesOfVolumetric(GridSize size)
{
	return {rival(SampleSource::electro, kWindow, upTo<int>(size, {9}, {4, 9, 16}, {4, 9, 16, 32}))};
}

std::vector<CandidateAxes> axesOfHorizon(GridSize size)
{
	const std::vector<int> counts = upTo<int>(size, {6}, {4, 6, 8}, {4, 6, 8, 16});
	CandidateAxes biased = rival(SampleSource::own, kThirteen, counts);
	biased.forms.front().rival.angle_bias_deg = 10.0; // as shipped; the recipe has its own
	biased.rays = {false};
	return {rival(SampleSource::own, kThirteen, counts), biased};
}

std::vector<CandidateAxes> axesOfSpiral(GridSize size)
{
	return {rival(SampleSource::own, kFive, upTo<int>(size, {11}, {6, 11, 24}, {6, 11, 24, 48}))};
}

std::vector<CandidateAxes> axesOfGtao(GridSize size)
{
	return {rival(SampleSource::own, kFive, upTo<int>(size, {3}, {1, 3}, {1, 2, 3}))};
}

std::vector<CandidateAxes> axesOfBitmask(GridSize size)
{
	return {rival(SampleSource::own, kFive, upTo<int>(size, {3}, {1, 3}, {1, 2, 3}))};
}

} // namespace nook
