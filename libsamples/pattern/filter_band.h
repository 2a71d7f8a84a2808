// SPDX-License-Identifier: GPL-3.0-or-later
// Separable filters over bands of rows, so that a picture of any height needs memory for only a few rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace nook
{

// Weights of 2 × radius + 1 neighbours, starting at −radius.
struct Kernel
{
	int radius = 0;
	std::vector<double> weights;
};

// exp(−x²/(2σ²)), normalised to sum 1.
Kernel gaussianKernel(double sigma_px, int radius);

// Rows [first, last) of a picture.
struct Band
{
	int width_px = 0;
	int height_px = 0; // height of the whole picture
	int first = 0;
	int last = 0;
};

inline constexpr int kBandRows = 64;

// The picture's rows in bands of kBandRows.
std::vector<Band> bandsOf(int width_px, int height_px);

// Writes row y of the picture, 0 ≤ y < height.
using RowSource = std::function<void(int y, std::span<double> row)>;

// A band of the filtered picture: kernel_x along rows, kernel_y along columns (correlation: the weight of offset k applies to the
// pixel at x + k). Border pixels are repeated.
std::vector<double> filteredBand(const Band& band, const RowSource& source, const Kernel& kernel_x, const Kernel& kernel_y);

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

// Adds the tallies of the rows in order.
PixelTally total(std::span<const PixelTally> rows);

inline bool counts(std::span<const uint8_t> counted, std::size_t pixel)
{
	return counted.empty() || counted[pixel] != 0;
}

} // namespace nook
