// SPDX-License-Identifier: GPL-3.0-or-later
// Figures that other generators reached, beside the report's.
#pragma once

#include "noise_report/noise_report.h"

#include <string>
#include <vector>

namespace nook
{

struct KnownValue
{
	std::string pattern; // "Vogel spiral"
	Domain domain = Domain::disk;
	std::string measure;
	int count = 0;
	double value = 0.0; // the known figure
	double ours = 0.0;  // the report's, of the same kind of pattern where it has one, else its best; 0: not made
	std::string by;     // which of the report's patterns that is
};

std::vector<KnownValue> compareKnownValues(const NoiseReport& report);

} // namespace nook
