// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (§5.4, figure 7: "over-fit curves"); M. Ayer, H. Brunk, G.
// Ewing, W. Reid, E. Silverman, An Empirical Distribution Function for Sampling with Incomplete Information, 1955 (pool adjacent
// violators).
#include "volume/compensate.h"

#include "core/lists.h"
#include "core/math.h"
#include "scene/camera_choice.h"
#include "volume/receivers.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <optional>

namespace nook
{

double Compensation::at(double sum) const
{
	const double last = static_cast<double>(occlusion.size() - 1);
	const double place = std::clamp(sum / range, 0.0, 1.0) * last;
	const auto knot = static_cast<std::size_t>(std::min(std::floor(place), last - 1.0));
	const double share = place - static_cast<double>(knot);
	return occlusion[knot] + share * (occlusion[knot + 1] - occlusion[knot]);
}

double Compensation::enough() const
{
	std::size_t knot = occlusion.size() - 1;
	while (knot > 0 && occlusion[knot - 1] == occlusion.back())
	{
		--knot;
	}
	return range * static_cast<double>(knot) / static_cast<double>(occlusion.size() - 1);
}

std::array<double, 33> Compensation::paper()
{
	std::array<double, 33> curve{};
	for (std::size_t i = 0; i < curve.size(); ++i)
	{
		const double x = static_cast<double>(i) / static_cast<double>(curve.size() - 1);
		curve[i] = x - 0.25 * x * x;
	}
	return curve;
}

// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV), eq. 14. Differences between pixels dominate it.
// Volumes add steeper ones than rays have, so the curve that fits best point by point does not have the least error.

namespace
{

// log†(x) of eq. 14.
double signedLog(double x)
{
	return x < 0.0 ? -logOf(1.0 - x) : logOf(1.0 + x);
}

constexpr uint64_t kAllKnots = ~uint64_t{0};

uint64_t knotsFrom(std::size_t first, std::size_t end)
{
	return ((uint64_t{1} << end) - 1) & ~((uint64_t{1} << first) - 1);
}

// The error's three means for a curve, and incrementally for curves of the same range that differ in a few knots.
class Meter
{
public:
	Meter(const Compensation& curve, std::span<const TripleValues> triples, CurveMeasure measure)
		: m_triples(triples), m_measure(measure), m_terms(triples.size())
	{
		const std::size_t last = curve.occlusion.size() - 1;
		for (const TripleValues& triple : triples)
		{
			Expected expected;
			expected.value =
				m_measure == CurveMeasure::rmse ? 1.0 - triple.occlusions[0] : signedLog(255.0 * (1.0 - triple.occlusions[0]));
			for (std::size_t i = 0; i < 3; ++i)
			{
				const double place = std::clamp(triple.sums[i] / curve.range, 0.0, 1.0) * static_cast<double>(last); // as the curve
				const std::size_t knot = std::min(static_cast<std::size_t>(place), last - 1);
				expected.knots |= knotsFrom(knot, knot + 2);
			}
			for (std::size_t i = 0; i < 2; ++i)
			{
				expected.steps[i] = signedLog(255.0 * (triple.occlusions[0] - triple.occlusions[i + 1]));
				m_steps[i] += triple.there[i + 1] ? 1.0 : 0.0;
			}
			m_expected.push_back(expected);
		}
		m_error = error(curve, kAllKnots);
		take();
	}

	// Error of the current curve.
	double error() const
	{
		return m_taken;
	}

	// Error of a curve that differs from the current one by at most these knots.
	double error(const Compensation& curve, uint64_t knots)
	{
		m_trial = m_terms;
		Terms sum;
		for (std::size_t k = 0; k < m_triples.size(); ++k)
		{
			if ((m_expected[k].knots & knots) != 0)
			{
				m_trial[k] = termsOf(curve, k);
			}
			sum.value += m_trial[k].value;
			sum.steps[0] += m_trial[k].steps[0];
			sum.steps[1] += m_trial[k].steps[1];
		}
		const auto mean = [](double of, double count)
		{
			return count > 0.0 ? of / count : 0.0;
		};
		m_error = mean(sum.value, static_cast<double>(m_triples.size())) +
				  0.5 * (mean(sum.steps[0], m_steps[0]) + mean(sum.steps[1], m_steps[1]));
		return m_error;
	}

