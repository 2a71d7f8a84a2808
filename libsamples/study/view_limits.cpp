// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/error_points.h"

#include "study/shape_fit.h"

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
	candidate.shade.method = ShadeMethod::slices;
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

} // namespace

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

void visit(Archive& archive, ScreenLimit& limit)
{
	archive(limit.thickness, limit.strength, limit.power, limit.errors);
}

} // namespace nook
