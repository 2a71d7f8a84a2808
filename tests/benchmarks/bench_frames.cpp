// SPDX-License-Identifier: GPL-3.0-or-later
// What a picture of five lines a pixel is off the same with 400, both behind a 3 × 3 binomial filter and a mean over frames: our
// tiles beside turned patterns.
//   nook_bench_frames [LEVEL]…      default: builtin:courtyard builtin:suburb
// 320 × 180; the plain mean of a pixel's first ten frames, then α = 0.1; with a camera that stands, one that turns by a pixel and a
// half a frame, and one that walks to the side. History is read where the surface was (four texels, those of another depth left
// out). frame N: rms over surfaces; flicker: rms change of that error from frame 31 to 32; uncovered: frame 32, where history has
// begun with it or the frame before. What history itself costs, by its blur, is in a row of its own.
#include "bench/over_frames.h"
#include "core/math.h"
#include "core/parallel.h"
#include "core/text.h"
#include "noise_report/rotations.h"
#include "pattern/generate.h"
#include "pattern/tile.h"
#include "pattern/tile_filter.h"
#include "scene/gbuffer.h"
#include "scene/load.h"
#include "shade/shade.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace
{

using namespace nook;
using Picture = std::vector<double>;

constexpr int kWidth = 320;
constexpr int kHeight = 180;
constexpr int kLines = 5;
constexpr int kFrames = 32;
constexpr double kAlpha = 0.1;

RunSettings all()
{
	return {availableThreads(), {}};
}

struct Variants
{
	const char* name;
	PatternTile tile;
};

PatternTile tileOf(const Pattern& pattern, const Rotations& rotations)
{
	PatternTile tile{pattern.domain, rotations.size, rotations.frames, {}, {}, {}};
	for (const double turns : rotations.turns)
	{
		tile.variants.push_back(turned(pattern, turns));
	}
	return tile;
}

// One line on each of as many even rings, as in `report noise`.
Pattern spiral()
{
	Pattern pattern;
	pattern.domain = Domain::disk;
	const auto outside = [](int ring)
	{
		const double rest = 1.0 - static_cast<double>(ring) / kLines;
		return rest * std::sqrt(rest);
	};
	for (int i = 0; i < kLines; ++i)
	{
		const double radius = std::sqrt((i + 0.5) / kLines);
		const SinCos turn = sinCosOf(2.0 * kPi * 0.6180339887498949 * i);
		pattern.points.emplace_back(radius * turn.cos, radius * turn.sin, 0.0);
		pattern.weights.push_back(outside(i) - outside(i + 1));
	}
	return pattern;
}

std::vector<Variants> variantsOf(const Pattern& refined)
{
	const TileFilter filter = tileFilterNamed("binomial:3");
	const auto optimised = [&](const Pattern& pattern)
	{
		const TileShares shares = sharesOf(16, filter, {kFrames, kAlpha}, 0);
		return tileOf(pattern, RotationError(pattern).optimised(16, kFrames, shares, 64));
	};
	TileRecipe recipe;
	recipe.filters = {filter};
	recipe.frames = 16;
	recipe.starts = 1;
	return {{"sixteen rotations", tileOf(refined, rotationsOf(RotationNoise::sixteen, 4, kFrames))},
			{"interleaved gradient noise", tileOf(refined, rotationsOf(RotationNoise::gradient, 32, kFrames))},
			{"optimised rotations", optimised(refined)},
			{"spiral, interleaved gradient noise", tileOf(spiral(), rotationsOf(RotationNoise::gradient, 32, kFrames))},
			{"spiral, optimised rotations", optimised(spiral())},
			{"nook tile --filter binomial:3 --frames 16", generateTile(refined, recipe, all())}};
}

Picture filtered(const std::vector<float>& picture)
{
	constexpr std::array<double, 3> kTaps{0.25, 0.5, 0.25};
	Picture result(picture.size());
	for (int y = 0; y < kHeight; ++y)
	{
		for (int x = 0; x < kWidth; ++x)
		{
			double sum = 0.0;
			for (int dy = -1; dy <= 1; ++dy)
			{
				for (int dx = -1; dx <= 1; ++dx)
				{
					const int from = std::clamp(y + dy, 0, kHeight - 1) * kWidth + std::clamp(x + dx, 0, kWidth - 1);
					sum += kTaps[static_cast<std::size_t>(dx + 1)] * kTaps[static_cast<std::size_t>(dy + 1)] *
						   static_cast<double>(picture[static_cast<std::size_t>(from)]);
				}
			}
			result[static_cast<std::size_t>(y * kWidth + x)] = sum;
		}
	}
	return result;
}

constexpr double kRadius_m = 0.5; // of the lines, ShadeSettings
constexpr std::array kMotions{Motion::still, Motion::pan, Motion::walk};

std::vector<GBuffer> framesOf(const Tracer& tracer, const LevelCamera& first, Motion motion)
{
	std::vector<GBuffer> frames;
	for (int frame = 0; frame < kFrames; ++frame)
	{
		const LevelCamera camera = cameraOfFrame(first, stepOf(motion, kRadius_m), frame, kWidth, kHeight);
		frames.push_back(frame > 0 && motion == Motion::still
							 ? frames.front()
							 : castGBuffer(tracer, viewOf(camera, kWidth, kHeight), kWidth, kHeight, NormalKind::geometric, all()));
	}
	return frames;
}

// Pictures of all frames behind the filter and the mean, and how many frames each pixel's mean has.
struct Seen
{
	std::vector<Picture> now; // the frame alone
	std::vector<Picture> mean;
	std::vector<std::vector<int>> ages;
};

Seen seenBy(const std::vector<GBuffer>& frames, const std::vector<std::vector<HistoryTexels>>& sources, const PatternTile& tile)
{
	ShadeSettings settings;
	settings.method = ShadeMethod::vo_line;
	ShadeSamples samples = samplesOf(settings.method, tile.variants, layersOf(tile));
	Seen seen;
	FrameMean mean(kAlpha);
	for (std::size_t frame = 0; frame < kFrames; ++frame)
	{
		samples.variant = variantOfFrame(tile, static_cast<int>(frame) % tile.frames);
		seen.now.push_back(filtered(shadeOnCpu(frames[frame], samples, settings, all()).visibility));
		mean.add(seen.now.back(), sources[frame]);
		seen.mean.push_back(mean.mean());
		seen.ages.push_back(mean.ages());
	}
	return seen;
}

// rms over the pixels of the frame that count.
template <class Counts, class ErrorAt> std::string rmsText(const GBuffer& frame, Counts counts, ErrorAt error_at)
{
	double squares = 0.0;
	double pixels = 0.0;
	for (std::size_t i = 0; i < frame.depth.size(); ++i)
	{
		if (std::isfinite(frame.depth[i]) && counts(i))
		{
			const double error = error_at(i);
			squares += error * error;
			pixels += 1.0;
		}
	}
	return pixels > 0.0 ? fixedText(std::sqrt(squares / pixels), 4) : "";
}

void printRow(const std::string& level, Motion motion, const char* name, const std::vector<GBuffer>& frames,
			  const std::vector<std::vector<int>>& ages, const std::vector<Picture>& pictures, const std::vector<Picture>& truths)
{
	const auto errorAt = [&](std::size_t frame)
	{
		return [&, frame](std::size_t i)
		{
			return pictures[frame][i] - truths[frame][i];
		};
	};
	const auto all_pixels = [](std::size_t)
	{
		return true;
	};
	std::string row = "| " + level + " | " + std::string(nameOf(motion)) + " | " + name + " |";
	for (const std::size_t frame : {0U, 7U, 31U})
	{
		row += " " + rmsText(frames[frame], all_pixels, errorAt(frame)) + " |";
	}
	row += " " + rmsText(frames[31], all_pixels, [&](std::size_t i) { return errorAt(31)(i) - errorAt(30)(i); }) + " |";
	row += " " +
		   rmsText(
			   frames[31], [&](std::size_t i) { return ages[31][i] <= 2; }, errorAt(31)) +
		   " |";
	std::printf("%s\n", row.c_str());
	std::fflush(stdout);
}

void measure(const std::string& level, Motion motion, const std::vector<GBuffer>& frames, const PatternTile& many,
			 const std::vector<Variants>& rivals)
{
	std::vector<std::vector<HistoryTexels>> sources(kFrames);
	parallelFor(kFrames - 1, availableThreads(), [&](std::size_t i) { sources[i + 1] = historyOf(frames[i + 1], frames[i]); });
	const Seen truth = seenBy(frames, sources, many);
	printRow(level, motion, "400 lines, against 400 without a history", frames, truth.ages, truth.mean, truth.now);
	for (const Variants& rival : rivals)
	{
		const Seen seen = seenBy(frames, sources, rival.tile);
		printRow(level, motion, rival.name, frames, seen.ages, seen.mean, truth.mean);
	}
}

} // namespace

int main(int argc, char** argv)
{
	std::vector<std::string> levels(argv + 1, argv + argc);
	if (levels.empty())
	{
		levels = {"builtin:courtyard", "builtin:suburb"};
	}
	Recipe recipe;
	recipe.count = kLines;
	Recipe of_many;
	of_many.count = 400;
	of_many.method = Method::vogel;
	const std::vector<Variants> rivals = variantsOf(generatePattern(recipe, all()));
	const PatternTile many{Domain::disk, 1, 1, {}, {generatePattern(of_many, all())}, {}};
	std::printf("| level | camera | five lines, by | frame 1 | frame 8 | frame 32 | flicker | uncovered |\n");
	std::printf("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
	for (const std::string& name : levels)
	{
		const LoadedLevel loaded = loadLevel(name, {}, all());
		const Tracer tracer(loaded.level, all());
		for (const Motion motion : kMotions)
		{
			measure(name, motion, framesOf(tracer, loaded.level.cameras.at(0), motion), many, rivals);
		}
	}
	return 0;
}
