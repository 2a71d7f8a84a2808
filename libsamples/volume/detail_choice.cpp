// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/detail_choice.h"

#include "scene/reference.h"
#include "volume/compensate.h"

#include <array>
#include <cassert>
#include <cmath>
#include <span>

namespace nook
{
namespace
{

constexpr std::array<double, 19> kLadder{0.08,  0.067, 0.057, 0.048,  0.04,  0.034, 0.028, 0.024,  0.02,  0.017,
										 0.014, 0.012, 0.01,  0.0084, 0.007, 0.006, 0.005, 0.0042, 0.0035};
// With the paper's curve, the error under the best-fitting curve may grow by this multiple of the allowed fraction: the paper's
// bias can hide facets, which fitting a curve later could not correct. builtin:cave at 1 m: 0.024, a sixth of the bytes, and 3 %
// more error in pictures.
constexpr double kShapeMore = 3.0;
constexpr double kWorthIt = 0.9; // of the polygons; if simplification keeps more, it does not pay

double rmseOf(const Compensation& curve, std::span<const double> sums, std::span<const double> occlusions)
{
	double squares = 0.0;
	for (std::size_t i = 0; i < sums.size(); ++i)
	{
		const double difference = curve.at(sums[i]) - occlusions[i];
		squares += difference * difference;
	}
	return std::sqrt(squares / static_cast<double>(sums.size()));
}

class Trials
{
public:
	Trials(const Level& level, const Tracer& tracer, const OccluderSettings& settings, const DetailSettings& detail,
		   const RunSettings& run)
		: m_level(level), m_settings(settings), m_exact(detail.exact_bounds), m_run(run),
		  m_points(sampleReceivers(tracer, settings.distance_m, detail.receivers, run))
	{
		ReferenceSettings reference;
		reference.falloff = Falloff::linear;
		reference.radius_m = detail.ray_distance_m > 0.0 ? detail.ray_distance_m : settings.distance_m / kPaperRayRatio;
		reference.rays = detail.rays;
		for (const ReferenceValue& value : referenceAtPoints(tracer, m_points, reference, run))
		{
			m_occlusions.push_back(1.0 - value.visibility);
		}
	}

	std::size_t points() const
	{
		return m_points.size();
	}

	DetailTrial at(double share) const
	{
		OccluderSettings settings = m_settings;
		settings.detail = share;
		settings.before_cutting = nullptr;
		VolumeSet set;
		set.distance_m = m_settings.distance_m;
		set.exact_bounds = m_exact;
		set.occluders = occludersOf(m_level, settings, m_run).occluders;
		const std::vector<double> sums = sumsAt(set, m_points, m_run);
		return {share, set.occluders.polygons.size(), rmseOf(Compensation{}, sums, m_occlusions),
				rmseOf(fitCurve(sums, m_occlusions), sums, m_occlusions)};
	}

private:
	const Level& m_level;
	const OccluderSettings& m_settings;
	bool m_exact;
	const RunSettings& m_run;
	std::vector<ReferencePoint> m_points;
	std::vector<double> m_occlusions;
};

} // namespace

DetailChoice chooseDetail(const Level& level, const Tracer& tracer, const OccluderSettings& settings, const DetailSettings& detail,
						  const RunSettings& run)
{
	assert(detail.more > 0.0 && detail.rays >= 1);
	const Trials trials(level, tracer, settings, detail, run);
	DetailChoice choice;
	choice.points = trials.points();
	if (choice.points == 0)
	{
		return choice; // nothing is visible
	}
	ProgressCounter progress(run.progress, "detail", 5);
	const DetailTrial whole = trials.at(0.0);
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
		const bool allowed = trial.fitted_rmse <= (1.0 + fitted_more) * whole.fitted_rmse &&
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

} // namespace nook
