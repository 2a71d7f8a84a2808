// SPDX-License-Identifier: GPL-3.0-or-later
// The report's rows, and one small experiment → the tables behind "why some counts are good".
#pragma once

#include "noise_report/noise_report.h"

#include <vector>

namespace nook
{

// Tables whose counts were not made are left out.
std::vector<StudyTable> makeStudies(const NoiseReport& report);

// The row whose pattern filterTables() varies; null where the report has none.
const NoiseRow* rowOfFilters(const NoiseReport& report);

// Nine lines (four where fewer than nine were made) behind filters and over frames, by what varies them from pixel to pixel.
std::vector<StudyTable> filterTables(const NoiseReport& report, const RunSettings& run = {});

// The disk or hemisphere pattern with every sample turned about the axis by a random angle of up to a quarter of the spacing on its
// ring; radii and weights stay. What it breaks is the symmetry, and what it cannot change is the bias.
Pattern breakSymmetry(const Pattern& pattern, const Symmetry& symmetry, uint64_t seed);

} // namespace nook
