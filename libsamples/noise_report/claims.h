// SPDX-License-Identifier: GPL-3.0-or-later
// The counts that Loos & Sloan 2010 (§4.5, figure 4) name as better than others, judged by the report's own figures.
#pragma once

#include "noise_report/noise_report.h"

#include <string>
#include <vector>

namespace nook
{

// Needs the report's rows, paper_rows and fits.
std::vector<Claim> judgeClaims(const NoiseReport& report);

// The rule behind every verdict, in words, a paragraph a string.
std::vector<std::string> verdictRules();

// A count against its neighbours, by its noise and its plane error over their local trends.
Verdict judgeDip(double noise_ratio, double plane_ratio);

// Less noisy than another count.
Verdict judgeLess(double noise_ratio);

// No worse than another kind of sample.
Verdict judgeAlike(double noise_ratio, double plane_ratio);

// What all figures of a claim say together.
Verdict judgeAll(const std::vector<ClaimFigure>& figures);

} // namespace nook
