// SPDX-License-Identifier: GPL-3.0-or-later
// What papers say of times and errors over the radius, held against what was measured.
#include "error_report/error_claims.h"

#include <cmath>
#include <optional>
#include <utility>

namespace nook
{
namespace
{

// Exponent of time, or fragments, over the radius: least squares in logarithms.
std::optional<double> exponentOf(const std::vector<std::pair<double, double>>& curve)
{
	if (curve.size() < 3)
	{
		return std::nullopt;
	}
	double x = 0.0;
	double y = 0.0;
	double xx = 0.0;
	double xy = 0.0;
	for (const auto& [scale, value] : curve)
	{
		if (!(value > 0.0))
		{
			return std::nullopt;
		}
		x += std::log(scale);
		y += std::log(value);
		xx += std::log(scale) * std::log(scale);
		xy += std::log(scale) * std::log(value);
	}
	const auto n = static_cast<double>(curve.size());
	return (n * xy - x * y) / (n * xx - x * x);
}

struct Sweep
{
	std::vector<std::pair<double, double>> seconds;
	std::vector<std::pair<double, double>> fragments;
	std::vector<std::pair<double, double>> noise;

	double growth() const // of time from the least to the greatest scale
	{
		return seconds.back().second / seconds.front().second;
	}
};

Sweep sweepOf(const ErrorView& view, const MethodRow& row)
{
	Sweep sweep;
	for (const ErrorPoint& point : view.sweep)
	{
		if (point.candidate && point.candidate->row() == &row)
		{
			sweep.seconds.emplace_back(point.scale, claimTime(point));
			sweep.noise.emplace_back(point.scale, point.measured.own_rmse.value_or(0.0));
			sweep.fragments.emplace_back(point.scale, static_cast<double>(point.measured.fragments));
		}
	}
	return sweep;
}

constexpr double kFlat = 0.08; // exponents up to which time does not grow: 12 % over four times the radius

} // namespace

ErrorClaim statVoRadius(const ErrorReport& report)
{
	JudgedClaim claim(
		{"statvo-radius",
		 "StatVO's time does not grow with the radius.",
		 "SVO, abstract and §7",
		 {},
		 "Time ~ radius^p from half to twice the radius, least squares in logarithms. Holds where p is at most 0.08: 12 % from "
		 "end to end.",
		 {"view", "p", "time at twice / half the radius", ""},
		 {}});
	for (const ClaimPlace& place : placesOf(report))
	{
		const Sweep sweep = sweepOf(*place.view, claimedTables());
		if (const std::optional<double> exponent = exponentOf(sweep.seconds))
		{
			claim.add({place.name, shortText(*exponent), shortText(sweep.growth())}, *exponent <= kFlat);
		}
	}
	return claim.take();
}

ErrorClaim samplesRadius(const ErrorReport& report)
{
	JudgedClaim claim(
		{"samples-radius",
		 "Methods with samples pay for a larger radius: in time, or in the samples and the blur that keep the noise down.",
		 "SVO §7, ALC §4",
		 {},
		 "Exponents of time and of noise (without a filter, the difference to the method's own limit) over the radius, at one "
		 "count. Holds where one of them is above 0.08. What time alone does is a matter of a GPU's texture cache, of which a "
		 "renderer on a CPU says nothing.",
		 {"view", "method", "p of time", "p of noise", "noise at twice / half the radius", ""},
		 {}});
	for (const ClaimPlace& place : placesOf(report))
	{
		for (const MethodRow& row : methodTable())
		{
			if (row.kind != MethodKind::screen || !hasNoise(row))
			{
				continue;
			}
			const Sweep sweep = sweepOf(*place.view, row);
			const std::optional<double> time = exponentOf(sweep.seconds);
			const std::optional<double> noise = exponentOf(sweep.noise);
			if (time && noise)
			{
				const bool holds = *time > kFlat || *noise > kFlat;
				claim.add({place.name, std::string(row.name), shortText(*time), shortText(*noise),
						   shortText(sweep.noise.back().second / sweep.noise.front().second)},
						  holds);
			}
		}
	}
	return claim.take();
}

ErrorClaim timeOverSquare(const ErrorReport& report)
{
	JudgedClaim claim(
		{"aov-square",
		 "AOV's fill grows with the square of the distance, and its time with that.",
		 "AOV §6",
		 {},
		 "Fragments ~ distance^p and time ~ distance^p from half the distance to the whole. Holds where the fragments' p is 1.5 to "
		 "2.5: they are the same on every renderer, while times of a few large drawings are as steady as the machine is.",
		 {"view", "p of time", "p of fragments", "fragments a pixel at the whole distance", ""},
		 {}});
	for (const ClaimPlace& place : placesOf(report))
	{
		const Sweep sweep = sweepOf(*place.view, claimedVolumes());
		const std::optional<double> time = exponentOf(sweep.seconds);
		const std::optional<double> fragments = exponentOf(sweep.fragments);
		if (time && fragments)
		{
			const bool holds = *fragments >= 1.5 && *fragments <= 2.5;
			const double pixels = static_cast<double>(place.view->width_px) * static_cast<double>(place.view->height_px);
			claim.add({place.name, shortText(*time), shortText(*fragments), shortText(sweep.fragments.back().second / pixels)},
					  holds);
		}
	}
	return claim.take();
}

} // namespace nook
