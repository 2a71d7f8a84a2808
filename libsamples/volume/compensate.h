// SPDX-License-Identifier: GPL-3.0-or-later
// Fits the curve from summed to actual occlusion to a level's ray-traced reference (AOV §5.4), and finds the radius of the linear
// falloff that its volumes correspond to (AOV §6).
#pragma once

#include "core/progress.h"
#include "scene/reference.h"
#include "scene/tracer.h"
#include "volume/volumes.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// Samples points with their neighbours from pictures of a level's cameras, evaluates AOV eq. 14 there for a curve from sums to
// occlusion, and finds the curve that minimises it.

// The surface of a pixel, of the pixel to its right, and of the one below; a neighbour that is sky repeats the first.
struct PictureTriple
{
	std::array<ReferencePoint, 3> points;
	std::array<bool, 3> there{true, false, false};
	int view = 0; // index among the chosen cameras
};

struct PictureSettings
{
	int views = 8;                      // automatic cameras
	int skipped = 0;                    // number of automatic cameras to skip before these
	int per_view = 1200;                // triples per view, on a grid
	std::array<int, 2> size{1280, 720}; // picture size, pixels
};

std::vector<PictureTriple> pictureTriples(const Tracer& tracer, const PictureSettings& settings, const RunSettings& run);

// Summed occlusion of volumes and ray-traced occlusion at a triple's points.
struct TripleValues
{
	std::array<double, 3> sums{};
	std::array<double, 3> occlusions{};
	std::array<bool, 3> there{true, false, false};
};

// Objective of the curve's fit.
enum class CurveMeasure
{
	eq14, // AOV's: logarithms of values, not rounded to 8 bits, and of the differences to neighbours
	rmse, // visibility error at the triples' first points
};

// Error by either measure; for rmse its square.
double curveError(const Compensation& curve, std::span<const TripleValues> triples, CurveMeasure measure = CurveMeasure::eq14);

// Starts with `start` and keeps its range; moves knots in ever smaller steps while the error falls. The result is non-decreasing
// and 0 at 0.
Compensation fitToPictures(const Compensation& start, std::span<const TripleValues> triples,
						   CurveMeasure measure = CurveMeasure::eq14);

// δ_AOV = 0.6 δ_ray (AOV §6).
inline constexpr double kPaperRayRatio = 0.6;

struct CompensateSettings
{
	int views = 6;      // automatic cameras for the fit's points
	int per_view = 800; // points per view
	int by_area = 2000; // points spread over all visible surfaces
	int rays = 512;     // reference rays per point
	uint32_t seed = 1;
	double ray_distance_m = 0.0;               // radius of the reference; 0: the best of several
	PictureSettings pictures;                  // for the final fit of the curve; without views it keeps the fit to points
	CurveMeasure measure = CurveMeasure::rmse; // objective of that fit, which must also not get worse in held-out views
	PictureSettings kept_out{4, 8, 400};       // held-out views, chosen after the others; none: accept any fit
	std::span<const uint8_t> idle_backs{};     // as in ReceiverSettings
};

// Errors against rays at points that were not used for the fit.
struct CurveErrors
{
	double rmse = 0.0; // visibility
	double mean = 0.0; // drawn minus ray-traced: negative is too dark
	double eq14 = 0.0; // AOV's error measure
};

CurveErrors errorsOf(const Compensation& curve, std::span<const TripleValues> triples);

// Errors of the paper's curve and of the fitted one.
struct CurveCheck
{
	std::size_t triples = 0;
	CurveErrors before;
	CurveErrors after;
};

struct RatioTrial
{
	double ratio = kPaperRayRatio; // δ / ray radius
	double paper = 0.0;            // mean squared difference of log(8-bit visibility + 1) with the paper's curve
	double fitted = 0.0;           // with the curve fitted for that ratio
	double variance = 0.0;         // variance of the reference's logarithms, which is smaller for shorter rays

	double unexplained() const
	{
		return variance > 0.0 ? fitted / variance : 0.0;
	}
};

// Ray-traced reference at the fit's points. Depends only on the level, not on its volumes.
struct CompensationRays
{
	std::vector<ReferencePoint> points;
	std::vector<double> ratios;                  // volume distance / ray radius
	std::vector<std::vector<double>> occlusions; // by ratio, then by point; empty without points
};
CompensationRays compensationRays(const Tracer& tracer, double distance_m, const CompensateSettings& settings,
								  const RunSettings& run, ProgressCounter* progress = nullptr);

struct CompensateResult
{
	Compensation curve;
	double ray_distance_m = 0.0;
	std::size_t receivers = 0;
	std::vector<RatioTrial> trials; // in ascending order of ratio
	std::size_t best = 0;           // index of bestOf() in trials
	std::size_t triples = 0;        // number of picture triples
	double error_before = 0.0;      // error at the triples with the curve fitted to points
	double error = 0.0;             // error at the triples with the final curve
	CurveCheck check;               // the fitted curve over all held-out views
	std::vector<CurveCheck> views;  // per held-out view
	bool refused = false;           // the fitted curve was worse in held-out views, so `curve` is the paper's
};

// Index of the trial with the least unexplained fraction of the variance, the first in case of a tie; without any variance, the one
// closest to the paper's ratio. Requires at least one.
std::size_t bestOf(std::span<const RatioTrial> trials);

// Fits the curve only: isotonic regression (pool adjacent violators) of log(8-bit visibility + 1), the quantity compared by AOV eq.
// 14, then 33 knots by least squares. 0 at 0, so that open areas stay white. Requires as many sums as occlusions, ≥ 1.
Compensation fitCurve(std::span<const double> sums, std::span<const double> occlusions);

// Mean squared difference of log(8-bit visibility + 1): the first term of AOV eq. 14 over a list of points.
double logResidual(const Compensation& curve, std::span<const double> sums, std::span<const double> occlusions);

CompensateResult compensateVolumes(const VolumeSet& volumes, const Tracer& tracer, const CompensateSettings& settings,
								   const RunSettings& run);

} // namespace nook
