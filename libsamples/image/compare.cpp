// SPDX-License-Identifier: GPL-3.0-or-later
#include "image/compare.h"

#include "core/math.h"
#include "core/parallel.h"
#include "pattern/filter_band.h"

#include <algorithm>
#include <array>
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

// This work is based on: Morgan McGuire, "Ambient Occlusion Volumes", High Performance Graphics, 2010, eq. 14.

namespace
{

// Table of log†(x) = sign(x) log(|x| + 1) for the integers from −255 to 255.
class SignedLog
{
public:
	SignedLog()
	{
		for (int x = 0; x < 256; ++x)
		{
			m_values[static_cast<std::size_t>(x)] = logOf(x + 1.0);
		}
	}
	double operator()(int x) const
	{
		const double value = m_values[static_cast<std::size_t>(std::abs(x))];
		return x < 0 ? -value : value;
	}

private:
	std::array<double, 256> m_values{};
};

int byteOf(const VisibilityPlane& plane, std::size_t pixel)
{
	return static_cast<int>(std::floor(255.0 * std::clamp(static_cast<double>(plane.values[pixel]), 0.0, 1.0) + 0.5));
}

double squared(double x)
{
	return x * x;
}

// Squared errors of a row: of values, of differences to the right, and of differences downwards.
struct Terms
{
	PixelTally value;
	PixelTally right;
	PixelTally down;
};

double mean(const PixelTally& tally)
{
	return tally.count == 0 ? 0.0 : tally.sum / static_cast<double>(tally.count);
}

} // namespace

double logError(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
				const RunSettings& run)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px);
	const SignedLog log;
	const auto width = static_cast<std::size_t>(test.width_px);
	const auto height = static_cast<std::size_t>(test.height_px);
	std::vector<Terms> rows(height);
	parallelFor(height, run.threads,
				[&](std::size_t y)
				{
					for (std::size_t x = 0; x < width; ++x)
					{
						const std::size_t i = y * width + x;
						if (!counts(counted, i))
						{
							continue;
						}
						const int t = byteOf(test, i);
						const int r = byteOf(reference, i);
						const auto difference = [&](std::size_t next)
						{
							return squared(log(byteOf(test, next) - t) - log(byteOf(reference, next) - r));
						};
						rows[y].value.add(squared(log(t) - log(r)));
						if (x + 1 < width && counts(counted, i + 1))
						{
							rows[y].right.add(difference(i + 1));
						}
						if (y + 1 < height && counts(counted, i + width))
						{
							rows[y].down.add(difference(i + width));
						}
					}
				});
	Terms sum;
	for (const Terms& row : rows)
	{
		sum.value += row.value;
		sum.right += row.right;
		sum.down += row.down;
	}
	return mean(sum.value) + 0.5 * (mean(sum.right) + mean(sum.down));
}

// This work is based on: Zhou Wang, Alan C. Bovik, Hamid R. Sheikh, Eero P. Simoncelli, "Image Quality Assessment: From Error
// Visibility to Structural Similarity", IEEE Transactions on Image Processing, 2004.

namespace
{

constexpr int kWindow = 5;     // §III-C: 11 × 11
constexpr double kSigma = 1.5; // §III-C
constexpr double kC1 = 1e-4;   // (K1 L)², K1 = 0.01
constexpr double kC2 = 9e-4;   // (K2 L)², K2 = 0.03

double rowValue(const VisibilityPlane& plane, int y, std::size_t x)
{
	return static_cast<double>(plane.values[static_cast<std::size_t>(y) * static_cast<std::size_t>(plane.width_px) + x]);
}

// Weighted means of f(test, reference).
template <class Function>
std::vector<double> means(const Band& band, const VisibilityPlane& test, const VisibilityPlane& reference, const Kernel& kernel,
						  Function f)
{
	const RowSource source = [&](int y, std::span<double> row)
	{
		for (std::size_t x = 0; x < row.size(); ++x)
		{
			row[x] = f(rowValue(test, y, x), rowValue(reference, y, x));
		}
	};
	return filteredBand(band, source, kernel, kernel);
}

} // namespace

std::optional<double> meanSsim(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
							   const RunSettings& run)
{
	assert(test.width_px == reference.width_px && test.height_px == reference.height_px);
	const Kernel kernel = gaussianKernel(kSigma, kWindow);
	const std::vector<Band> bands = bandsOf(test.width_px, test.height_px);
	std::vector<PixelTally> rows(static_cast<std::size_t>(test.height_px));
	ProgressCounter progress(run.progress, "ssim", bands.size());
	parallelFor(bands.size(), run.threads,
				[&](std::size_t b)
				{
					const Band& band = bands[b];
					const auto of = [&](auto f)
					{
						return means(band, test, reference, kernel, f);
					};
					// Eqs. 14 to 16. The mean of products minus the product of means loses precision only in nearly flat windows,
					// where C2 dominates.
					const std::vector<double> mean_t = of([](double t, double) { return t; });
					const std::vector<double> mean_r = of([](double, double r) { return r; });
					const std::vector<double> square_t = of([](double t, double) { return t * t; });
					const std::vector<double> square_r = of([](double, double r) { return r * r; });
					const std::vector<double> product = of([](double t, double r) { return t * r; });
					const auto width = static_cast<std::size_t>(test.width_px);
					for (int y = std::max(band.first, kWindow); y < std::min(band.last, test.height_px - kWindow); ++y)
					{
						for (std::size_t x = kWindow; x + kWindow < width; ++x)
						{
							if (!counts(counted, static_cast<std::size_t>(y) * width + x))
							{
								continue;
							}
							const std::size_t i = static_cast<std::size_t>(y - band.first) * width + x;
							const double tt = mean_t[i] * mean_t[i];
							const double rr = mean_r[i] * mean_r[i];
							const double tr = mean_t[i] * mean_r[i];
							// Eq. 13
							rows[static_cast<std::size_t>(y)].add(
								(2.0 * tr + kC1) * (2.0 * (product[i] - tr) + kC2) /
								((tt + rr + kC1) * (square_t[i] - tt + (square_r[i] - rr) + kC2)));
						}
					}
					progress.finishOne();
				});
	const PixelTally sum = total(rows);
	return sum.count == 0 ? std::nullopt : std::optional(sum.sum / static_cast<double>(sum.count));
}

} // namespace nook
