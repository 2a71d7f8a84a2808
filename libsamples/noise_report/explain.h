// SPDX-License-Identifier: GPL-3.0-or-later
// The report's rows → sentences that say why a count is better than its neighbours, or that nothing was found.
#pragma once

#include "noise_report/noise_report.h"

#include <string>

namespace nook
{

std::string explainCount(const NoiseReport& report, Domain domain, Variant variant, int count);
// A sentence where the series that decide disagree by more than a tenth in noise: other starts, other pattern. Else empty.
std::string explainScatter(const std::vector<ClaimFigure>& figures);

std::string explainNineAndTen(const NoiseReport& report);
std::string explainTwelveAndThirteen(const NoiseReport& report);
std::string explainLinesAndPoints(const NoiseReport& report);

// The least count of free points (`refine`) whose measure is no greater than `value`; 0: none was made.
int pointsAsGoodAs(const NoiseReport& report, std::string_view measure, double value);

} // namespace nook
