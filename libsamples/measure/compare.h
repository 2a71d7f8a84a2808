// SPDX-License-Identifier: GPL-3.0-or-later
// Two visibility images of one size → how far the test is from the reference.
#pragma once

#include "core/progress.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace nook
{

// Visibility of every pixel, rows from the top; finite. 1 is open, and what a display shows as white.
struct VisibilityPlane
{
	int width_px = 0;
	int height_px = 0;
	std::span<const float> values; // width × height
};

struct CompareSettings
{
	double pixels_per_degree = 67.0;  // of FLIP, 4 to 1000; 67 as in the paper: 3840 pixels on 0.7 m, seen from 0.7 m
	std::span<const uint8_t> counted; // width × height, 0: the pixel does not count; empty: all count
};

struct WorstPixel
{
	int x = 0; // from the left, 0 is the first
	int y = 0; // from the top
	double test = 0.0;
	double reference = 0.0;
};

// Every mean is over the pixels that count.
struct Comparison
{
	std::size_t pixels = 0;     // that count; ≥ 1
	double rmse = 0.0;          // root of the mean squared error
	double mae = 0.0;           // mean of |error|
	double mean_error = 0.0;    // mean of test − reference: negative where the test is darker
	double p95 = 0.0;           // the least value that at least 95 % of the pixels' |error| do not exceed
	double max = 0.0;           // greatest |error|
	WorstPixel worst;           // where it is; the first in reading order
	std::optional<double> ssim; // mean structural similarity, 1 for equal images; none for images below 11 × 11 (see meanSsim)
	double flip = 0.0;          // mean FLIP, 0 to 1
	double eq14 = 0.0;          // AOV's perceptual error (see logError)
};

// Requires equal sizes ≥ 1 × 1, finite values and at least one pixel that counts. Sums run row by row in a fixed order.
Comparison compareImages(const VisibilityPlane& test, const VisibilityPlane& reference, const CompareSettings& settings,
						 const RunSettings& run);

// SSIM (Wang et al. 2004): windows of 11 × 11 pixels, Gaussian of σ = 1.5, K1 = 0.01, K2 = 0.03, L = 1; the mean over the pixels
// that count and whose window lies wholly inside the picture, as in the authors' own program. None where there is no such pixel.
std::optional<double> meanSsim(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
							   const RunSettings& run);

// LDR-FLIP (Andersson et al. 2020). Visibility is taken as a display value: gray with R = G = B = visibility in sRGB, clamped to
// 0 to 1. Borders repeat the outermost pixels.
double meanFlip(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
				double pixels_per_degree, const RunSettings& run);

// AOV (McGuire 2010) eq. 14 on 8-bit values: E = MSE[log†T] + ½ (MSE[log†∂T/∂x] + MSE[log†∂T/∂y]), with the natural logarithm,
// log†x = sign(x) log(|x| + 1). The paper leaves the derivatives open: here the difference to the next pixel to the right and
// below, the mean over the pairs that exist and count. Values beyond 0 to 1 are clamped, as 8 bits do.
double logError(const VisibilityPlane& test, const VisibilityPlane& reference, std::span<const uint8_t> counted,
				const RunSettings& run);

// The errors by which a comparison may be judged.
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

// 0 for equal images; none where SSIM is not defined.
std::optional<double> errorBy(const Comparison& comparison, ErrorMetric metric);

} // namespace nook
