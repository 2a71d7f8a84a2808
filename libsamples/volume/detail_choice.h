// SPDX-License-Identifier: GPL-3.0-or-later
// A level, and how much more error is wanted at most → how far its surfaces may be simplified before volumes are made of them
// (OccluderSettings::detail).
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
	double more = 0.05;          // error, as a share of the error without simplification; > 0
	double ray_distance_m = 0.0; // of the reference with linear falloff; 0: the paper's δ / 0.6
	bool exact_bounds = false;   // as the volumes will have them
	bool fitted = false;         // whether they get a curve fitted to the level: that error counts, else the paper's
	int rays = 256;              // at each point
	ReceiverSettings receivers{4, 600, 2400, 0, 5}; // points where errors are asked
};

struct DetailTrial
{
	double detail = 0.0;      // share of δ
	uint64_t polygons = 0;    // convex polygons, none dropped
	double paper_rmse = 0.0;  // of visibility against rays, with the paper's curve
	double fitted_rmse = 0.0; // with a curve fitted to these points
};

struct DetailChoice
{
	double detail = 0.0; // 0: no share of the ladder is allowed, or none saves a tenth of the polygons
	std::size_t points = 0;
	std::vector<DetailTrial> trials; // the first without simplification, then as they were tried
};

// The coarsest of a ladder of shares (0.08 and down by fourth roots of two) with which the error by the curve that the volumes get
// is no more than `more` above what it is without; found by halving. With the paper's curve, that by a fitted one no more than
// three times that. Deterministic, the same for any thread count. `settings.detail` is ignored.
DetailChoice chooseDetail(const Level& level, const Tracer& tracer, const OccluderSettings& settings, const DetailSettings& detail,
						  const RunSettings& run);

} // namespace nook
