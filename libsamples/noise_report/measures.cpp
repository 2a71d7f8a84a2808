// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/measures.h"

#include <array>
#include <cassert>

namespace nook
{

std::span<const MeasureField> measureFields()
{
	using Value = std::optional<double>;
	static constexpr std::array<MeasureField, 7> fields{{
		{"noise",
		 [](const Quality& q) -> Value
		 {
			 return q.noise;
		 }},
		{"plane",
		 [](const Quality& q) -> Value
		 {
			 return q.plane;
		 }},
		{"bias",
		 [](const Quality& q) -> Value
		 {
			 return q.bias;
		 }},
		{"cliff",
		 [](const Quality& q) -> Value
		 {
			 return q.cliff;
		 }},
		{"centre",
		 [](const Quality& q) -> Value
		 {
			 return q.centre;
		 }},
		{"crease",
		 [](const Quality& q) -> Value
		 {
			 return q.crease;
		 }},
		{"spread",
		 [](const Quality& q) -> Value
		 {
			 return q.spread;
		 }},
	}};
	return fields;
}

const MeasureField& measureNamed(std::string_view name)
{
	for (const MeasureField& field : measureFields())
	{
		if (field.name == name)
		{
			return field;
		}
	}
	assert(false);
	return measureFields().front();
}

bool Series::holds(const NoiseRow& row) const
{
	return row.recipe.domain == domain && row.variant == variant && row.recipe.method == method && row.recipe.weights == weights &&
		   row.recipe.voronoi == voronoi;
}

MeasureByCount valuesOf(const std::vector<NoiseRow>& rows, const Series& series, const MeasureField& measure)
{
	MeasureByCount values;
	for (const NoiseRow& row : rows)
	{
		if (series.holds(row))
		{
			if (const std::optional<double> value = measure.get(row.quality))
			{
				values[row.recipe.count] = *value;
			}
		}
	}
	return values;
}

const NoiseRow* findRow(const std::vector<NoiseRow>& rows, const Series& series, int count)
{
	for (const NoiseRow& row : rows)
	{
		if (row.recipe.count == count && series.holds(row))
		{
			return &row;
		}
	}
	return nullptr;
}

const NoiseFit* findFit(const std::vector<NoiseFit>& fits, Domain domain, std::string_view measure)
{
	for (const NoiseFit& fit : fits)
	{
		if (fit.domain == domain && fit.measure == measure)
		{
			return &fit;
		}
	}
	return nullptr;
}

double exponentOf(const NoiseReport& report, Domain domain, std::string_view measure)
{
	const NoiseFit* fit = findFit(report.fits, domain, measure);
	return fit != nullptr ? fit->exponent : 0.0;
}

std::string ringText(const Symmetry& symmetry)
{
	std::string text;
	if (symmetry.rings.size() <= 6)
	{
		for (const Ring& ring : symmetry.rings)
		{
			text += text.empty() ? "" : "+";
			text += std::to_string(ring.samples);
		}
	}
	return text;
}

std::string symmetryText(Domain domain, const Symmetry& symmetry)
{
	std::string text;
	const auto add = [&](const std::string& part)
	{
		text += (text.empty() ? "" : ", ") + part;
	};
	if (symmetry.order > 1)
	{
		add(std::to_string(symmetry.order) + (isPlanar(domain) ? "-fold" : " rotations"));
	}
	if (symmetry.antipodal)
	{
		add("antipodal");
	}
	if (text.empty())
	{
		text = "no symmetry";
	}
	const std::string rings = ringText(symmetry);
	if (!rings.empty() && domain != Domain::sphere)
	{
		add((domain == Domain::ball ? "shells " : "rings ") + rings);
	}
	return text;
}

} // namespace nook
