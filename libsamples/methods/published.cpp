// SPDX-License-Identifier: GPL-3.0-or-later
// Rows and samples of the published methods that papers compare with; used only by `nook shade` and the reports. Kernels and
// sources: published_*.glsl. Defaults are the published ones, at a radius of 1 m.
#include "core/decimal.h"
#include "core/math.h"
#include "core/random.h"
#include "methods/feature_parts.h"
#include "methods/method_table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

constexpr std::size_t kVariants = 16; // pixels of a 4 × 4 window

// 0 to 15 in random order (Fisher-Yates).
std::array<double, kVariants> shuffled(Random& random)
{
	std::array<double, kVariants> order{};
	for (std::size_t i = 0; i < kVariants; ++i)
	{
		order[i] = static_cast<double>(i);
	}
	for (std::uint32_t i = kVariants; i > 1; --i)
	{
		std::swap(order[i - 1], order[random.below(i)]);
	}
	return order;
}

using namespace feature_parts;
using shade_kernels::Kernels;

// docs/reference/comparison.md; as published, and with the same fit to rays as our methods.
std::vector<CandidateAxes> publishedAxes(SampleSource source, const FilterChoice& filter, const std::vector<int>& counts)
{
	CandidateAxes axes{.origin = Origin::paper, .counts = counts, .sources = {source}, .filters = {filter}, .rays = {false, true}};
	return {axes};
}

int wholeOf(const ShadeSettings& settings, std::string_view option)
{
	return static_cast<int>(ownValue(settings, option));
}

// Functions of rows, by the option with their number.

template <Word option> int numberOf(const ShadeSettings& settings)
{
	return wholeOf(settings, option.letters);
}

template <Word option> int twiceNumberOf(const ShadeSettings& settings)
{
	return 2 * wholeOf(settings, option.letters);
}

template <Word option> void setNumber(ShadeSettings& settings, int count)
{
	settings.own[option.letters] = count;
}

// Returns the best count; `steps`: an option with 32 as its best value.
template <Word option, int count, Word steps> int setBest(ShadeSettings& settings)
{
	setNumber<option>(settings, count);
	setNumber<steps>(settings, 32);
	return count;
}

template <Word option> ShadeSamples sliceSamples(const ShadeSettings& settings)
{
	return {4, numberOf<option>(settings), sliceDirections(numberOf<option>(settings))};
}

float narrowOf(const ShadeSettings& settings, std::string_view option)
{
	return static_cast<float>(ownValue(settings, option));
}

// Crytek.

std::vector<FeatureRow> crytekOptions()
{
	std::vector<FeatureRow> rows;
	addOwnNumber(rows, "--crytek-range", 1e-3, 1e6, "radii", 2.7,
				 "crytek: surfaces that many radii in front count as 1/2 (default 2.7)");
	return rows;
}

std::vector<CandidateAxes> crytekAxes(GridSize size)
{
	return publishedAxes(SampleSource::own, kWindow, upTo<int>(size, {16}, {8, 16, 32}, {8, 16, 32, 64}));
}

std::vector<CandidateAxes> volumetricAxes(GridSize size)
{
	return publishedAxes(SampleSource::electro, kWindow, upTo<int>(size, {9}, {4, 9, 16}, {4, 9, 16, 32}));
}

// Horizon-based ambient occlusion.

std::vector<FeatureRow> horizonOptions()
{
	std::vector<FeatureRow> rows;
	addOwnWhole(rows, "--hbao-directions", 1, 64, 6, "hbao: directions in the picture (default 6)");
	addOwnWhole(rows, "--hbao-steps", 1, 64, 6, "hbao: steps along each direction (default 6)");
	addOwnNumber(rows, "--hbao-angle-bias", 0.0, 89.0, "degrees", 30.0,
				 "hbao: ignored elevation above the tangent plane in degrees (default 30)")
		.word = [](const S& s)
	{
		const double bias_deg = ownValue(s, "--hbao-angle-bias");
		return bias_deg == 30.0 ? std::string() : "bias-" + numberText(bias_deg);
	};
	return rows;
}

