// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (§5.4, figure 7: "over-fit curves"); M. Ayer, H. Brunk, G.
// Ewing, W. Reid, E. Silverman, An Empirical Distribution Function for Sampling with Incomplete Information, 1955 (pool adjacent
// violators).
#include "volume/compensate.h"

#include "core/math.h"
#include "volume/verify.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

namespace nook
{
namespace
{

// What AOV eq. 14 compares: log(T + 1) of the 8-bit visibility T.
double logOfVisibility(double occlusion)
{
	return logOf(255.0 * std::clamp(1.0 - occlusion, 0.0, 1.0) + 1.0);
}

double occlusionOfLog(double log)
{
	return std::clamp(1.0 - (expOf(log) - 1.0) / 255.0, 0.0, 1.0);
}

// The rising sequence with the least weighted sum of squared differences.
std::vector<double> isotonic(std::span<const double> values, std::span<const double> weights)
{
	struct Pool
	{
		double mean;
		double weight;
		std::size_t count;
	};
	std::vector<Pool> pools;
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		pools.push_back({values[i], weights[i], 1});
		while (pools.size() > 1 && pools[pools.size() - 2].mean >= pools.back().mean)
		{
			const Pool last = pools.back();
			pools.pop_back();
			Pool& before = pools.back();
			const double weight = before.weight + last.weight;
			before.mean = (before.mean * before.weight + last.mean * last.weight) / weight;
			before.weight = weight;
			before.count += last.count;
		}
	}
	std::vector<double> result;
	result.reserve(values.size());
	for (const Pool& pool : pools)
	{
		result.insert(result.end(), pool.count, pool.mean);
	}
	return result;
}

using Knots = std::array<double, 33>;

constexpr std::size_t kKnots = std::tuple_size_v<Knots>;

struct NormalEquations
{
	std::array<std::array<double, kKnots>, kKnots> matrix{};
	Knots right{};
};

// Of Σ w (value − Σ hat_k knot_k)² + λ Σ (second differences)², knot 0 held at 0: a band of two beside the diagonal.
NormalEquations normalEquations(std::span<const double> places, std::span<const double> values, std::span<const double> weights)
{
	constexpr std::size_t n = kKnots;
	NormalEquations equations;
	auto& [matrix, right] = equations;
	double total = 0.0;
	for (std::size_t i = 0; i < places.size(); ++i)
	{
		const double at = std::clamp(places[i], 0.0, 1.0) * static_cast<double>(n - 1);
		const auto k = static_cast<std::size_t>(std::min(std::floor(at), static_cast<double>(n - 2)));
		const double share = at - static_cast<double>(k);
		matrix[k][k] += weights[i] * (1.0 - share) * (1.0 - share);
		matrix[k][k + 1] += weights[i] * share * (1.0 - share);
		matrix[k + 1][k] += weights[i] * share * (1.0 - share);
		matrix[k + 1][k + 1] += weights[i] * share * share;
		right[k] += weights[i] * (1.0 - share) * values[i];
		right[k + 1] += weights[i] * share * values[i];
		total += weights[i];
	}
	const double stiffness = 1e-3 * total; // tuned on Sponza: smooth where points are few, free where they are many
	for (std::size_t k = 1; k + 1 < n; ++k)
	{
		constexpr std::array<double, 3> bend{1.0, -2.0, 1.0};
		for (std::size_t i = 0; i < 3; ++i)
		{
			for (std::size_t j = 0; j < 3; ++j)
			{
				matrix[k - 1 + i][k - 1 + j] += stiffness * bend[i] * bend[j];
			}
		}
	}
	matrix[0].fill(0.0);
	matrix[0][0] = 1.0;
	right[0] = 0.0;
	for (std::size_t k = 1; k < n; ++k)
	{
		matrix[k][0] = 0.0; // knot 0 is 0
	}
	return equations;
}

// By Gauss without pivots: the matrix is positive definite. Ours, not Eigen's: the curve goes into files with all its digits, and
// sums in another order, as wider registers make them, would change these.
Knots solved(NormalEquations equations)
{
	constexpr std::size_t n = kKnots;
	auto& [matrix, right] = equations;
	for (std::size_t k = 0; k < n; ++k)
	{
		for (std::size_t i = k + 1; i < std::min(n, k + 3); ++i)
		{
			const double factor = matrix[i][k] / matrix[k][k];
			for (std::size_t j = k; j < std::min(n, k + 3); ++j)
			{
				matrix[i][j] -= factor * matrix[k][j];
			}
			right[i] -= factor * right[k];
		}
	}
	Knots knots{};
	for (std::size_t k = n; k-- > 0;)
	{
		double rest = right[k];
		for (std::size_t j = k + 1; j < std::min(n, k + 3); ++j)
		{
			rest -= matrix[k][j] * knots[j];
		}
		knots[k] = rest / matrix[k][k];
	}
	return knots;
}

double varianceOf(std::span<const double> occlusions)
{
	double sum = 0.0;
	double squares = 0.0;
	for (const double occlusion : occlusions)
	{
		const double log = logOfVisibility(occlusion);
		sum += log;
		squares += log * log;
	}
	const auto count = static_cast<double>(occlusions.size());
	return squares / count - (sum / count) * (sum / count);
}

std::vector<double> referenceOf(const Tracer& tracer, std::span<const ReferencePoint> points, double radius_m,
								const CompensateSettings& settings, const RunSettings& run)
{
	ReferenceSettings reference;
	reference.falloff = Falloff::linear;
	reference.radius_m = radius_m;
	reference.rays = settings.rays;
	reference.seed = settings.seed;
	std::vector<double> occlusions;
	occlusions.reserve(points.size());
	for (const ReferenceValue& value : referenceAtPoints(tracer, points, reference, run))
	{
		occlusions.push_back(1.0 - value.visibility);
	}
	return occlusions;
}

// The same directions for all three points of a triple: what rays miss is missed in each, so that differences have little noise.
std::vector<TripleValues> valuesOf(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings,
								   std::span<const PictureTriple> triples, double radius_m, const RunSettings& run,
								   ProgressCounter& progress)
{
	std::vector<TripleValues> values(triples.size());
	std::vector<ReferencePoint> points(triples.size());
	for (std::size_t corner = 0; corner < 3; ++corner)
	{
		for (std::size_t i = 0; i < triples.size(); ++i)
		{
			points[i] = triples[i].points[corner];
			values[i].there = triples[i].there;
		}
		const std::vector<double> sums = sumsAt(volumes, points, run);
		const std::vector<double> occlusions = referenceOf(tracer, points, radius_m, settings, run);
		for (std::size_t i = 0; i < triples.size(); ++i)
		{
			values[i].sums[corner] = sums[i];
			values[i].occlusions[corner] = occlusions[i];
		}
		progress.finishOne();
	}
	return values;
}

// Against the paper's curve, in views that were kept out.
void checkCurve(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings, const RunSettings& run,
				ProgressCounter& progress, CompensateResult& result)
{
	const std::vector<PictureTriple> triples = pictureTriples(tracer, settings.kept_out, run);
	const std::vector<TripleValues> values = valuesOf(volumes, tracer, settings, triples, result.ray_distance_m, run, progress);
	if (values.empty())
	{
		return;
	}
	const auto check = [&](std::size_t begin, std::size_t end)
	{
		const std::span<const TripleValues> of(values.data() + begin, end - begin);
		return CurveCheck{of.size(), errorsOf(Compensation{}, of), errorsOf(result.curve, of)};
	};
	for (std::size_t begin = 0; begin < triples.size();)
	{
		std::size_t end = begin + 1;
		while (end < triples.size() && triples[end].view == triples[begin].view)
		{
			++end;
		}
		result.views.push_back(check(begin, end));
		begin = end;
	}
	result.check = check(0, values.size());
	const CurveErrors& before = result.check.before;
	const CurveErrors& after = result.check.after;
	result.refused = settings.measure == CurveMeasure::rmse ? after.rmse > before.rmse : after.eq14 > before.eq14;
	if (result.refused)
	{
		result.curve = Compensation{};
		result.ray_distance_m = settings.ray_distance_m > 0.0 ? settings.ray_distance_m : volumes.distance_m / kPaperRayRatio;
	}
}

} // namespace

