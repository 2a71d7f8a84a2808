// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/error_points.h"

#include "methods/method_table.h"
#include "pattern/tile.h"

#include <algorithm>
#include <cmath>

namespace nook
{
namespace
{

constexpr int kTileFrames = 8; // seconds to make; 16 take four times as long
constexpr int kUncovered = 2;  // frames in a mean that has just begun

std::string filterName(const ShadeSettings& shade)
{
	switch (shade.filter)
	{
	case ShadeFilter::none: break;
	case ShadeFilter::bilateral: return "bilateral:" + std::to_string(shade.filter_taps);
	case ShadeFilter::window: return "box:4";
	}
	return "none";
}

// rms over the surfaces that count; none where no pixel does.
template <class Counts>
std::optional<double> rmsOver(const GBuffer& gbuffer, const std::vector<double>& mean, const Reference& truth, Counts counts)
{
	double squares = 0.0;
	std::size_t pixels = 0;
	for (std::size_t i = 0; i < mean.size(); ++i)
	{
		if (std::isfinite(gbuffer.depth[i]) && counts(i))
		{
			const double error = mean[i] - static_cast<double>(truth.visibility[i]);
			squares += error * error;
			pixels += 1;
		}
	}
	return pixels > 0 ? std::optional(std::sqrt(squares / static_cast<double>(pixels))) : std::nullopt;
}

struct FramesCandidate
{
	Candidate candidate;
	std::optional<PatternTile> tile; // none: its own samples, the same in every frame
};

// 1, 8 and 32 as far as there are so many, and the last.
std::vector<int> shownFrames(int frames)
{
	std::vector<int> shown;
	for (const int frame : {1, 8, 32})
	{
		if (frame < frames)
		{
			shown.push_back(frame);
		}
	}
	shown.push_back(frames);
	return shown;
}

// A tile of at most 8 frames for the candidate's filter and its number of samples; none for what takes no tile.
std::optional<PatternTile> frameTile(const Candidate& candidate, int frames, double ema, const RunSettings& run)
{
	const MethodRow& row = *candidate.row();
	const bool tiled = row.domain && candidate.source == SampleSource::tile && candidate.shade.bands.count == 1;
	if (!row.emitted || !(tiled || row.tile_domain))
	{
		return std::nullopt;
	}
	TileRecipe recipe;
	recipe.filters = {tileFilterNamed(filterName(candidate.shade))};
	recipe.frames = std::min(frames, kTileFrames);
	recipe.ema = ema;
	const Pattern base = tiled ? patternOf(candidate, run).pattern : slicePattern(candidate.count);
	PatternTile tile = generateTile(base, recipe, run);
	for (Pattern& variant : tile.variants)
	{
		variant = candidate.shade.volume.paired ? pairedPattern(variant) : variant;
	}
	return tile;
}

namespace
{

// Adds the figures that follow from the last frame.
void tellLast(FramesRow& row, const GBuffer& gbuffer, const FrameMean& mean, const Reference& truth, int frame)
{
	const std::vector<int>& ages = mean.ages();
	row.change = mean.change();
	if (row.motion != Motion::still && frame >= kUncovered)
	{
		row.uncovered = rmsOver(gbuffer, mean.mean(), truth, [&ages](std::size_t i) { return ages[i] <= kUncovered; });
	}
}

} // namespace

// Rows of one motion. `reference`: of a camera, of the view's size.
void addFrames(FramesPart& part, LevelBench& bench, const LevelCamera& camera, const ViewSettings& how, Motion motion,
			   const std::vector<FramesCandidate>& candidates, const MeasureSettings& measure,
			   const std::function<Reference(const LevelCamera&)>& reference, const RunSettings& run, ProgressCounter& progress)
{
	const MotionStep step = stepOf(motion, bench.radiusM());
	std::vector<FrameMean> means(candidates.size(), FrameMean(part.ema));
	std::vector<FramesRow> rows;
	std::vector<ShadeSamples> samples;
	for (const FramesCandidate& one : candidates)
	{
		rows.push_back({one.candidate.name(), one.tile.has_value(), motion, {}, 0.0, {}});
		samples.push_back(one.tile ? samplesOf(one.candidate.shade.method, one.tile->variants, layersOf(*one.tile))
								   : ShadeSamples{});
	}
	std::optional<ViewBench> before;
	for (int frame = 0; frame < part.frames; ++frame)
	{
		const LevelCamera here = cameraOfFrame(camera, step, frame, how.width_px, how.height_px);
		std::optional<ViewBench> now;
		if (before && motion == Motion::still)
		{
			now = before;
		}
		else
		{
			now.emplace(bench, here, how, silent(run));
		}
		const GBuffer& gbuffer = now->gbuffer();
		const std::vector<HistoryTexels> history = before ? historyOf(gbuffer, before->gbuffer()) : std::vector<HistoryTexels>{};
		const bool shown = std::find(part.shown.begin(), part.shown.end(), frame + 1) != part.shown.end();
		const Reference truth = shown ? reference(here) : Reference{};
		for (std::size_t k = 0; k < candidates.size(); ++k)
		{
			const FramesCandidate& one = candidates[k];
			if (one.tile)
			{
				samples[k].variant = variantOfFrame(*one.tile, frame % one.tile->frames);
			}
			// A still camera with the same samples in every frame draws the same picture, so its mean is known after the first.
			if (frame == 0 || motion != Motion::still || one.tile)
			{
				const std::vector<float> drawn = now->draw(one.candidate, measure, one.tile ? &samples[k] : nullptr);
				means[k].add({drawn.begin(), drawn.end()}, history);
			}
			if (shown)
			{
				rows[k].rmse.push_back(rmsOver(gbuffer, means[k].mean(), truth, [](std::size_t) { return true; }).value_or(0.0));
			}
			if (frame + 1 == part.frames)
			{
				tellLast(rows[k], gbuffer, means[k], truth, frame);
			}
		}
		before = now;
		progress.finishOne();
	}
	part.rows.insert(part.rows.end(), rows.begin(), rows.end());
}

} // namespace

FramesPart framesOf(LevelBench& bench, const LevelCamera& camera, const ViewSettings& how, ViewBench& on,
					const std::vector<Candidate>& candidates, const ErrorView& view, const ErrorReportSettings& settings,
					PointMeasurer& points, const RunSettings& run)
{
	FramesPart part{settings.frames, settings.ema, shownFrames(settings.frames), {}};
	std::vector<FramesCandidate> tried;
	const std::vector<std::size_t> shown = framesPoints(candidates, view);
	std::optional<ProgressCounter> stage(std::in_place, run.progress, "tiles of frames", shown.size());
	for (const std::size_t i : shown)
	{
		tried.push_back({candidates[i], std::nullopt});
		if (const std::optional<PatternTile> tile = frameTile(candidates[i], settings.frames, settings.ema, run))
		{
			tried.push_back({candidates[i], tile});
		}
		stage->finishOne();
	}
	stage.emplace(run.progress, "frames of " + camera.name, namesOf<Motion>().size() * static_cast<std::size_t>(part.frames));
	for (const Motion motion : {Motion::still, Motion::pan, Motion::walk})
	{
		const auto referenceOf = [&](const LevelCamera& from)
		{
			const std::string hash = viewHash(bench, from, how, settings.version);
			return points.reference(hash,
									[&] {
										return from.world_from_camera == camera.world_from_camera
												   ? on.reference()
												   : ViewBench(bench, from, how, run).reference();
									});
		};
		addFrames(part, bench, camera, how, motion, tried, points.measure(), referenceOf, run, *stage);
	}
	return part;
}

} // namespace nook