std::vector<CandidateAxes> horizonAxes(GridSize size)
{
	std::vector<CandidateAxes> axes = publishedAxes(SampleSource::own, kThirteen, upTo<int>(size, {6}, {4, 6, 8}, {4, 6, 8, 16}));
	axes.push_back(axes.front());
	axes.back().forms.front().own["--hbao-angle-bias"] = 10.0; // as shipped; the recipe has its own
	axes.back().rays = {false};
	return axes;
}

ShadeSamples horizonSamples(const ShadeSettings& settings)
{
	const int directions = wholeOf(settings, "--hbao-directions");
	return {4, directions, horizonDirections(directions)};
}

void fillHorizon(ShadeBlock& block, const ShadeSettings& settings)
{
	const SinCos bias = sinCosOf(ownValue(settings, "--hbao-angle-bias") * kPi / 180.0);
	block.hbao_sine = static_cast<float>(bias.sin);
	block.hbao_cosine = static_cast<float>(bias.cos);
	block.steps = wholeOf(settings, "--hbao-steps");
}

// Scalable ambient obscurance.

std::vector<FeatureRow> spiralOptions()
{
	std::vector<FeatureRow> rows;
	addOwnWhole(rows, "--sao-samples", 1, 256, 11, "sao: samples of the spiral (default 11)");
	addOwnWhole(rows, "--sao-turns", 1, 256, 7, "sao: turns of the spiral (default 7)");
	addOwnNumber(rows, "--sao-intensity", 1e-6, 1e6, "", 1.0,
				 "sao: factor of the obscurance, with lengths in units of the radius (default 1)");
	addOwnNumber(rows, "--sao-bias", 0.0, 1.0, "radii", 0.012,
				 "sao: ignored height above the tangent plane in radii (default 0.012)");
	addOwnNumber(rows, "--sao-epsilon", 1e-12, 1e6, "radii²", 0.01,
				 "sao: keeps the quotient finite, in squared radii (default 0.01)");
	addOwnWhole(rows, "--sao-levels", 0, 8, 5, "sao: coarser depth levels for distant samples (default 5)");
	return rows;
}

std::vector<CandidateAxes> spiralAxes(GridSize size)
{
	return publishedAxes(SampleSource::own, kFive, upTo<int>(size, {11}, {6, 11, 24}, {6, 11, 24, 48}));
}

ShadeSamples spiralSamples(const ShadeSettings& settings)
{
	const int count = wholeOf(settings, "--sao-samples");
	return {1, count, spiral(count, wholeOf(settings, "--sao-turns"))};
}

int setBestSpiral(ShadeSettings& settings)
{
	settings.own["--sao-samples"] = 256;
	return 256;
}

void fillSpiral(ShadeBlock& block, const ShadeSettings& settings)
{
	block.sao_intensity = narrowOf(settings, "--sao-intensity");
	block.sao_bias = narrowOf(settings, "--sao-bias");
	block.sao_epsilon = narrowOf(settings, "--sao-epsilon");
}

// Ground-truth ambient occlusion.

std::vector<FeatureRow> gtaoOptions()
{
	std::vector<FeatureRow> rows;
	addOwnWhole(rows, "--gtao-slices", 1, 16, 3, "gtao: planes through the view ray (default 3)");
	addOwnWhole(rows, "--gtao-steps", 1, 32, 6, "gtao: depths on either side of each (default 6)");
	addOwnNumber(rows, "--gtao-falloff", 0.0, 0.99, "radii", 0.385,
				 "gtao: distance in radii from which horizons fade to the tangent (default 0.385)");
	addOwnNumber(rows, "--gtao-thickness", 0.0, 1.0, "", 0.01,
				 "gtao: fraction by which a step below the horizon lowers it (default 0.01)");
	return rows;
}

