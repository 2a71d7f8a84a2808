// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/method_table.h"
#include "pattern/tile.h"
#include "study/error_points.h"
#include "study/error_report.h"

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

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

constexpr double kSameNormal = 0.8; // cosine, 37°
constexpr double kPan_px = 1.5;
constexpr double kWalk_radii = 0.04;

// Returns the four texels around a place, in that frame's view space, less those that lie off the plane of the pixel by more than a
// texel's width.
HistoryTexels texelsAt(const GBuffer& before, const Projector& projector, const glm::dvec3& position, const glm::dvec3& normal,
					   double width_m)
{
	HistoryTexels history;
	const glm::dvec2 at = projector.pixelOf(position) - 0.5;
	const glm::dvec2 corner = glm::floor(at + 1e-6);
	const glm::dvec2 share = glm::max(at - corner, 0.0);
	double sum = 0.0;
	for (std::size_t tap = 0; tap < 4; ++tap)
	{
		const glm::dvec2 step(static_cast<double>(tap % 2), static_cast<double>(tap / 2));
		const glm::dvec2 place = corner + step;
		if (!(place.x >= 0.0 && place.y >= 0.0 && place.x < before.width_px && place.y < before.height_px))
		{
			continue;
		}
		const std::size_t from =
			static_cast<std::size_t>(place.y) * static_cast<std::size_t>(before.width_px) + static_cast<std::size_t>(place.x);
		if (!std::isfinite(before.depth[from]))
		{
			continue;
		}
		const glm::dvec3 there = positionOf(before, projector, static_cast<int>(place.x), static_cast<int>(place.y)) - position;
		if (std::fabs(glm::dot(there, normal)) <= width_m && glm::dot(glm::dvec3(before.normals[from]), normal) >= kSameNormal)
		{
			history.texels[tap] = from;
			history.weights[tap] = (step.x > 0.0 ? share.x : 1.0 - share.x) * (step.y > 0.0 ? share.y : 1.0 - share.y);
			sum += history.weights[tap];
		}
	}
	history.any = sum > 1e-3;
	for (double& weight : history.weights)
	{
		weight = history.any ? weight / sum : 0.0;
	}
	return history;
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

template <> std::span<const std::string_view> namesOf<Motion>()
{
	static constexpr std::array<std::string_view, 3> kNames{"still", "pan", "walk"};
	return kNames;
}

MotionStep stepOf(Motion motion, double radius_m)
{
	return {motion == Motion::pan ? kPan_px : 0.0, motion == Motion::walk ? kWalk_radii * radius_m : 0.0};
}

LevelCamera cameraOfFrame(const LevelCamera& first, const MotionStep& step, int frame, int width_px, int height_px)
{
	LevelCamera camera = first;
	const double pixel = 2.0 / (width_px * viewOf(first, width_px, height_px).projection[0][0]); // radians
	const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), -frame * step.turn_px * pixel, glm::dvec3(0.0, 1.0, 0.0));
	camera.world_from_camera = first.world_from_camera * glm::translate(glm::dmat4(1.0), {frame * step.side_m, 0.0, 0.0}) * turn;
	return camera;
}

std::vector<HistoryTexels> historyOf(const GBuffer& now, const GBuffer& before)
{
	const int width = now.width_px;
	const Projector projector(now.view.projection, width, now.height_px);
	const glm::dmat4 before_from_now = before.view.camera_from_world * glm::inverse(now.view.camera_from_world);
	const Projector before_projector(before.view.projection, width, now.height_px);
	const glm::dmat3 turn(before_from_now);
	const double texel = 2.0 / (width * now.view.projection[0][0]); // at a depth of 1, or at any without perspective
	std::vector<HistoryTexels> history(now.depth.size());
	for (std::size_t i = 0; i < history.size(); ++i)
	{
		if (!std::isfinite(now.depth[i]))
		{
			continue;
		}
		const int x = static_cast<int>(i) % width;
		const int y = static_cast<int>(i) / width;
		const glm::dvec3 position(before_from_now * glm::dvec4(positionOf(now, projector, x, y), 1.0));
		if (position.z < 0.0)
		{
			const double width_m = texel * (now.view.projection[2][3] != 0.0 ? -position.z : 1.0);
			history[i] = texelsAt(before, before_projector, position, turn * glm::dvec3(now.normals[i]), width_m);
		}
	}
	return history;
}

FrameMean::FrameMean(double ema) : m_ema(ema) {}

void FrameMean::add(std::vector<double> frame, std::span<const HistoryTexels> history)
{
	std::vector<int> ages(frame.size(), 1);
	double squares = 0.0;
	std::size_t pixels = 0;
	for (std::size_t i = 0; i < history.size(); ++i)
	{
		const HistoryTexels& source = history[i];
		if (!source.any)
		{
			continue;
		}
		double old = 0.0;
		int age = 0;
		for (std::size_t tap = 0; tap < 4; ++tap)
		{
			old += source.weights[tap] * m_mean[source.texels[tap]];
			age = source.weights[tap] > 0.0 ? std::max(age, m_ages[source.texels[tap]]) : age;
		}
		ages[i] = age + 1;
		const double change = std::max(m_ema, 1.0 / ages[i]) * (frame[i] - old);
		frame[i] = old + change;
		squares += change * change;
		pixels += 1;
	}
	m_change = pixels > 0 ? std::sqrt(squares / static_cast<double>(pixels)) : 0.0;
	m_mean = std::move(frame);
	m_ages = std::move(ages);
}

const std::vector<double>& FrameMean::mean() const
{
	return m_mean;
}

const std::vector<int>& FrameMean::ages() const
{
	return m_ages;
}

double FrameMean::change() const
{
	return m_change;
}

} // namespace nook
