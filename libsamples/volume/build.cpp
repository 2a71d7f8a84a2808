// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/build.h"

#include "core/costs.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "core/random.h"
#include "core/text.h"
#include "core/work_units.h"
#include "scene/describe.h"
#include "scene/reference.h"
#include "volume/evaluate.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>

namespace nook
{

void visit(Archive& archive, DetailTrial& trial)
{
	archive(trial.detail, trial.polygons, trial.paper_rmse, trial.fitted_rmse);
}

void visit(Archive& archive, DetailChoice& choice)
{
	archive(choice.detail, choice.points, choice.trials);
}

void visit(Archive& archive, Occluder& polygon)
{
	archive(polygon.first_corner, polygon.corner_count, polygon.triangle, polygon.alpha, polygon.two_sided, polygon.reach,
			polygon.side_reach);
}

void visit(Archive& archive, OccluderCounts& counts)
{
	archive(counts.triangles, counts.proxies, counts.polygons, counts.two_sided, counts.corners, counts.regions, counts.with_holes,
			counts.fallbacks, counts.duplicates, counts.reversed, counts.thin, counts.uncut, counts.clear, counts.components,
			counts.closed, counts.extent_m, counts.deviation_m);
}

void visit(Archive& archive, TrimCounts& counts)
{
	archive(counts.receivers, counts.left_out, counts.whole, counts.shares, counts.lost, counts.trimmed, counts.mean_reach,
			counts.surface, counts.greatest_loss, counts.mean_loss);
}

namespace
{

constexpr int kGapHalvings = 5;                                 // of leaves in masks; tuned on a pine and a town with creepers
constexpr std::ptrdiff_t kMostParts = std::ptrdiff_t{1} << 21U; // halvings of masked triangles end where they may become more
constexpr double kMaskMore = 0.25;                              // increase of the masks' error that --detail auto allows
constexpr double kMaskError = 0.008; // and an error that it allows in any case; in pictures 1.2 to 1.8 times as much (levels.md)
constexpr int kMaskDirections = 128; // as aov-mask by default

bool dropsAnything(const DropSettings& drop)
{
	return drop.no_receiver || drop.sides || drop.inside || drop.below > 0.0;
}

bool simplifies(const VolumeSettings& settings)
{
	return settings.detail_more || settings.occluders.detail > 0.0;
}

bool needsTracer(const VolumeSettings& settings)
{
	return dropsAnything(settings.drop) || simplifies(settings) || settings.trim || settings.compensate || settings.verify;
}

void warn(const Level& level, const VolumeSettings& settings, BuiltVolumes& built)
{
	const Bounds bounds = boundsOf(level);
	const double diagonal_m = glm::length(bounds.most - bounds.least);
	if (built.set.occluders.polygons.empty())
	{
		built.warnings.push_back(level.name + ": volumes: found none that darkens anything visible, expected some: the file "
											  "has no polygons (keep all by dropping nothing)");
	}
	if (settings.distance_m > diagonal_m && !built.set.occluders.polygons.empty())
	{
		built.warnings.push_back(level.name + ": distance: found " + roundedText(settings.distance_m, 3) +
								 " m, more than the level's diagonal of " + roundedText(diagonal_m, 3) +
								 " m: nearly every pixel is in each of the " + std::to_string(built.set.occluders.polygons.size()) +
								 " volumes");
	}
	if (built.dropped.inside_refused)
	{
		built.warnings.push_back(
			level.name + ": insides: found " +
			std::to_string(static_cast<int>(100.0 * built.dropped.inside_m2 / built.dropped.area_m2)) +
			" % of the area inside solids, expected at most half: the level seems to be inside out, so nothing was dropped "
			"as inside");
	}
	if (built.compensated && built.compensated->refused)
	{
		const CurveCheck& check = built.compensated->check;
		const bool rmse = settings.compensate->measure == CurveMeasure::rmse;
		built.warnings.push_back(level.name + ": compensate: found " + (rmse ? "an RMSE of " : "an eq. 14 of ") +
								 roundedText(rmse ? check.after.rmse : check.after.eq14, 3) +
								 " in held-out views, expected at most " +
								 roundedText(rmse ? check.before.rmse : check.before.eq14, 3) +
								 ", the error of the paper's curve, which is used instead");
	}
	const double missed = built.dropped.check_rays > 0
							  ? static_cast<double>(built.dropped.check_missed) / static_cast<double>(built.dropped.check_rays)
							  : 0.0;
	if (missed > 1e-3)
	{
		built.warnings.push_back(
			level.name + ": visible-from: " + roundedText(100.0 * missed, 3) +
			" % of an independent sample of rays hit surfaces that were considered invisible; expected 0.1 % or "
			"less: use more rays");
	}
}

// Drops optional steps until the estimate is within the limit, those first that use the most memory or gain the least; returns
// their names.
std::string leaveOut(VolumeSettings& settings, uint64_t count)
{
	std::string without;
	const auto leave = [&](bool is_set, const char* name, auto&& unset)
	{
		if (is_set && volumeMemory(count, settings) > settings.memory_bytes)
		{
			unset();
			without += (without.empty() ? "" : ", ") + std::string(name);
		}
	};
	leave(settings.trim.has_value(), "trim", [&] { settings.trim.reset(); });
	leave(settings.verify.has_value(), "verify", [&] { settings.verify.reset(); });
	leave(settings.compensate.has_value(), "compensate", [&] { settings.compensate.reset(); });
	leave(settings.detail_more.has_value(), "detail auto", [&] { settings.detail_more.reset(); });
	leave(settings.drop.below > 0.0, "drop-below", [&] { settings.drop.below = 0.0; });
	return without;
}

std::string foundNeed(const Level& level, const VolumeSettings& settings, uint64_t count, const char* what)
{
	return level.name + ": memory: found a need of about " + needText(volumeMemory(count, settings)) + " for " +
		   std::to_string(count) + " " + what + ", expected at most " + capText(settings.memory_bytes);
}

// Throws if the estimate for `count` triangles, or the polygons they are cut to, exceeds the limit.
void checkMemory(const Level& level, const VolumeSettings& settings, uint64_t count, const char* what, BuiltVolumes& built)
{
	built.memory_estimate_bytes = volumeMemory(count, settings);
	if (settings.memory_bytes == 0 || built.memory_estimate_bytes <= settings.memory_bytes)
	{
		return;
	}
	VolumeSettings less = settings;
	const std::string without = leaveOut(less, count);
	const uint64_t need = volumeMemory(count, less);
	throw Error(ExitCode::runtime,
				foundNeed(level, settings, count, what) + ": " +
					(need <= less.memory_bytes ? "about " + needText(need) + " without " + without + ", which --degrade leaves out"
					 : count != level.triangles.size() ? "a longer --extent needs less"
													   : "nook level --cells cuts it into parts that need less each"));
}

// With `degrade`, the settings that the limit allows for the level's triangles, and a warning that names the steps left out.
VolumeSettings withinMemory(const Level& level, const VolumeSettings& settings, BuiltVolumes& built)
{
	const uint64_t count = level.triangles.size();
	VolumeSettings less = settings;
	const std::string without = settings.memory_bytes > 0 && settings.degrade ? leaveOut(less, count) : "";
	const uint64_t need = volumeMemory(count, less);
	if (without.empty() || need > less.memory_bytes)
	{
		checkMemory(level, settings, count, "triangles", built);
		return settings;
	}
	built.memory_estimate_bytes = need;
	built.left_out = without;
	built.warnings.push_back(foundNeed(level, settings, count, "triangles") + ": left out " + without + ", which leaves about " +
							 needText(need));
	return less;
}

// Drops volumes from built.set that darken nothing.
void dropFrom(BuiltVolumes& built, const Tracer& tracer, const VolumeSettings& settings, const RunSettings& run)
{
	VolumeSet& set = built.set;
	DropSettings drop = settings.drop;
	drop.simplified_m = built.merged.deviation_m;
	Dropped dropped = dropVolumes(set.occluders, tracer, set.distance_m, set.exact_bounds, drop, run);
	built.dropped = dropped.counts;
	set.occluders = std::move(dropped.occluders);
}

CompensateSettings compensation(const VolumeSettings& settings, std::span<const uint8_t> idle_backs)
{
	CompensateSettings fit = *settings.compensate;
	fit.idle_backs = idle_backs;
	fit.ray_distance_m = settings.ray_distance_m > 0.0 ? settings.ray_distance_m : fit.ray_distance_m;
	return fit;
}

void compensate(BuiltVolumes& built, const Tracer& tracer, const CompensateSettings& settings, const RunSettings& run)
{
	built.compensated = compensateVolumes(built.set, tracer, settings, run);
	built.set.compensation = built.compensated->curve;
	built.set.ray_distance_m = built.compensated->ray_distance_m;
}

void chooseDetailOf(BuiltVolumes& built, const Level& level, const Tracer& tracer, const VolumeSettings& settings,
					OccluderSettings& occluding, const RunSettings& run)
{
	DetailSettings choosing;
	choosing.more = *settings.detail_more > 0.0 ? *settings.detail_more : settings.masks ? kMaskMore : choosing.more;
	choosing.ray_distance_m = settings.masks ? settings.distance_m : settings.ray_distance_m;
	choosing.exact_bounds = settings.exact_bounds;
	choosing.fitted = settings.compensate.has_value();
	choosing.masks = settings.masks;
	choosing.receivers.idle_backs = occluding.one_sided;
	runOnce(
		"detail", [&] { built.detail = chooseDetail(level, tracer, occluding, choosing, withoutUnits(run)); },
		[&](Archive& archive) { archive(built.detail); }, run);
	occluding.detail = built.detail->detail;
}

int gapHalvings(const Level& level)
{
	const auto masked = std::count_if(level.materials.begin(), level.materials.end(),
									  [&level](auto material) { return level.material_list[material].mask >= 0; });
	int halvings = kGapHalvings;
	for (; halvings > 0 && masked << halvings > kMostParts; --halvings)
	{
	}
	return halvings;
}

// Returns the backs that do not darken because surfaces were simplified (idleBacks); empty: none.
std::vector<uint8_t> findOccluders(BuiltVolumes& built, const Level& level, const Tracer* tracer, const VolumeSettings& settings,
								   const RunSettings& run)
{
	OccluderSettings occluding = settings.occluders;
	occluding.gap_halvings = settings.masks ? gapHalvings(level) : 0;
	occluding.holes = settings.masks ? 0.0 : occluding.holes;
	occluding.distance_m = settings.distance_m;
	occluding.before_cutting = [&](uint64_t pieces)
	{
		if (pieces > level.triangles.size())
		{
			checkMemory(level, settings, pieces, "polygons that an extent cuts to", built);
		}
	};
	const bool whole = tracer != nullptr && settings.occluding == nullptr; // the tracer numbers the triangles of the whole level
	if (whole && occluding.sides == Sides::automatic)
	{
		runOnce(
			"looks", [&] { occluding.seen_backs = seenBacks(*tracer, settings.drop.visible_from, withoutUnits(run)); },
			[&](Archive& archive) { archive(occluding.seen_backs); }, run);
	}
	if (simplifies(settings) && whole)
	{
		occluding.tracer = tracer;
		runOnce(
			"backs",
			[&] { occluding.one_sided = idleBacks(*tracer, settings.distance_m, settings.drop.visible_from, withoutUnits(run)); },
			[&](Archive& archive) { archive(occluding.one_sided); }, run);
	}
	if (settings.detail_more)
	{
		chooseDetailOf(built, level, *tracer, settings, occluding, run);
	}
	Occluding occluders;
	runOnce(
		"occluders", [&] { occluders = occludersOf(level, occluding, withoutUnits(run)); },
		[&](Archive& archive) { archive(occluders.counts, occluders.occluders.corners, occluders.occluders.polygons); }, run);
	built.merged = occluders.counts;
	built.set.occluders = std::move(occluders.occluders);
	built.dropped.polygons = built.set.occluders.polygons.size();
	built.dropped.kept = built.dropped.polygons;
	return occluding.detail > 0.0 ? std::move(occluding.one_sided) : std::vector<uint8_t>{};
}

void trim(BuiltVolumes& built, const Tracer& tracer, const TrimSettings& trimming, const RunSettings& run)
{
	VolumeSet& set = built.set;
	runOnce(
		"trim", [&] { built.trimmed = trimVolumes(set, tracer, trimming, withoutUnits(run)); },
		[&](Archive& archive)
		{
			archive(built.trimmed);
			for (Occluder& polygon : set.occluders.polygons)
			{
				archive(polygon.reach, polygon.side_reach);
			}
		},
		run);
}

constexpr std::array<double, 19> kLadder{0.08,  0.067, 0.057, 0.048,  0.04,  0.034, 0.028, 0.024,  0.02,  0.017,
										 0.014, 0.012, 0.01,  0.0084, 0.007, 0.006, 0.005, 0.0042, 0.0035};
// With the paper's curve, the error under the best-fitting curve may grow by this multiple of the allowed fraction: the paper's
// bias can hide facets, which fitting a curve later could not correct. builtin:cave at 1 m: 0.024, a sixth of the bytes, and 3 %
// more error in pictures.
constexpr double kShapeMore = 3.0;
constexpr double kWorthIt = 0.9; // of the polygons; if simplification keeps more, it does not pay

class Trials
{
public:
	Trials(const Level& level, const Tracer& tracer, const OccluderSettings& settings, const DetailSettings& detail,
		   const RunSettings& run)
		: m_level(level), m_settings(settings), m_exact(detail.exact_bounds), m_masks(detail.masks), m_run(run),
		  m_points(sampleReceivers(tracer, settings.distance_m, detail.receivers, run))
	{
		ReferenceSettings reference;
		reference.falloff = Falloff::linear;
		reference.radius_m = detail.ray_distance_m > 0.0 ? detail.ray_distance_m : settings.distance_m / kPaperRayRatio;
		reference.rays = detail.masks ? 4 * detail.rays : detail.rays; // masks err less than the noise of few rays
		m_occlusions = mapped(referenceAtPoints(tracer, m_points, reference, run),
							  [](const ReferenceValue& value) { return 1.0 - value.visibility; });
	}