CurveErrors errorsOf(const Compensation& curve, std::span<const TripleValues> triples)
{
	assert(!triples.empty());
	CurveErrors errors;
	for (const TripleValues& triple : triples)
	{
		const double difference = triple.occlusions[0] - curve.at(triple.sums[0]);
		errors.rmse += difference * difference;
		errors.mean += difference;
	}
	const auto count = static_cast<double>(triples.size());
	errors.rmse = std::sqrt(errors.rmse / count);
	errors.mean /= count;
	errors.eq14 = pictureError(curve, triples);
	return errors;
}

double logResidual(const Compensation& curve, std::span<const double> sums, std::span<const double> occlusions)
{
	assert(sums.size() == occlusions.size() && !sums.empty());
	double squares = 0.0;
	for (std::size_t i = 0; i < sums.size(); ++i)
	{
		const double difference = logOfVisibility(curve.at(sums[i])) - logOfVisibility(occlusions[i]);
		squares += difference * difference;
	}
	return squares / static_cast<double>(sums.size());
}

Compensation fitCurve(std::span<const double> sums, std::span<const double> occlusions)
{
	assert(sums.size() == occlusions.size() && !sums.empty());
	std::vector<std::size_t> order(sums.size());
	std::iota(order.begin(), order.end(), std::size_t{0});
	std::sort(order.begin(), order.end(),
			  [&](std::size_t a, std::size_t b) { return sums[a] != sums[b] ? sums[a] < sums[b] : a < b; });

	// The range: all but the last thousandth of the sums; beyond, the curve is constant.
	Compensation curve;
	curve.range = std::max(0.125, sums[order[(order.size() - 1) - order.size() / 1000]]);

	// Eq. 14's logarithms of visibility fall with the sum: their negatives rise.
	std::vector<double> places;
	std::vector<double> logs;
	for (const std::size_t i : order)
	{
		places.push_back(sums[i] / curve.range);
		logs.push_back(-logOfVisibility(occlusions[i]));
	}
	std::vector<double> weights(logs.size(), 1.0);
	const std::vector<double> fitted = isotonic(logs, weights);
	std::vector<double> values;
	for (std::size_t i = 0; i < fitted.size(); ++i)
	{
		values.push_back(occlusionOfLog(-fitted[i]));
		const double slope = 255.0 / (255.0 * (1.0 - values.back()) + 1.0); // of the logarithm
		weights[i] = slope * slope;
	}

	const Knots knots = solved(normalEquations(places, values, weights));
	const std::vector<double> rising = isotonic(knots, std::vector<double>(knots.size(), 1.0));
	for (std::size_t k = 1; k < knots.size(); ++k)
	{
		curve.occlusion[k] = std::clamp(rising[k], 0.0, 1.0);
	}
	curve.occlusion[0] = 0.0; // an open plane stays white
	return curve;
}