std::vector<CandidateAxes> publishedSliceAxes(GridSize size)
{
	return publishedAxes(SampleSource::own, kFive, upTo<int>(size, {3}, {1, 3}, {1, 2, 3}));
}

void fillGtao(ShadeBlock& block, const ShadeSettings& settings)
{
	block.gtao_falloff = narrowOf(settings, "--gtao-falloff");
	block.gtao_thickness = narrowOf(settings, "--gtao-thickness");
	block.steps = wholeOf(settings, "--gtao-steps");
}

// Visibility bit masks as published.

std::vector<FeatureRow> bitmaskOptions()
{
	std::vector<FeatureRow> rows;
	addOwnWhole(rows, "--bitmask-slices", 1, 16, 3, "bitmask: planes through the view ray (default 3)");
	addOwnWhole(rows, "--bitmask-steps", 1, 32, 6, "bitmask: depths on either side of each (default 6)");
	addOwnNumber(rows, "--bitmask-thickness", 1e-3, 1e3, "radii", 0.25, "bitmask: thickness of surfaces (default 0.25)");
	addChoice(rows, 0, "--bitmask-hit", {"half", "whole", "touched"}, ownMember("--bitmask-hit", 0.0),
			  "bitmask: how much of a sector a surface must cover for it to count as covered: half of it (default), all "
			  "of it, or any part")
		.places = kInShade;
	return rows;
}

// A sector counts as covered from half of it (the paper), from the whole, or from 1/1000 (the authors' published sample).
void fillBitmask(ShadeBlock& block, const ShadeSettings& settings)
{
	constexpr std::array<float, 3> kRound{0.5F, 0.0F, 0.999F};
	block.bitmask_thickness = narrowOf(settings, "--bitmask-thickness");
	block.bitmask_round = kRound[static_cast<std::size_t>(wholeOf(settings, "--bitmask-hit"))];
	block.steps = wholeOf(settings, "--bitmask-steps");
}

} // namespace

Pattern crytekPoints(int count)
{
	assert(count > 0 && count % 8 == 0);
	Pattern pattern;
	pattern.domain = Domain::ball;
	const double step = 1.0 + 2.4 / count;
	double distance = 1.0;
	for (int i = 1; i < count; ++i)
	{
		distance /= step;
	}
	for (int i = 0; i < count; ++i)
	{
		const double side = distance / std::sqrt(3.0);
		pattern.points.emplace_back((i & 4) != 0 ? side : -side, (i & 2) != 0 ? side : -side, (i & 1) != 0 ? side : -side);
		pattern.weights.push_back(1.0 / count);
		distance = std::min(1.0, distance * step);
	}
	return pattern;
}

std::vector<glm::vec4> horizonDirections(int directions)
{
	assert(directions > 0);
	Random random(1);
	const std::array<double, kVariants> turns = shuffled(random);
	const std::array<double, kVariants> jitters = shuffled(random);
	std::vector<glm::vec4> samples;
	for (std::size_t variant = 0; variant < kVariants; ++variant)
	{
		for (int i = 0; i < directions; ++i)
		{
			const SinCos angle = sinCosOf(2.0 * kPi * (i + turns[variant] / kVariants) / directions);
			samples.emplace_back(angle.cos, angle.sin, (jitters[variant] + 0.5) / kVariants, 1.0 / directions);
		}
	}
	return samples;
}

std::vector<glm::vec4> sliceDirections(int slices)
{
	assert(slices > 0);
	std::vector<glm::vec4> samples;
	for (int y = 0; y < 4; ++y)
	{
		for (int x = 0; x < 4; ++x)
		{
			const double turn = 4 * ((x + y) % 4) + x;
			const double jitter = (y - x + 4) % 4;
			for (int i = 0; i < slices; ++i)
			{
				const SinCos angle = sinCosOf(kPi * (i + (turn + 0.5) / kVariants) / slices);
				samples.emplace_back(angle.cos, angle.sin, (jitter + 0.5) / 4.0, 1.0 / slices);
			}
		}
	}
	return samples;
}