	std::size_t points() const
	{
		return m_points.size();
	}

	// Without simplification. Then leaves out points in gaps that nothing sees: those that this gets wrong, since the polygons of
	// gaps are dropped, and those that surfaces enclose.
	DetailTrial whole()
	{
		std::vector<double> values;
		const DetailTrial all = at(0.0, values);
		const std::optional<Compensation> curve = m_masks ? std::nullopt : std::optional(fitCurve(values, m_occlusions));
		std::size_t kept = 0;
		for (std::size_t i = 0; i < values.size(); ++i)
		{
			const double error = (curve ? curve->at(values[i]) : values[i]) - m_occlusions[i];
			if (std::fabs(error) <= kMissed && m_occlusions[i] <= kEnclosed)
			{
				m_points[kept] = m_points[i];
				m_occlusions[kept] = m_occlusions[i];
				values[kept++] = values[i];
			}
		}
		m_points.resize(kept);
		m_occlusions.resize(kept);
		values.resize(kept);
		return trialOf(0.0, all.polygons, values);
	}

	DetailTrial at(double share) const
	{
		std::vector<double> values;
		return at(share, values);
	}

private:
	static constexpr double kMissed = 0.2;
	static constexpr double kEnclosed = 0.98;

	// `values`: the sums of volumes at the points, or the occlusion by masks.
	DetailTrial at(double share, std::vector<double>& values) const
	{
		OccluderSettings settings = m_settings;
		settings.detail = share;
		settings.before_cutting = nullptr;
		VolumeSet set;
		set.distance_m = m_settings.distance_m;
		set.exact_bounds = m_exact;
		set.occluders = occludersOf(m_level, settings, m_run).occluders;
		values = m_masks ? masksAt(set) : sumsAt(set, m_points, m_run);
		return trialOf(share, set.occluders.polygons.size(), values);
	}

