// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses how far a level's surfaces may be simplified before volumes are made (OccluderSettings::detail), for a given increase of
// the error.
#pragma once

#include "core/progress.h"
#include "scene/level.h"
#include "scene/tracer.h"
#include "volume/occluders.h"
#include "volume/verify.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nook
{

struct DetailSettings
{
	double more = 0.05;          // allowed increase of the error, relative to the error without simplification; > 0
	double ray_distance_m = 0.0; // radius of the reference with linear falloff; 0: the paper's δ / 0.6
	bool exact_bounds = false;   // as for the final volumes
	bool fitted = false;         // the volumes will get a fitted curve, whose error counts; else the paper's counts
	int rays = 256;              // per point
	ReceiverSettings receivers{4, 600, 2400, 0, 5}; // points where errors are measured
};

struct DetailTrial
{
	double detail = 0.0;      // relative to δ
	uint64_t polygons = 0;    // convex polygons before dropping any
	double paper_rmse = 0.0;  // visibility error against rays with the paper's curve
	double fitted_rmse = 0.0; // with a curve fitted to these points
};

struct DetailChoice
{
	double detail = 0.0; // 0: no step is acceptable, or none saves a tenth of the polygons
	std::size_t points = 0;
	std::vector<DetailTrial> trials; // the first is without simplification, then in order of evaluation
};

// Finds, by bisection, the coarsest of a ladder of steps (0.08 and down by fourth roots of two) whose error with the volumes' curve
// is at most `more` above that without simplification. With the paper's curve, the error with a fitted one may grow by at most
// three times that. Deterministic for any thread count. `settings.detail` is ignored.
DetailChoice chooseDetail(const Level& level, const Tracer& tracer, const OccluderSettings& settings, const DetailSettings& detail,
						  const RunSettings& run);

} // namespace nook
