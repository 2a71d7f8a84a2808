// SPDX-License-Identifier: GPL-3.0-or-later
// The measures that the page offers, and one series of one of them out of the report's rows.
#pragma once

#include "core/text.h"
#include "noise_report/noise_report.h"
#include "noise_report/trend.h"

#include <optional>
#include <span>
#include <string_view>

namespace nook
{

struct MeasureField
{
	std::string_view name;
	std::optional<double> (*get)(const Quality& quality);
};

// noise, plane, bias, cliff, centre, crease, spread.
std::span<const MeasureField> measureFields();

const MeasureField& measureNamed(std::string_view name);

struct Series
{
	Domain domain = Domain::disk;
	Variant variant = Variant::free;
	Method method = Method::refine;
	WeightRule weights = WeightRule::voronoi;
	VoronoiMode voronoi = VoronoiMode::exact;

	bool holds(const NoiseRow& row) const;
};

// Absent measures are left out.
MeasureByCount valuesOf(const std::vector<NoiseRow>& rows, const Series& series, const MeasureField& measure);

// The series' row at this count, or null.
const NoiseRow* findRow(const std::vector<NoiseRow>& rows, const Series& series, int count);

// The fit of this domain and measure, or null.
const NoiseFit* findFit(const std::vector<NoiseFit>& fits, Domain domain, std::string_view measure);

// Of that fit; 0 where there is none.
double exponentOf(const NoiseReport& report, Domain domain, std::string_view measure);

// "1+8", from the inside out; empty for more than 6 rings.
std::string ringText(const Symmetry& symmetry);

// "8-fold, antipodal, rings 1+8"; "no symmetry".
std::string symmetryText(Domain domain, const Symmetry& symmetry);

} // namespace nook
