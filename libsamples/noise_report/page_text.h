// SPDX-License-Identifier: GPL-3.0-or-later
// The page's words: what it says first, what was found, how to read it.
#pragma once

#include "noise_report/noise_report.h"

#include <string>
#include <utility>
#include <vector>

namespace nook
{

std::string leadText(const NoiseReport& report);

// Paragraphs above the study tables.
std::vector<std::string> whyText(const NoiseReport& report);

// Term and explanation.
std::vector<std::pair<std::string, std::string>> readingText(const NoiseReport& report, const std::string& command,
															 const std::string& version);

} // namespace nook
