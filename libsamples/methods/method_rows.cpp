// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of the methods that nook emits, and what is tried of each where methods are compared. StatVO is in statvo.cpp.
#include "methods/feature_parts.h"
#include "methods/method_table.h"

namespace nook
{
namespace
{

using namespace feature_parts;
using shade_kernels::Kernels;

// The filters of those two.
std::vector<FilterChoice> filtersFor(GridSize size)
{
	return upTo<FilterChoice>(size, {kFive}, {kFive, kWindow}, {kNoFilter, kFive, kNine, kWindow});
}

// nook's form of a method: its patterns, a variant for each of 4 × 4 pixels.
CandidateAxes oursAxes(GridSize size, const std::vector<int>& counts)
{
	CandidateAxes axes{.counts = counts};
	axes.sources =
		upTo<SampleSource>(size, {SampleSource::tile}, {SampleSource::tile}, {SampleSource::tile, SampleSource::refined});
	axes.filters = filtersFor(size);
	return axes;
}

// By the recipe `rays`, which has three radii for volumetric obscurance, with so many samples at each.
CandidateAxes fittedAxes(GridSize size, const std::vector<int>& counts)
{
	CandidateAxes axes{
		.counts = counts, .sources = {SampleSource::tile}, .filters = filtersFor(size), .half = kBothResolutions, .rays = {true}};
	return axes;
}

// Volumetric obscurance.

const std::vector<double> kThin{0.0, 0.5}; // VO §4.3

// VO §4.6: 4 × 4 pixels share a random texture, an edge-aware blur.
CandidateAxes paperOfVolume(GridSize size, const std::vector<int>& counts)
{
	CandidateAxes axes;
	axes.origin = Origin::paper;
	axes.counts = counts;
	axes.sources = {SampleSource::electro};
	axes.filters = upTo<FilterChoice>(size, {kWindow}, {kWindow, kThirteen}, {kNoFilter, kWindow, kThirteen});
	return axes;
}

std::vector<CandidateAxes> axesOfLines(GridSize size)
{
	CandidateAxes paper = paperOfVolume(size, upTo<int>(size, {5, 9, 16}, {5, 9, 16, 33}, {5, 7, 9, 13, 16, 33}));
	paper.thickness = kThin;
	CandidateAxes own = oursAxes(size, upTo<int>(size, {5, 9, 16}, {3, 5, 7, 9, 12, 16}, {2, 3, 4, 5, 7, 9, 12, 16}));
	own.thickness = kThin;
	own.half = kBothResolutions;
	return {paper, own, fittedAxes(size, upTo<int>(size, {3, 5}, {2, 3, 4, 5, 7}, {2, 3, 4, 5, 7, 9}))};
}

std::vector<CandidateAxes> axesOfPoints(GridSize size)
{
	CandidateAxes paper = paperOfVolume(size, upTo<int>(size, {6, 12, 33}, {6, 12, 33}, {6, 12, 33, 64}));
	paper.thickness = kThin;
	CandidateAxes own = oursAxes(size, upTo<int>(size, {6, 12}, {6, 9, 12, 16}, {4, 6, 9, 12, 16}));
	own.thickness = kThin;
	own.half = upTo<bool>(size, {false}, kBothResolutions, kBothResolutions);
	return {paper, own, fittedAxes(size, upTo<int>(size, {6}, {6, 9}, {4, 6, 9, 12}))};
}

std::vector<CandidateAxes> axesOfAreas(GridSize size)
{
	CandidateAxes own = oursAxes(size, upTo<int>(size, {5}, {3, 5, 9}, {3, 5, 9, 16}));
	own.half = upTo<bool>(size, {false}, kBothResolutions, kBothResolutions);
	return {paperOfVolume(size, upTo<int>(size, {5}, {5, 9}, {5, 9, 16})), own,
			fittedAxes(size, upTo<int>(size, {3}, {3, 5}, {3, 5, 9}))};
}

template <int extent> void fillExtent(ShadeBlock& block, const ShadeSettings& /*settings*/)
{
	block.extent = extent;
}

int volumeDepths(const ShadeSettings& settings)
{
	return 1 + (settings.volume.radii != TwoRadii::none ? 1 : 0) + (settings.volume.third_radius_m > 0.0 ? 1 : 0);
}

ShadeKernel voSamples()
{
	return {"samples", "nookDebugSamplesVo", &Kernels::nookDebugSamplesVo};
}

// Alchemy.

// ALC §3: random samples on the disk, two passes of 13 taps.
std::vector<CandidateAxes> axesOfAlchemy(GridSize size)
{
	CandidateAxes paper;
	paper.origin = Origin::paper;
	paper.counts = upTo<int>(size, {4, 12}, {4, 8, 12, 24}, {4, 8, 12, 24});
	paper.sources = {SampleSource::uniform};
	paper.filters = upTo<FilterChoice>(size, {kThirteen}, {kThirteen}, {kNoFilter, kThirteen});
	CandidateAxes own = oursAxes(size, upTo<int>(size, {4, 12}, {3, 4, 6, 9, 12, 16}, {3, 4, 6, 9, 12, 16}));
	own.half = kBothResolutions;
	return {paper, own, fittedAxes(size, upTo<int>(size, {4, 12}, {4, 6, 9, 12}, {3, 4, 6, 9, 12, 16}))};
}

// Slices.

CandidateAxes slices(GridSize size, const std::vector<int>& counts, const std::vector<int>& steps)
{
	CandidateAxes axes{.counts = counts, .filters = filtersFor(size), .half = kBothResolutions};
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

// Eight depths per pixel, up to 36.
std::vector<CandidateAxes> axesOfSlices(GridSize size)
{
	if (size == GridSize::quick)
	{
		return {slices(size, {1}, {4}), slices(size, {3}, {6})};
	}
	return {slices(size, upTo<int>(size, {}, {1, 2, 3}, {1, 2, 3}), upTo<int>(size, {}, {4, 6}, {3, 4, 6}))};
}

std::vector<FeatureRow> sliceOptions()
{
	using P = SliceSettings;
	std::vector<FeatureRow> rows;
	FeatureRow& slices = addWhole(rows, 0, "--slices", 1, 16, member<&S::slices, &P::count>(),
								  "Slices: planes through the view ray, 1 (default) to 16");
	slices.places = kInShade | kInEmit;
	slices.stated = true;
	FeatureRow& steps = addWhole(rows, 0, "--slice-steps", 1, 32, member<&S::slices, &P::steps>(),
								 "Slices: depths on either side of each, 1 to 32 (default 4)");
	steps.places = kInShade | kInEmit;
	steps.stated = true;
	steps.word = [](const S& s)
	{
		return "steps-" + std::to_string(s.slices.steps);
	};
	addNumber(rows, 0, "--slice-thickness", 1e-3, 1e3, "radii", member<&S::slices, &P::thickness>(),
			  "Slices: thickness of surfaces at the reach, near ones down to 1/32 of it; light comes from "
			  "behind (default 0.65)")
		.setting = "slice_thickness";
	FeatureRow& bent = addFlag(rows, 0, "--bent", member<&S::slices, &P::bent>(),
							   "Slices: also bent normals, the mean open directions; with --filter bilateral or none");
	bent.conflict = "--resolution";
	bent.word = wordIf<"bent", &S::slices, &P::bent>;
	return rows;
}

// Slices without a tile have a window of 4 × 4 pixels and a count; the kernel computes azimuths and jitters from the position in
// the window (nookSliceVariant) and reads no values.
ShadeSamples sliceSamples(const ShadeSettings& settings)
{
	const auto count = static_cast<std::size_t>(settings.slices.count);
	return {4, settings.slices.count, std::vector<glm::vec4>(16 * count, glm::vec4(0.0F))};
}

int setBestSlices(ShadeSettings& settings)
{
	settings.slices.count = 16;
	settings.slices.steps = 32;
	return settings.slices.count;
}

void fillSlices(ShadeBlock& block, const ShadeSettings& settings)
{
	block.steps = settings.slices.steps;
	block.bent = settings.slices.bent ? 1 : 0;
}

} // namespace

std::vector<MethodRow> volumetricRows()
{
	return {
		{.name = "vo-line",
		 .what = "volumetric obscurance by lines",
		 .page = "vo.md",
		 .emitted = true,
		 .features = kOfNormals | kOfVolume | kOfPairs | kOfBands,
		 .radius_ratio = kVolumetricRatio,
		 .axes = axesOfLines,
		 .domain = Domain::disk,
		 .third = SampleThird::half_length,
		 .kernel = {"vo-line", "nookVoLine", &Kernels::nookVoLine},
		 .sample_depths = volumeDepths,
		 .tile_binding = 3,
		 .samples_view = voSamples()},
		{.name = "vo-point",
		 .what = "volumetric obscurance by points",
		 .page = "vo.md",
		 .emitted = true,
		 .features = kOfNormals | kOfVolume | kOfBands,
		 .radius_ratio = kVolumetricRatio,
		 .axes = axesOfPoints,
		 .domain = Domain::ball,
		 .kernel = {"vo-point", "nookVoPoint", &Kernels::nookVoPoint},
		 .sample_depths = volumeDepths,
		 .tile_binding = 4,
		 .fill = fillExtent<1>,
		 .samples_view = voSamples()},
		{.name = "vo-area",
		 .what = "volumetric obscurance by areas",
		 .page = "vo.md",
		 .emitted = true,
		 .features = kOfNormals | kOfVolume | kOfPairs | kOfBands,
		 .radius_ratio = kVolumetricRatio,
		 .axes = axesOfAreas,
		 .domain = Domain::disk,
		 .third = SampleThird::log2_side,
		 .kernel = {"vo-area", "nookVoArea", &Kernels::nookVoArea},
		 .sample_depths = volumeDepths,
		 .tile_binding = 10,
		 .moments = true,
		 .fill = fillExtent<2>,
		 .samples_view = voSamples(),
		 .lod_view = {"lod", "nookDebugLodArea", &Kernels::nookDebugLodArea}},
	};
}

std::vector<MethodRow> alchemyRows()
{
	return {
		{.name = "alchemy",
		 .what = "Alchemy ambient obscurance",
		 .page = "alchemy.md",
		 .emitted = true,
		 .needs_normals = true,
		 .features = kOfIntensity | kOfBands,
		 .axes = axesOfAlchemy,
		 .domain = Domain::hemisphere,
		 .kernel = {"alchemy", "nookAlchemy", &Kernels::nookAlchemy},
		 .tile_binding = 5,
		 .levels = [](const ShadeSettings& settings) { return settings.depth_levels; },
		 .samples_view = {"samples", "nookDebugSamplesAlchemy", &Kernels::nookDebugSamplesAlchemy},
		 .lod_view = {"lod", "nookDebugLodAlchemy", &Kernels::nookDebugLodAlchemy}},
	};
}

std::vector<MethodRow> sliceRows()
{
	return {
		{.name = "slices",
		 .what = "slices with bit masks",
		 .page = "slices.md",
		 .emitted = true,
		 .needs_normals = true,
		 .options = sliceOptions(),
		 .axes = axesOfSlices,
		 .tile_domain = Domain::slice,
		 .own_samples = sliceSamples,
		 .set_count = [](ShadeSettings& settings, int count) { settings.slices.count = count; },
		 .set_best = setBestSlices,
		 .kernel = {"slices", "nookSlices", &Kernels::nookSlices},
		 .bent_kernel = {"slices", "nookSlicesBent", &Kernels::nookSlicesBent},
		 .open_kernel = {"slices", "nookSlicesOpen", &Kernels::nookSlicesOpen},
		 .sample_depths = [](const ShadeSettings& settings) { return 2 * settings.slices.steps; },
		 .tile_binding = 12,
		 .fill = fillSlices,
		 .samples_view = allSamples()},
	};
}

// Volumes; masks are another way to draw them.
std::vector<MethodRow> volumeRows()
{
	return {
		{.kind = MethodKind::volumes,
		 .name = "aov",
		 .what = "ambient occlusion volumes",
		 .page = "aov.md",
		 .emitted = true,
		 .needs_normals = true},
		{.kind = MethodKind::volumes,
		 .name = "aov-mask",
		 .what = "ambient occlusion volumes by masks of directions",
		 .page = "aov.md",
		 .emitted = true,
		 .needs_normals = true,
		 .masks = true},
	};
}

} // namespace nook