std::size_t bestOf(std::span<const RatioTrial> trials)
{
	const auto nearest = std::min_element(trials.begin(), trials.end(),
										  [](const RatioTrial& a, const RatioTrial& b)
										  { return std::fabs(a.ratio - kPaperRayRatio) < std::fabs(b.ratio - kPaperRayRatio); });
	auto best = static_cast<std::size_t>(nearest - trials.begin());
	for (std::size_t i = 0; i < trials.size(); ++i)
	{
		const bool first = !(trials[best].variance > 0.0);
		if (trials[i].variance > 0.0 && (first || trials[i].unexplained() < trials[best].unexplained() ||
										 (trials[i].unexplained() == trials[best].unexplained() && i < best)))
		{
			best = i;
		}
	}
	return best;
}

CompensationRays compensationRays(const Tracer& tracer, double distance_m, const CompensateSettings& settings,
								  const RunSettings& run, ProgressCounter* progress)
{
	const ReceiverSettings receivers{settings.views, settings.per_view, settings.by_area, 0, settings.seed};
	CompensationRays rays;
	rays.points = sampleReceivers(tracer, distance_m, receivers, run);
	rays.ratios = settings.ray_distance_m > 0.0 ? std::vector<double>{distance_m / settings.ray_distance_m}
												: std::vector<double>{0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 0.9, 1.0};
	for (std::size_t i = 0; i < rays.ratios.size() && !rays.points.empty(); ++i)
	{
		rays.occlusions.push_back(referenceOf(tracer, rays.points, distance_m / rays.ratios[i], settings, run));
		if (progress != nullptr)
		{
			progress->finishOne();
		}
	}
	return rays;
}

CompensateResult compensateVolumes(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings,
								   const RunSettings& run)
{
	const std::size_t ratios = settings.ray_distance_m > 0.0 ? 1 : 8;
	ProgressCounter progress(run.progress, "compensation", ratios + 6); // times that rays are traced
	const CompensationRays rays = compensationRays(tracer, volumes.distance_m, settings, run, &progress);
	CompensateResult result;
	result.receivers = rays.points.size();
	result.ray_distance_m = volumes.distance_m / kPaperRayRatio;
	if (rays.points.empty())
	{
		return result; // nothing can be seen: any curve fits
	}
	const std::vector<double> sums = sumsAt(volumes, rays.points, run);
	std::vector<Compensation> curves;
	for (std::size_t i = 0; i < rays.ratios.size(); ++i)
	{
		const std::vector<double>& occlusions = rays.occlusions[i];
		curves.push_back(fitCurve(sums, occlusions));
		RatioTrial trial;
		trial.ratio = rays.ratios[i];
		trial.paper = logResidual(Compensation{}, sums, occlusions);
		trial.fitted = logResidual(curves.back(), sums, occlusions);
		trial.variance = varianceOf(occlusions);
		result.trials.push_back(trial);
	}
	result.best = bestOf(result.trials);
	result.curve = curves[result.best];
	result.ray_distance_m = volumes.distance_m / result.trials[result.best].ratio;
	const RunSettings whole = undivided(run);
	const std::vector<PictureTriple> triples = pictureTriples(tracer, settings.pictures, whole);
	const std::vector<TripleValues> values = valuesOf(volumes, tracer, settings, triples, result.ray_distance_m, whole, progress);
	result.triples = values.size();
	if (!values.empty())
	{
		result.error_before = curveError(result.curve, values, settings.measure);
		result.curve = fitToPictures(result.curve, values, settings.measure);
		result.error = curveError(result.curve, values, settings.measure);
	}
	checkCurve(volumes, tracer, settings, whole, progress, result);
	return result;
}

} // namespace nook
