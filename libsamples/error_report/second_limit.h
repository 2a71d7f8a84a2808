// SPDX-License-Identifier: GPL-3.0-or-later
// A view → about what two layers of depth can know of it.
#pragma once

#include "bench/measure_view.h"
#include "error_report/error_report.h"
#include "scene/tracer.h"

namespace nook
{

// `one`: what one layer can know. The same slices, with the second layer, the thicknesses, the steps, the strength and the power
// that suit this view: the next surface behind or the next that faces the camera, whichever errs less. Thicknesses and steps are
// chosen on every third pixel of both axes, with four slices; errors are of all pixels, with 16.
SecondLimit secondLimitOf(const ViewBench& on, const Tracer& tracer, double radius_m, const ScreenLimit& one,
						  const RunSettings& run);

} // namespace nook
