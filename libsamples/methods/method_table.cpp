// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/method_table.h"

#include "methods/rival_parts.h"
#include "methods/statvo_passes.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <iterator>

namespace nook
{
namespace
{

using shade_kernels::Kernels;

constexpr double kVolumetricRatio = 1.1; // AOV §6: volumetric methods against rays with linear falloff

int alchemyLevels(const ShadeSettings& settings)
{
	return settings.depth_levels;
}

// None that a kernel reads without a tile: a variant is the place in a window of 4 × 4 pixels (nookSliceVariant).
ShadeSamples sliceSamples(const ShadeSettings& settings)
{
	const auto count = static_cast<std::size_t>(settings.slices.count);
	return {4, settings.slices.count, std::vector<glm::vec4>(16 * count, glm::vec4(0.0F))};
}

void setSlices(ShadeSettings& settings, int count)
{
	settings.slices.count = count;
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

// Depths that a kernel reads for a pixel: its own, and one a sample.
int volumeReads(const ShadeSettings& settings, int samples)
{
	const int radii = 1 + (settings.volume.radii != TwoRadii::none ? 1 : 0) + (settings.volume.third_radius_m > 0.0 ? 1 : 0);
	return 1 + radii * samples;
}

int sampleReads(const ShadeSettings& /*settings*/, int samples)
{
	return 1 + samples;
}

int sliceReads(const ShadeSettings& settings, int samples)
{
	return 1 + 2 * settings.slices.steps * samples;
}

int ownRead(const ShadeSettings& /*settings*/, int /*samples*/)
{
	return 1;
}

ShadeKernel allSamples()
{
	return {"samples", "nookDebugSamplesAll", &Kernels::nookDebugSamplesAll};
}

ShadeKernel voSamples()
{
	return {"samples", "nookDebugSamplesVo", &Kernels::nookDebugSamplesVo};
}

// Volumetric obscurance.
std::vector<MethodRow> volumetricRows()
{
	return {
		{.method = ShadeMethod::vo_line,
		 .name = "vo-line",
		 .what = "volumetric obscurance by lines",
		 .page = "vo.md",
		 .emitted = true,
		 .features = kOfNormals | kOfVolume | kOfPairs | kOfBands,
		 .radius_ratio = kVolumetricRatio,
		 .swept = true,
		 .shown_paper = 1,
		 .shown_ours = 2,
		 .axes = axesOfLines,
		 .domain = Domain::disk,
		 .third = SampleThird::half_length,
		 .kernel = {"vo-line", "nookVoLine", &Kernels::nookVoLine},
		 .depth_reads = volumeReads,
		 .tile_binding = 3,
		 .samples_view = voSamples()},
		{.method = ShadeMethod::vo_point,
		 .name = "vo-point",
		 .what = "volumetric obscurance by points",
		 .page = "vo.md",
		 .emitted = true,
		 .features = kOfNormals | kOfVolume | kOfBands,
		 .radius_ratio = kVolumetricRatio,
		 .swept = true,
		 .shown_paper = 5,
		 .axes = axesOfPoints,
		 .domain = Domain::ball,
		 .kernel = {"vo-point", "nookVoPoint", &Kernels::nookVoPoint},
		 .depth_reads = volumeReads,
		 .tile_binding = 4,
		 .samples_view = voSamples()},
		{.method = ShadeMethod::vo_area,
		 .name = "vo-area",
		 .what = "volumetric obscurance by areas",
		 .page = "vo.md",
		 .emitted = true,
		 .features = kOfNormals | kOfVolume | kOfPairs | kOfBands,
		 .radius_ratio = kVolumetricRatio,
		 .axes = axesOfAreas,
		 .domain = Domain::disk,
		 .third = SampleThird::log2_side,
		 .kernel = {"vo-area", "nookVoArea", &Kernels::nookVoArea},
		 .depth_reads = volumeReads,
		 .tile_binding = 10,
		 .moments = true,
		 .samples_view = voSamples(),
		 .lod_view = {"lod", "nookDebugLodArea", &Kernels::nookDebugLodArea}},
	};
}

std::vector<MethodRow> fittedRows()
{
	return {
		{.method = ShadeMethod::alchemy,
		 .name = "alchemy",
		 .what = "Alchemy ambient obscurance",
		 .page = "alchemy.md",
		 .emitted = true,
		 .needs_normals = true,
		 .features = kOfIntensity | kOfBands,
		 .swept = true,
		 .shown_paper = 3,
		 .shown_ours = 3,
		 .axes = axesOfAlchemy,
		 .domain = Domain::hemisphere,
		 .kernel = {"alchemy", "nookAlchemy", &Kernels::nookAlchemy},
		 .depth_reads = sampleReads,
		 .tile_binding = 5,
		 .levels = alchemyLevels,
		 .samples_view = {"samples", "nookDebugSamplesAlchemy", &Kernels::nookDebugSamplesAlchemy},
		 .lod_view = {"lod", "nookDebugLodAlchemy", &Kernels::nookDebugLodAlchemy},
		 .levels_option = "--depth-levels"},
		{.method = ShadeMethod::statvo,
		 .name = "statvo",
		 .what = "statistical volumetric obscurance",
		 .page = "statvo.md",
		 .emitted = true,
		 .features = kOfNormals | kOfLayers,
		 .radius_ratio = kVolumetricRatio,
		 .swept = true,
		 .swept_count = 4,
		 .shown_paper = 4,
		 .shown_ours = 5,
		 .axes = axesOfLayers,
		 .own_samples = noSamples,
		 .set_count = setLayers,
		 .layers_text = layersText,
		 .set_best = setBestLayers,
		 .kernel = {"statvo", "nookStatVo", &Kernels::nookStatVo},
		 .depth_reads = ownRead,
		 .add_passes = addStatVo,
		 .passes_text = statVoPassesText,
		 .fill = fillStatVo,
		 .layers_view = {"layers", "nookDebugLayers", &Kernels::nookDebugLayers}},
	};
}

std::vector<MethodRow> sliceRows()
{
	return {
		{.method = ShadeMethod::slices,
		 .name = "slices",
		 .what = "slices with bit masks",
		 .page = "slices.md",
		 .emitted = true,
		 .needs_normals = true,
		 .features = kOfSlices,
		 .swept = true,
		 .shown_ours = 6,
		 .axes = axesOfSlices,
		 .tile_domain = Domain::slice,
		 .own_samples = sliceSamples,
		 .set_count = setSlices,
		 .set_best = setBestSlices,
		 .kernel = {"slices", "nookSlices", &Kernels::nookSlices},
		 .bent_kernel = {"slices", "nookSlicesBent", &Kernels::nookSlicesBent},
		 .open_kernel = {"slices", "nookSlicesOpen", &Kernels::nookSlicesOpen},
		 .depth_reads = sliceReads,
		 .tile_binding = 12,
		 .fill = fillSlices,
		 .samples_view = allSamples()},
	};
}

// Methods to compare with.
std::vector<MethodRow> pointRivals()
{
	return {
		{.method = ShadeMethod::crytek,
		 .name = "crytek",
		 .what = "Crytek's points",
		 .page = "comparison.md",
		 .features = kOfRange,
		 .axes = axesOfCrytek,
		 .domain = Domain::ball,
		 .own_pattern = crytekPoints,
		 .default_count = 16,
		 .kernel = {"crytek", "nookCrytek", &Kernels::nookCrytek},
		 .fill = fillCrytek,
		 .samples_view = allSamples()},
		{.method = ShadeMethod::volumetric,
		 .name = "volumetric-ao",
		 .what = "volumetric ambient occlusion in the tangent sphere",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .radius_ratio = kVolumetricRatio,
		 .axes = axesOfVolumetric,
		 .domain = Domain::hemisphere,
		 .kernel = {"volumetric-ao", "nookVolumetric", &Kernels::nookVolumetric},
		 .samples_view = allSamples()},
		{.method = ShadeMethod::hbao,
		 .name = "hbao",
		 .what = "horizon-based ambient occlusion",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .features = kOfHorizon,
		 .swept = true,
		 .shown_paper = 6,
		 .axes = axesOfHorizon,
		 .own_samples = horizonSamples,
		 .set_count = setDirections,
		 .set_best = setBestHorizon,
		 .kernel = {"hbao", "nookHbao", &Kernels::nookHbao},
		 .fill = fillHorizon,
		 .samples_view = {"samples", "nookDebugSamplesHbao", &Kernels::nookDebugSamplesHbao}},
		{.method = ShadeMethod::sao,
		 .name = "sao",
		 .what = "scalable ambient obscurance",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .features = kOfSpiral,
		 .axes = axesOfSpiral,
		 .own_samples = spiralSamples,
		 .set_count = setSpiral,
		 .set_best = setBestSpiral,
		 .kernel = {"sao", "nookSao", &Kernels::nookSao},
		 .levels = spiralLevels,
		 .fill = fillSpiral,
		 .samples_view = allSamples(),
		 .lod_view = {"lod", "nookDebugLodSao", &Kernels::nookDebugLodSao},
		 .noise_variants = kSpiralVariants},
	};
}

std::vector<MethodRow> sliceRivals()
{
	return {
		{.method = ShadeMethod::gtao,
		 .name = "gtao",
		 .what = "ground-truth ambient occlusion",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .features = kOfGtao,
		 .swept = true,
		 .axes = axesOfGtao,
		 .own_samples = gtaoSamples,
		 .set_count = setGtaoSlices,
		 .set_best = setBestGtao,
		 .kernel = {"gtao", "nookGtao", &Kernels::nookGtao},
		 .fill = fillGtao,
		 .samples_view = allSamples()},
		{.method = ShadeMethod::bitmask,
		 .name = "bitmask",
		 .what = "visibility bit masks as published",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .features = kOfBitmask,
		 .axes = axesOfBitmask,
		 .own_samples = bitmaskSamples,
		 .set_count = setBitmaskSlices,
		 .set_best = setBestBitmask,
		 .kernel = {"bitmask", "nookBitmask", &Kernels::nookBitmask},
		 .fill = fillBitmask,
		 .samples_view = allSamples()},
	};
}

// Volumes, of which masks are another way to draw.
std::vector<MethodRow> volumeRows()
{
	return {
		{.kind = MethodKind::volumes,
		 .name = "aov",
		 .what = "ambient occlusion volumes",
		 .page = "aov.md",
		 .emitted = true,
		 .needs_normals = true,
		 .swept = true,
		 .shown_paper = 2,
		 .shown_ours = 1},
		{.kind = MethodKind::volumes,
		 .name = "aov-mask",
		 .what = "ambient occlusion volumes by masks of directions",
		 .page = "aov.md",
		 .emitted = true,
		 .needs_normals = true,
		 .masks = true,
		 .shown_ours = 4},
	};
}

std::vector<MethodRow> rows()
{
	std::vector<MethodRow> all;
	for (const auto& group : {volumetricRows, fittedRows, sliceRows, pointRivals, sliceRivals, volumeRows})
	{
		std::vector<MethodRow> some = group();
		std::move(some.begin(), some.end(), std::back_inserter(all));
	}
	return all;
}

} // namespace

std::span<const MethodRow> methodTable()
{
	static const std::vector<MethodRow> table = rows();
	return table;
}

template <> std::span<const std::string_view> namesOf<ShadeMethod>()
{
	static const std::vector<std::string_view> names = []
	{
		std::vector<std::string_view> all;
		for (const MethodRow& row : methodTable())
		{
			if (row.kind == MethodKind::screen)
			{
				all.push_back(row.name);
			}
		}
		return all;
	}();
	return names;
}

const MethodRow& rowOf(ShadeMethod method)
{
	const MethodRow& row = methodTable()[static_cast<std::size_t>(method)];
	assert(row.kind == MethodKind::screen && row.method == method);
	return row;
}

const MethodRow& volumeRow(bool masks)
{
	const std::span<const MethodRow> table = methodTable();
	return *std::find_if(table.begin(), table.end(),
						 [masks](const MethodRow& row) { return row.kind == MethodKind::volumes && row.masks == masks; });
}

const MethodRow* methodNamed(std::string_view name)
{
	const std::span<const MethodRow> table = methodTable();
	const auto found = std::find_if(table.begin(), table.end(), [name](const MethodRow& row) { return row.name == name; });
	return found != table.end() ? &*found : nullptr;
}

std::string methodNames(const std::function<bool(const MethodRow&)>& fits, const std::string& between)
{
	std::string names;
	for (const MethodRow& row : methodTable())
	{
		if (fits(row))
		{
			names += (names.empty() ? "" : between) + std::string(row.name);
		}
	}
	return names;
}

bool hasNoise(const MethodRow& row)
{
	return row.samples_view.call[0] != '\0';
}

bool hasPasses(const MethodRow& row, const ShadeSettings& settings)
{
	return row.moments || row.add_passes != nullptr || (row.levels != nullptr && row.levels(settings) > 0);
}

bool takesPattern(ShadeMethod method)
{
	return rowOf(method).domain.has_value();
}

bool mayTakeTile(ShadeMethod method)
{
	return rowOf(method).tile_domain.has_value();
}

Domain domainOf(ShadeMethod method)
{
	const MethodRow& row = rowOf(method);
	assert(row.domain || row.tile_domain);
	return row.domain ? *row.domain : *row.tile_domain;
}

ShadeSamples ownSamples(const ShadeSettings& settings)
{
	assert(!takesPattern(settings.method));
	return rowOf(settings.method).own_samples(settings);
}

} // namespace nook