	// Makes the last evaluated curve current.
	void take()
	{
		m_terms.swap(m_trial);
		m_taken = m_error;
	}

private:
	struct Terms
	{
		double value = 0.0;
		std::array<double, 2> steps{};
	};
	struct Expected
	{
		double value = 0.0;
		std::array<double, 2> steps{};
		uint64_t knots = 0; // knots that its values depend on
	};
	static double squared(double x)
	{
		return x * x;
	}
	Terms termsOf(const Compensation& curve, std::size_t k) const
	{
		const TripleValues& triple = m_triples[k];
		const double here = 255.0 * (1.0 - curve.at(triple.sums[0]));
		Terms terms;
		if (m_measure == CurveMeasure::rmse)
		{
			terms.value = squared(here / 255.0 - m_expected[k].value);
			return terms;
		}
		terms.value = squared(signedLog(here) - m_expected[k].value);
		for (std::size_t i = 0; i < 2; ++i)
		{
			if (triple.there[i + 1])
			{
				const double there = 255.0 * (1.0 - curve.at(triple.sums[i + 1]));
				terms.steps[i] = squared(signedLog(there - here) - m_expected[k].steps[i]);
			}
		}
		return terms;
	}

	std::span<const TripleValues> m_triples;
	CurveMeasure m_measure;
	std::vector<Expected> m_expected;
	std::array<double, 2> m_steps{};
	std::vector<Terms> m_terms; // for the current curve
	std::vector<Terms> m_trial; // for the last evaluated curve
	double m_taken = 0.0;
	double m_error = 0.0;
};

bool isRising(const Compensation& curve)
{
	return curve.occlusion[0] == 0.0 && std::is_sorted(curve.occlusion.begin(), curve.occlusion.end()) &&
		   curve.occlusion.back() <= 1.0;
}

// The quantity compared by AOV eq. 14: log(T + 1) of the 8-bit visibility T.
double logOfVisibility(double occlusion)
{
	return logOf(255.0 * std::clamp(1.0 - occlusion, 0.0, 1.0) + 1.0);
}

// The non-decreasing sequence with the least weighted sum of squared differences.
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

// Normal equations for minimising Σ w (value − Σ hat_k knot_k)² + λ Σ (second differences)² with knot 0 fixed at 0; pentadiagonal.
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
	const double stiffness = 1e-3 * total; // tuned on Sponza: smooth where points are sparse, free where they are dense
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
		matrix[k][0] = 0.0; // fixes knot 0 at 0
	}
	return equations;
}

// Gaussian elimination without pivoting: the matrix is positive definite. Not done with Eigen, because the curve is stored with all
// its digits, which Eigen's vector width would change.
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

// Occlusions of the points, one list per radius.
std::vector<std::vector<double>> occlusionsOf(const Tracer& tracer, std::span<const ReferencePoint> points,
											  std::span<const double> radii_m, const CompensateSettings& settings,
											  const RunSettings& run)
{
	ReferenceSettings reference{.falloff = Falloff::linear, .rays = settings.rays, .seed = settings.seed};
	std::vector<std::vector<double>> lists = visibilitiesWithin(tracer, points, reference, radii_m, run);
	for (std::vector<double>& list : lists)
	{
		std::transform(list.begin(), list.end(), list.begin(), [](double visibility) { return 1.0 - visibility; });
	}
	return lists;
}

