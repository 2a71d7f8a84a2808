// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/compare.h"

#include "core/parallel.h"
#include "pattern/filter_band.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

struct RowErrors
{
	PixelTally error;
	PixelTally magnitude;
	PixelTally square;
	double greatest = -1.0;
	std::size_t where = 0;

	RowErrors& operator+=(const RowErrors& row)
	{
		error += row.error;
		magnitude += row.magnitude;
		square += row.square;
		if (row.greatest > greatest)
		{
			greatest = row.greatest;
			where = row.where;
		}
		return *this;
	}
};

// Errors that depend on single pixels only.
void pointwise(Comparison& result, const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
			   const RunSettings& run)
{
	const auto width = static_cast<std::size_t>(test.width_px);
	std::vector<RowErrors> rows(static_cast<std::size_t>(test.height_px));
	std::vector<double> magnitudes(test.values.size());
	const auto errorAt = [&](std::size_t i)
	{
		return static_cast<double>(test.values[i]) - static_cast<double>(reference.values[i]);
	};
	parallelFor(rows.size(), run.threads,
				[&](std::size_t y)
				{
					RowErrors& row = rows[y];
					for (std::size_t i = y * width; i < (y + 1) * width; ++i)
					{
						if (!counts(counted, i))
						{
							magnitudes[i] = -1.0;
							continue;
						}
						const double error = errorAt(i);
						magnitudes[i] = std::fabs(error);
						row.error.add(error);
						row.magnitude.add(magnitudes[i]);
						row.square.add(error * error);
						if (magnitudes[i] > row.greatest)
						{
							row.greatest = magnitudes[i];
							row.where = i;
						}
					}
				});
	RowErrors sum;
	for (const RowErrors& row : rows)
	{
		sum += row;
	}
	assert(sum.error.count > 0);
	const auto count = static_cast<double>(sum.error.count);
	result.pixels = sum.error.count;
	result.rmse = std::sqrt(sum.square.sum / count);
	result.mae = sum.magnitude.sum / count;
	result.mean_error = sum.error.sum / count;
	result.max = sum.greatest;
	result.worst = {static_cast<int>(sum.where % width), static_cast<int>(sum.where / width),
					static_cast<double>(test.values[sum.where]), static_cast<double>(reference.values[sum.where])};
	// Nearest rank: the ⌈0.95 n⌉th of the counted pixels, in integer arithmetic.
	std::erase(magnitudes, -1.0);
	const std::size_t rank = (19 * magnitudes.size() + 19) / 20;
	const auto at = magnitudes.begin() + static_cast<std::ptrdiff_t>(rank - 1);
	std::nth_element(magnitudes.begin(), at, magnitudes.end());
	result.p95 = *at;
}

} // namespace

Comparison compareImages(const VisibilityPlane& test, const VisibilityPlane& reference, const CompareSettings& settings,
						 const RunSettings& run)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px);
	assert(test.values.size() == reference.values.size() && !test.values.empty());
	assert(settings.counted.empty() || settings.counted.size() == test.values.size());
	Comparison result;
	pointwise(result, test, reference, settings.counted, run);
	result.ssim = meanSsim(test, reference, settings.counted, run);
	result.flip = meanFlip(test, reference, settings.counted, settings.pixels_per_degree, run);
	result.eq14 = logError(test, reference, settings.counted, run);
	return result;
}

std::optional<double> errorBy(const Comparison& comparison, ErrorMetric metric)
{
	switch (metric)
	{
	case ErrorMetric::rmse: return comparison.rmse;
	case ErrorMetric::mae: return comparison.mae;
	case ErrorMetric::p95: return comparison.p95;
	case ErrorMetric::max: return comparison.max;
	case ErrorMetric::ssim: return comparison.ssim ? std::optional(1.0 - *comparison.ssim) : std::nullopt;
	case ErrorMetric::flip: return comparison.flip;
	case ErrorMetric::eq14: return comparison.eq14;
	}
	return std::nullopt;
}

} // namespace nook