std::vector<glm::vec4> spiral(int count, int turns)
{
	assert(count > 0);
	std::vector<glm::vec4> samples;
	for (int i = 0; i < count; ++i)
	{
		const double distance = (i + 0.5) / count;
		const SinCos angle = sinCosOf(2.0 * kPi * distance * turns);
		samples.emplace_back(distance * angle.cos, distance * angle.sin, distance, 1.0 / count);
	}
	return samples;
}

std::vector<MethodRow> publishedRows()
{
	return {
		{.name = "crytek",
		 .what = "Crytek's points",
		 .page = "comparison.md",
		 .options = crytekOptions(),
		 .axes = crytekAxes,
		 .domain = Domain::ball,
		 .own_pattern = crytekPoints,
		 .default_count = 16,
		 .kernel = {"crytek", "nookCrytek", &Kernels::nookCrytek},
		 .fill = [](ShadeBlock& block, const ShadeSettings& settings)
		 { block.crytek_range = narrowOf(settings, "--crytek-range"); },
		 .samples_view = allSamples()},
		{.name = "volumetric-ao",
		 .what = "volumetric ambient occlusion in the tangent sphere",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .radius_ratio = kVolumetricRatio,
		 .axes = volumetricAxes,
		 .domain = Domain::hemisphere,
		 .kernel = {"volumetric-ao", "nookVolumetric", &Kernels::nookVolumetric},
		 .samples_view = allSamples()},
		{.name = "hbao",
		 .what = "horizon-based ambient occlusion",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .options = horizonOptions(),
		 .axes = horizonAxes,
		 .own_samples = horizonSamples,
		 .set_count = setNumber<"--hbao-directions">,
		 .set_best = setBest<"--hbao-directions", 32, "--hbao-steps">,
		 .kernel = {"hbao", "nookHbao", &Kernels::nookHbao},
		 .sample_depths = numberOf<"--hbao-steps">,
		 .fill = fillHorizon,
		 .samples_view = {"samples", "nookDebugSamplesHbao", &Kernels::nookDebugSamplesHbao}},
		{.name = "sao",
		 .what = "scalable ambient obscurance",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .options = spiralOptions(),
		 .axes = spiralAxes,
		 .own_samples = spiralSamples,
		 .set_count = setNumber<"--sao-samples">,
		 .set_best = setBestSpiral,
		 .kernel = {"sao", "nookSao", &Kernels::nookSao},
		 .levels = numberOf<"--sao-levels">,
		 .fill = fillSpiral,
		 .samples_view = allSamples(),
		 .lod_view = {"lod", "nookDebugLodSao", &Kernels::nookDebugLodSao},
		 .noise_variants = 16}, // rotations of nookSaoTurn
		{.name = "gtao",
		 .what = "ground-truth ambient occlusion",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .options = gtaoOptions(),
		 .axes = publishedSliceAxes,
		 .own_samples = sliceSamples<"--gtao-slices">,
		 .set_count = setNumber<"--gtao-slices">,
		 .set_best = setBest<"--gtao-slices", 16, "--gtao-steps">,
		 .kernel = {"gtao", "nookGtao", &Kernels::nookGtao},
		 .sample_depths = twiceNumberOf<"--gtao-steps">,
		 .fill = fillGtao,
		 .samples_view = allSamples()},
		{.name = "bitmask",
		 .what = "visibility bit masks as published",
		 .page = "comparison.md",
		 .needs_normals = true,
		 .options = bitmaskOptions(),
		 .axes = publishedSliceAxes,
		 .own_samples = sliceSamples<"--bitmask-slices">,
		 .set_count = setNumber<"--bitmask-slices">,
		 .set_best = setBest<"--bitmask-slices", 16, "--bitmask-steps">,
		 .kernel = {"bitmask", "nookBitmask", &Kernels::nookBitmask},
		 .sample_depths = twiceNumberOf<"--bitmask-steps">,
		 .fill = fillBitmask,
		 .samples_view = allSamples()},
	};
}

} // namespace nook