// Values at the first `corners` points of each triple, with the same directions for all, so that their noise cancels in the
// differences.
std::vector<TripleValues> valuesOf(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings,
								   std::span<const PictureTriple> triples, std::size_t corners, double radius_m,
								   const RunSettings& run, ProgressCounter& progress)
{
	std::vector<TripleValues> values(triples.size());
	std::vector<ReferencePoint> points(triples.size());
	for (std::size_t corner = 0; corner < corners; ++corner)
	{
		for (std::size_t i = 0; i < triples.size(); ++i)
		{
			points[i] = triples[i].points[corner];
			values[i].there[corner] = triples[i].there[corner];
		}
		const std::vector<double> sums = sumsAt(volumes, points, run);
		const std::vector<double> occlusions = occlusionsOf(tracer, points, std::array{radius_m}, settings, run).front();
		for (std::size_t i = 0; i < triples.size(); ++i)
		{
			values[i].sums[corner] = sums[i];
			values[i].occlusions[corner] = occlusions[i];
		}
		progress.finishOne();
	}
	return values;
}

// Compares with the paper's curve in held-out views.
void checkCurve(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings, const RunSettings& run,
				ProgressCounter& progress, CompensateResult& result)
{
	const std::vector<PictureTriple> triples = pictureTriples(tracer, settings.kept_out, run);
	const std::vector<TripleValues> values = valuesOf(volumes, tracer, settings, triples, 3, result.ray_distance_m, run, progress);
	if (values.empty())
	{
		return;
	}
	const auto check = [&](std::size_t begin, std::size_t end)
	{
		const std::span<const TripleValues> of(values.data() + begin, end - begin);
		return CurveCheck{of.size(), errorsOf(Compensation{}, of), errorsOf(result.curve, of)};
	};
	forRuns(
		triples, [](const PictureTriple& a, const PictureTriple& b) { return a.view == b.view; },
		[&](std::size_t begin, std::size_t end) { result.views.push_back(check(begin, end)); });
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

std::vector<PictureTriple> pictureTriples(const Tracer& tracer, const PictureSettings& settings, const RunSettings& run)
{
	if (settings.views < 1 || settings.per_view < 1)
	{
		return {};
	}
	const auto [width, height] = settings.size;
	const double columns = std::ceil(std::sqrt(static_cast<double>(settings.per_view) * width / height));
	const double rows = std::ceil(settings.per_view / columns);
	std::vector<PictureTriple> triples;
	const std::vector<LevelCamera> cameras = chooseCameras(tracer, settings.skipped + settings.views, run);
	for (auto view = static_cast<std::size_t>(settings.skipped); view < cameras.size(); ++view)
	{
		const Eye eye(tracer, cameras[view], width, height);
		for (double row = 0.0; row < rows; row += 1.0)
		{
			for (double column = 0.0; column < columns; column += 1.0)
			{
				const double x = std::floor((column + 0.5) * width / columns) + 0.5;
				const double y = std::floor((row + 0.5) * height / rows) + 0.5;
				const std::optional<ReferencePoint> here = eye.at(x, y);
				if (!here)
				{
					continue;
				}
				const std::optional<ReferencePoint> right = eye.at(x + 1.0, y);
				const std::optional<ReferencePoint> below = eye.at(x, y + 1.0);
				triples.push_back({{*here, right.value_or(*here), below.value_or(*here)},
								   {true, right.has_value(), below.has_value()},
								   static_cast<int>(view)});
			}
		}
	}
	return triples;
}

double curveError(const Compensation& curve, std::span<const TripleValues> triples, CurveMeasure measure)
{
	return Meter(curve, triples, measure).error();
}

Compensation fitToPictures(const Compensation& start, std::span<const TripleValues> triples, CurveMeasure measure)
{
	assert(isRising(start));
	Meter meter(start, triples, measure);
	Compensation best = start;
	const std::size_t count = best.occlusion.size();
	const auto change = [&](std::size_t first, std::size_t end, double by)
	{
		Compensation curve = best;
		for (std::size_t i = first; i < end; ++i)
		{
			curve.occlusion[i] = std::clamp(curve.occlusion[i] + by, 0.0, 1.0);
		}
		if (isRising(curve) && meter.error(curve, knotsFrom(first, end)) < meter.error())
		{
			meter.take();
			best = curve;
		}
	};
	for (double step = 0.04; step > 0.002; step *= 0.5)
	{
		for (int repeat = 0; repeat < 3; ++repeat)
		{
			for (std::size_t first = 1; first < count; ++first)
			{
				// Moves one knot, a few, and all from there on.
				for (const std::size_t knots : {std::size_t{1}, std::size_t{4}, count})
				{
					change(first, std::min(first + knots, count), -step);
					change(first, std::min(first + knots, count), step);
				}
			}
		}
	}
	return best;
}

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
	errors.eq14 = curveError(curve, triples);
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

	// The range covers all but the last thousandth of the sums; beyond it the curve is constant.
	Compensation curve{.range = std::max(0.125, sums[order[(order.size() - 1) - order.size() / 1000]])};

	// Eq. 14's logarithms of visibility fall with the sum; their negatives rise.
	const auto places = mapped(order, [&](std::size_t i) { return sums[i] / curve.range; });
	const auto logs = mapped(order, [&](std::size_t i) { return -logOfVisibility(occlusions[i]); });
	std::vector<double> weights(logs.size(), 1.0);
	const std::vector<double> fitted = isotonic(logs, weights);
	std::vector<double> values;
	for (std::size_t i = 0; i < fitted.size(); ++i)
	{
		values.push_back(std::clamp(1.0 - (expOf(-fitted[i]) - 1.0) / 255.0, 0.0, 1.0)); // its inverse
		const double slope = 255.0 / (255.0 * (1.0 - values.back()) + 1.0);              // derivative of the logarithm
		weights[i] = slope * slope;
	}

	const Knots knots = solved(normalEquations(places, values, weights));
	const std::vector<double> rising = isotonic(knots, std::vector<double>(knots.size(), 1.0));
	for (std::size_t k = 1; k < knots.size(); ++k)
	{
		curve.occlusion[k] = std::clamp(rising[k], 0.0, 1.0);
	}
	curve.occlusion[0] = 0.0; // keeps an open plane white
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
	const ReceiverSettings receivers{settings.views, settings.per_view, settings.by_area, 0, settings.seed, settings.idle_backs};
	CompensationRays rays;
	rays.points = sampleReceivers(tracer, distance_m, receivers, run);
	rays.ratios = settings.ray_distance_m > 0.0 ? std::vector<double>{distance_m / settings.ray_distance_m}
												: std::vector<double>{0.5, 0.55, 0.6, 0.65, 0.7, 0.8, 0.9, 1.0};
	if (!rays.points.empty())
	{
		const std::vector<double> radii_m = mapped(rays.ratios, [distance_m](double ratio) { return distance_m / ratio; });
		rays.occlusions = occlusionsOf(tracer, rays.points, radii_m, settings, run);
	}
	if (progress != nullptr)
	{
		progress->finishOne();
	}
	return rays;
}

CompensateResult compensateVolumes(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings,
								   const RunSettings& run)
{
	const std::size_t corners = settings.measure == CurveMeasure::rmse ? 1 : 3; // eq. 14 needs the neighbours
	ProgressCounter progress(run.progress, "compensation", corners + 4);        // number of ray-tracing passes
	const CompensationRays rays = compensationRays(tracer, volumes.distance_m, settings, run, &progress);
	CompensateResult result;
	result.receivers = rays.points.size();
	result.ray_distance_m = volumes.distance_m / kPaperRayRatio;
	if (rays.points.empty())
	{
		return result; // nothing is visible: any curve fits
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
	const RunSettings whole = withoutUnits(run);
	const std::vector<PictureTriple> triples = pictureTriples(tracer, settings.pictures, whole);
	const std::vector<TripleValues> values =
		valuesOf(volumes, tracer, settings, triples, corners, result.ray_distance_m, whole, progress);
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
