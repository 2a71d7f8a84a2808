// SPDX-License-Identifier: GPL-3.0-or-later
// A level, its volumes, its reference by rays → the curve from sums to occlusion that fits this level (AOV §5.4), and the radius of
// the linear falloff that these volumes stand for (AOV §6).
#pragma once

#include "core/progress.h"
#include "scene/reference.h"
#include "scene/tracer.h"
#include "volume/picture_error.h"
#include "volume/volumes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// δ_AOV = 0.6 δ_ray (AOV §6).
inline constexpr double kPaperRayRatio = 0.6;

struct CompensateSettings
{
	int views = 6;      // auto cameras whose points are fitted to
	int per_view = 800; // points of each
	int by_area = 2000; // points over all visible surfaces
	int rays = 512;     // of the reference at each point
	uint32_t seed = 1;
	double ray_distance_m = 0.0;               // of the reference; 0: the best of some
	PictureSettings pictures;                  // that the curve is fitted to in the end; no views: it stays as it was at the points
	CurveMeasure measure = CurveMeasure::rmse; // that it is fitted to there, and may not make worse in views that were kept out
	PictureSettings kept_out{4, 8, 400};       // views after those; none: nothing is refused
};

// Errors against rays at points that a curve was not fitted to.
struct CurveErrors
{
	double rmse = 0.0; // of visibility
	double mean = 0.0; // drawn less rays: below 0 is too dark
	double eq14 = 0.0; // AOV's
};

CurveErrors errorsOf(const Compensation& curve, std::span<const TripleValues> triples);

// The paper's curve and the fitted one.
struct CurveCheck
{
	std::size_t triples = 0;
	CurveErrors before;
	CurveErrors after;
};

struct RatioTrial
{
	double ratio = kPaperRayRatio; // δ / ray radius
	double paper = 0.0;            // mean squared difference of log(8-bit visibility + 1), with the paper's curve
	double fitted = 0.0;           // with the curve fitted at that ratio
	double variance = 0.0;         // of the reference's logarithms: shorter rays leave less to tell

	double unexplained() const
	{
		return variance > 0.0 ? fitted / variance : 0.0;
	}
};

// What rays say at the points that a curve is fitted to: of the level alone, whatever its volumes.
struct CompensationRays
{
	std::vector<ReferencePoint> points;
	std::vector<double> ratios;                  // distance of volumes / radius of rays
	std::vector<std::vector<double>> occlusions; // by ratio, then by point; empty where there is no point
};
CompensationRays compensationRays(const Tracer& tracer, double distance_m, const CompensateSettings& settings,
								  const RunSettings& run, ProgressCounter* progress = nullptr);

struct CompensateResult
{
	Compensation curve;
	double ray_distance_m = 0.0;
	std::size_t receivers = 0;
	std::vector<RatioTrial> trials; // in rising order of ratio
	std::size_t best = 0;           // of the trials: bestOf()
	std::size_t triples = 0;        // of pictures
	double error_before = 0.0;      // error at these, with the curve of the points
	double error = 0.0;             // with the final one, each by the measure
	CurveCheck check;               // of all views that were kept out, with the fitted curve
	std::vector<CurveCheck> views;  // of each
	bool refused = false;           // the fitted curve is worse there: `curve` is the paper's
};

// The trial that leaves the least share of the variance unexplained, the first of several; where nothing varies that could tell,
// the one nearest to the paper's ratio. Requires one.
std::size_t bestOf(std::span<const RatioTrial> trials);

// The curve alone: isotonic regression (pool adjacent violators) of log(8-bit visibility + 1), which is what AOV eq. 14 compares,
// then 33 knots by least squares. 0 at 0: what nothing darkens stays white. Requires as many sums as occlusions, ≥ 1.
Compensation fitCurve(std::span<const double> sums, std::span<const double> occlusions);

// Mean squared difference of log(8-bit visibility + 1): the first term of AOV eq. 14 over a list of points.
double logResidual(const Compensation& curve, std::span<const double> sums, std::span<const double> occlusions);

CompensateResult compensateVolumes(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings,
								   const RunSettings& run);

} // namespace nook