	DetailTrial trialOf(double share, uint64_t polygons, std::span<const double> values) const
	{
		if (values.empty())
		{
			return {share, polygons, 0.0, 0.0};
		}
		if (m_masks)
		{
			const auto itself = [](double occlusion)
			{
				return occlusion;
			};
			return {share, polygons, rmseOf(itself, values), rmseOf(itself, values, kMissed)};
		}
		const auto by = [](const Compensation& curve)
		{
			return [&curve](double sum)
			{
				return curve.at(sum);
			};
		};
		return {share, polygons, rmseOf(by(Compensation{}), values), rmseOf(by(fitCurve(values, m_occlusions)), values)};
	}

	// Errors above `most` count as that.
	template <class Curve>
	double rmseOf(const Curve& curve, std::span<const double> values, double most = std::numeric_limits<double>::infinity()) const
	{
		double squares = 0.0;
		for (std::size_t i = 0; i < values.size(); ++i)
		{
			const double error = std::min(std::fabs(curve(values[i]) - m_occlusions[i]), most);
			squares += error * error;
		}
		return std::sqrt(squares / static_cast<double>(values.size()));
	}

	std::vector<double> masksAt(const VolumeSet& set) const
	{
		const VolumeEvaluator evaluator(set, m_run, true);
		std::vector<double> occlusions(m_points.size());
		parallelFor(m_points.size(), m_run.threads,
					[&](std::size_t i)
					{
						const ReferencePoint& point = m_points[i];
						occlusions[i] = 1.0 - evaluator.mask(point.position, point.normal, kMaskDirections).visibility;
					});
		return occlusions;
	}

