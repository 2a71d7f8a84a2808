// SPDX-License-Identifier: GPL-3.0-or-later
// What a mean over frames makes of methods, with a camera that stands, pans or walks. For error_measure.cpp.
#pragma once

#include "error_report/error_points.h"
#include "error_report/error_report.h"

#include <vector>

namespace nook
{

// Of the view's points those that framesPoints() names, as they are and with a tile of frames where they take one. `candidates`: of
// the points; `how`: the view's size and rays.
FramesPart framesOf(LevelBench& bench, const LevelCamera& camera, const ViewSettings& how, ViewBench& on,
					const std::vector<Candidate>& candidates, const ErrorView& view, const ErrorReportSettings& settings,
					const PointMeasurer& points, const RunSettings& run);

} // namespace nook
