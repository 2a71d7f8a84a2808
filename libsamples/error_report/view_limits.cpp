// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_report/view_limits.h"

#include "core/byte_text.h"
#include "error_report/error_claims.h"
#include "error_report/second_limit.h"
#include "fit/shape_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

using Draw = std::function<std::vector<float>(const Candidate&)>;

// With the strength and the power that suit this view.
ScreenLimit limitWith(const ViewBench& on, const SliceSettings& slices, std::span<const char> counted, const Draw& draw)
{
	Candidate candidate;
	candidate.shade.method = limitMethod().method;
	candidate.shade.slices = slices;
	candidate.shade.filter = ShadeFilter::none;
	std::vector<float> visibility = draw(candidate);
	const ShapeView view = shapeView(0, visibility, on.reference().visibility, counted);
	const CurveShape shape = fitShape({&view, 1});
	for (float& v : visibility)
	{
		v = static_cast<float>(std::pow(std::max(0.0, 1.0 - shape.strength * (1.0 - static_cast<double>(v))), shape.power));
	}
	return {slices.thickness, shape.strength, shape.power, on.errorsOf(visibility)};
}

ScreenLimit screenLimitOf(const ViewBench& on, const Draw& draw, const RunSettings& run)
{
	const std::vector<char> counted = surfacesOf(on.gbuffer());
	std::optional<ScreenLimit> best;
	constexpr std::array<double, 5> kThicknesses{0.25, 0.5, 0.75, 1.0, 2.0};
	constexpr std::array<int, 2> kStepCounts{8, 32}; // more find what is thin, fewer let more light through
	ProgressCounter progress(run.progress, "limit", kThicknesses.size() * kStepCounts.size());
	for (const int steps : kStepCounts)
	{
		for (const double thickness : kThicknesses)
		{
			const ScreenLimit found = limitWith(on, {16, steps, thickness}, counted, draw);
			if (!best || found.errors.rmse < best->errors.rmse)
			{
				best = found;
			}
			progress.finishOne();
		}
	}
	return *best;
}

void save(const ScreenLimit& limit, ByteWriter& out)
{
	const ViewErrors& errors = limit.errors;
	for (const double value : {limit.thickness, limit.strength, limit.power, errors.eq14, errors.rmse, errors.flip,
							   errors.mean_error, errors.best_factor, errors.best_rmse, errors.ssim.value_or(0.0)})
	{
		out.number(value);
	}
	out.byte(errors.ssim ? 1 : 0);
}

ScreenLimit loadLimit(ByteReader& in)
{
	ScreenLimit limit;
	ViewErrors& errors = limit.errors;
	for (double* const value : {&limit.thickness, &limit.strength, &limit.power, &errors.eq14, &errors.rmse, &errors.flip,
								&errors.mean_error, &errors.best_factor, &errors.best_rmse, &errors.ssim.emplace()})
	{
		*value = in.number();
	}
	if (in.byte() == 0)
	{
		errors.ssim = std::nullopt;
	}
	return limit;
}

} // namespace

ViewLimits viewLimitsOf(ViewBench& on, const Tracer& tracer, double radius_m, const Draw& draw, const RunSettings& run)
{
	const ScreenLimit one = screenLimitOf(on, draw, run);
	return {one, secondLimitOf(on, tracer, radius_m, one, run)};
}

std::string savedLimits(const std::optional<ViewLimits>& limits)
{
	ByteWriter out;
	out.byte(limits ? 1 : 0);
	if (limits)
	{
		save(limits->one, out);
		save(limits->two.both, out);
		out.number(limits->two.second_thickness);
		out.byte(limits->two.facing ? 1 : 0);
	}
	return out.take();
}

bool loadLimits(std::string_view bytes, std::optional<ViewLimits>& limits)
{
	ByteReader in(bytes);
	limits = std::nullopt;
	if (in.byte() != 0)
	{
		ViewLimits found;
		found.one = loadLimit(in);
		found.two.both = loadLimit(in);
		found.two.second_thickness = in.number();
		found.two.facing = in.byte() != 0;
		limits = found;
	}
	return in.isAtEnd();
}

} // namespace nook