	const Level& m_level;
	const OccluderSettings& m_settings;
	bool m_exact;
	bool m_masks;
	const RunSettings& m_run;
	std::vector<ReferencePoint> m_points;
	std::vector<double> m_occlusions;
};

bool isAlphaTested(const Level& level, std::size_t triangle)
{
	return level.material_list[level.materials[triangle]].alpha_mode != AlphaMode::opaque;
}

// Per triangle the flat pieces that it stands for with its own one, 0 outside the sample. Of each size, one piece of every so many
// is in the sample, the same share of leaves as of walls, but a few at least; all of a small level.
std::vector<double> sampleOf(const Level& level, std::span<const uint32_t> flat_of)
{
	constexpr std::size_t kPieces = 2048; // polygons to about 5 %, in a few hundredths of a second
	constexpr std::size_t kLeaves = 192;  // whose gaps take a tenth of a second
	constexpr std::size_t kFew = 8;       // of each size, fewer if they have more triangles together than
	constexpr std::size_t kFewTriangles = 8192;
	std::vector<uint32_t> sizes(flat_of.size(), 0);
	for (const uint32_t piece : flat_of)
	{
		sizes[piece] += 1;
	}
	std::array<std::vector<std::size_t>, 33> by_size; // by the width of the number
	std::size_t pieces = 0;
	std::size_t leaves = 0;
	for (std::size_t t = 0; t < sizes.size(); ++t)
	{
		by_size[static_cast<std::size_t>(std::bit_width(sizes[t]))].push_back(t);
		pieces += sizes[t] > 0 ? 1U : 0U;
		leaves += sizes[t] > 0 && isAlphaTested(level, t) ? 1U : 0U;
	}
	const std::size_t step = std::max({std::size_t{1}, pieces / kPieces, leaves / kLeaves});
	std::vector<double> weights(flat_of.size(), 0.0);
	for (std::size_t width = 1; width < by_size.size(); ++width)
	{
		const std::vector<std::size_t>& of_size = by_size[width];
		const std::size_t few = std::clamp<std::size_t>(kFewTriangles >> (width - 1), 1, kFew);
		const std::size_t every = std::clamp<std::size_t>(of_size.size() / few, 1, step);
		const std::size_t chosen = (of_size.size() + every - 1) / every;
		for (std::size_t first = 0; first < of_size.size(); first += every)
		{
			const std::size_t at = std::min(first + mixBits(first) % every, of_size.size() - 1);
			weights[of_size[at]] = static_cast<double>(of_size.size()) / static_cast<double>(chosen);
		}
	}
	for (std::size_t t = 0; t < flat_of.size(); ++t)
	{
		weights[t] = weights[flat_of[t]];
	}
	return weights;
}

} // namespace

// Upper estimate; nook_bench_drop prints it next to the measured peak.
uint64_t volumeMemory(uint64_t triangles, const VolumeSettings& settings)
{
	uint64_t each = 300 + settings.written_bytes; // triangles → polygons: welded corners, edges, the polygons themselves
	const bool tracer = needsTracer(settings);
	each += tracer ? 100U : 0U;                                                         // Embree's tree
	each += dropsAnything(settings.drop) ? 150U : 0U;                                   // our tree and per-polygon results
	each += settings.drop.visible_from.empty() ? 0U : 60U;                              // the tree of what the cameras see
	each += settings.drop.below > 0.0 ? 150U : 0U;                                      // lists of receivers
	each += settings.verify || settings.compensate || settings.detail_more ? 200U : 0U; // trees of volumes
	const uint64_t shares =
		settings.trim ? std::max<uint64_t>(settings.trim->most_shares, settings.trim->shares_each * triangles) : 0U;
	return (uint64_t{160} << 20U) + triangles * each + 16U * shares;
}

BuiltVolumes buildVolumes(const Level& level, const VolumeSettings& wanted, const RunSettings& run)
{
	assert(wanted.distance_m > 0.0 && std::isfinite(wanted.distance_m));
	refuseIf(level.triangles.empty(), level.name + ": triangles: found none, expected at least one", ExitCode::invalid_input);
	BuiltVolumes built;
	const VolumeSettings settings = withinMemory(level, wanted, built);
	VolumeSet& set = built.set;
	set.distance_m = settings.distance_m;
	set.exact_bounds = settings.exact_bounds;
	std::unique_ptr<Tracer> tracer;
	if (needsTracer(settings))
	{
		tracer = std::make_unique<Tracer>(level, run);
	}
	const std::vector<uint8_t> idle_backs =
		findOccluders(built, settings.occluding != nullptr ? *settings.occluding : level, tracer.get(), settings, run);
	VolumeSet all;
	if (settings.verify && (dropsAnything(settings.drop) || settings.trim))
	{
		all = set;
	}
	if (dropsAnything(settings.drop))
	{
		dropFrom(built, *tracer, settings, run);
	}
	if (isShare(run)) // which volumes remain, only all shares together know
	{
		if (settings.compensate)
		{
			compensationRays(*tracer, settings.distance_m, compensation(settings, idle_backs), run);
		}
		return built;
	}
	if (settings.trim)
	{
		trim(built, *tracer, *settings.trim, run);
	}
	set.ray_distance_m = settings.ray_distance_m > 0.0 ? settings.ray_distance_m
						 : settings.masks              ? set.distance_m
													   : set.distance_m / kPaperRayRatio;
	if (settings.compensate)
	{
		compensate(built, *tracer, compensation(settings, idle_backs), run);
	}
	if (settings.verify)
	{
		const std::vector<ReferencePoint> receivers = sampleReceivers(*tracer, set.distance_m, *settings.verify, run);
		built.verified = verifyVolumes(all.occluders.polygons.empty() ? set : all, set, receivers, run);
	}
	set.clusters.clear();
	warn(level, settings, built);
	return built;
}

DetailChoice chooseDetail(const Level& level, const Tracer& tracer, const OccluderSettings& settings, const DetailSettings& detail,
						  const RunSettings& run)
{
	assert(detail.more > 0.0 && detail.rays >= 1);
	Trials trials(level, tracer, settings, detail, run);
	DetailChoice choice;
	if (trials.points() == 0)
	{
		return choice; // nothing is visible
	}
	ProgressCounter progress(run.progress, "detail", 5);
	const DetailTrial whole = trials.whole();
	choice.points = trials.points();
	if (choice.points == 0)
	{
		return choice;
	}
	choice.trials.push_back(whole);
	progress.finishOne();
	// Steps from `good` on are acceptable; those before `unknown` are too coarse.
	std::size_t good = kLadder.size();
	std::size_t unknown = 0;
	DetailTrial best = whole;
	while (unknown < good)
	{
		const std::size_t middle = (unknown + good) / 2;
		const DetailTrial trial = trials.at(kLadder[middle]);
		choice.trials.push_back(trial);
		const double fitted_more = detail.fitted ? detail.more : kShapeMore * detail.more;
		const bool allowed = detail.masks
								 ? trial.paper_rmse <= (1.0 + detail.more) * whole.paper_rmse || trial.fitted_rmse <= kMaskError
								 : trial.fitted_rmse <= (1.0 + fitted_more) * whole.fitted_rmse &&
									   (detail.fitted || trial.paper_rmse <= (1.0 + detail.more) * whole.paper_rmse);
		(allowed ? good : unknown) = allowed ? middle : middle + 1;
		best = allowed ? trial : best;
		progress.finishOne();
	}
	if (static_cast<double>(best.polygons) <= kWorthIt * static_cast<double>(whole.polygons))
	{
		choice.detail = best.detail;
	}
	return choice;
}

AssetEstimate masksEstimate(const Level& level, const LevelFacts& facts, const RunSettings& run)
{
	std::vector<double> weights = sampleOf(level, facts.flat_of);
	const LevelPart part =
		partOf(level, mapped(weights, [](double weight) { return static_cast<uint8_t>(weight > 0.0 ? 1 : 0); }), run.threads);
	std::erase(weights, 0.0); // now of the part's triangles
	OccluderSettings settings;
	settings.distance_m = facts.radius_m;
	settings.gap_halvings = gapHalvings(level);
	settings.holes = 0.0;
	Occluders found;
	try
	{
		found = occludersOf(part.level, settings, silent(run)).occluders;
	}
	catch (const Error&) // no surface of the sample blocks light
	{
	}
	const auto triangles = static_cast<double>(level.triangles.size());
	double polygons = 0.0;
	double corners = 0.0;
	double leaves = 0.0;
	for (const Occluder& polygon : found.polygons)
	{
		const double weight = weights[polygon.triangle];
		polygons += weight;
		corners += weight * polygon.corner_count;
		leaves += isAlphaTested(part.level, polygon.triangle) ? weight : 0.0;
	}
	AssetEstimate masks;
	masks.bytes =
		cost::kMaskFile_bytes + cost::kMaskKept * (cost::kMaskCorner_bytes * corners + cost::kMaskPolygon_bytes * polygons);
	masks.seconds = cost::kStart_s + (level.cameras.empty() ? cost::kMaskCameras_s : 0.0) + cost::kMaskTriangle_s * triangles +
					cost::kMaskSheet_s * static_cast<double>(facts.sheets) + cost::kMaskLeaf_s * leaves;
	masks.memory_bytes = cost::kLeast_memory + cost::kMaskTriangle_memory * triangles + cost::kMaskPolygon_memory * polygons;
	return masks;
}

} // namespace nook
