// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Zhou Wang, Alan C. Bovik, Hamid R. Sheikh, Eero P. Simoncelli, "Image Quality Assessment: From Error
// Visibility to Structural Similarity", IEEE Transactions on Image Processing, 2004.
#include "core/parallel.h"
#include "image/compare.h"
#include "pattern/filter_band.h"

#include <algorithm>
#include <cassert>

namespace nook
{
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
