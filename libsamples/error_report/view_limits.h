// SPDX-License-Identifier: GPL-3.0-or-later
// A view → about what a picture of it can know: from one layer of depth, and from two.
#pragma once

#include "bench/measure_view.h"
#include "error_report/error_report.h"
#include "scene/tracer.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct ViewLimits
{
	ScreenLimit one;
	SecondLimit two;
};

// `draw`: a candidate's visibility on this view.
ViewLimits viewLimitsOf(ViewBench& on, const Tracer& tracer, double radius_m,
						const std::function<std::vector<float>(const Candidate&)>& draw, const RunSettings& run);

// None: they could not be found.
std::string savedLimits(const std::optional<ViewLimits>& limits);

// False where savedLimits() writes no such bytes.
bool loadLimits(std::string_view bytes, std::optional<ViewLimits>& limits);

} // namespace nook
