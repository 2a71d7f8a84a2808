// SPDX-License-Identifier: GPL-3.0-or-later
// Errors of a visibility image against a reference of the same size.
#pragma once

#include "core/progress.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace nook
{

// Visibility of every pixel, rows from the top; finite. 1 is open and is displayed white.
struct VisibilityPlane
{
	int width_px = 0;
	int height_px = 0;
	std::span<const float> values; // width × height
};

struct CompareSettings
{
	double pixels_per_degree = 67.0;  // for FLIP, 4 to 1000; 67 as in the paper: 3840 pixels on 0.7 m, seen from 0.7 m
	std::span<const uint8_t> counted; // width × height, 0: ignore the pixel; empty: count all
};

struct WorstPixel
{
	int x = 0; // from the left, starting at 0
	int y = 0; // from the top
	double test = 0.0;
	double reference = 0.0;
};

// Means are over the counted pixels.
struct Comparison
{
	std::size_t pixels = 0;     // counted pixels; ≥ 1
	double rmse = 0.0;          // root mean squared error
	double mae = 0.0;           // mean of |error|
	double mean_error = 0.0;    // mean of test − reference: negative where the test is darker
	double p95 = 0.0;           // 95th percentile of |error|
	double max = 0.0;           // greatest |error|
	WorstPixel worst;           // where `max` occurs; the first in reading order
	std::optional<double> ssim; // mean structural similarity, 1 for equal images; none where no 11 × 11 window counts
	double flip = 0.0;          // mean FLIP, 0 to 1
	double eq14 = 0.0;          // AOV's perceptual error (see logError)
};

// Requires equal sizes ≥ 1 × 1, finite values and at least one counted pixel. Sums run row by row in a fixed order.
Comparison compareImages(const VisibilityPlane& test, const VisibilityPlane& reference, const CompareSettings& settings,
						 const RunSettings& run);

// LDR-FLIP (Andersson et al. 2020) of visibility as a gray sRGB value, clamped to 0…1. Border pixels are repeated.
double meanFlip(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
				double pixels_per_degree, const RunSettings& run);

// AOV (McGuire 2010) eq. 14 on 8-bit values: E = MSE[log†T] + ½ (MSE[log†∂T/∂x] + MSE[log†∂T/∂y]), with the natural logarithm,
// log†x = sign(x) log(|x| + 1). The paper does not define the derivatives; here they are differences to the next pixel right and
// below, averaged over the pairs that exist and count. Values outside 0…1 are clamped, as 8-bit storage would.
double logError(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
				const RunSettings& run);

// Error metrics to judge a comparison by.
enum class ErrorMetric
{
	rmse,
	mae,
	p95,
	max,
	ssim, // 1 − SSIM
	flip,
	eq14,
};

// 0 for equal images; none if SSIM is undefined.
std::optional<double> errorBy(const Comparison& comparison, ErrorMetric metric);

// Sum and number of the counted pixels.
struct PixelTally
{
	double sum = 0.0;
	std::size_t count = 0;

	void add(double value)
	{
		sum += value;
		count += 1;
	}
	PixelTally& operator+=(const PixelTally& other)
	{
		sum += other.sum;
		count += other.count;
		return *this;
	}
};

inline bool counts(std::span<const uint8_t> counted, std::size_t pixel)
{
	return counted.empty() || counted[pixel] != 0;
}

} // namespace nook
