// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/filter_band.h"

#include "core/math.h"

#include <algorithm>

namespace nook
{
namespace
{

// Extends the row by `radius` copies of its end pixels on either side.
void extend(std::vector<double>& row, int radius, int width)
{
	const auto begin = row.begin() + radius;
	const auto end = begin + width;
	std::fill(row.begin(), begin, *begin);
	std::fill(end, row.end(), *(end - 1));
}

} // namespace

Kernel gaussianKernel(double sigma_px, int radius)
{
	Kernel kernel{radius, {}};
	double sum = 0.0;
	for (int i = -radius; i <= radius; ++i)
	{
		kernel.weights.push_back(expOf(-0.5 * i * i / (sigma_px * sigma_px)));
		sum += kernel.weights.back();
	}
	for (double& weight : kernel.weights)
	{
		weight /= sum;
	}
	return kernel;
}

std::vector<Band> bandsOf(int width_px, int height_px)
{
	std::vector<Band> bands;
	for (int first = 0; first < height_px; first += kBandRows)
	{
		bands.push_back({width_px, height_px, first, std::min(first + kBandRows, height_px)});
	}
	return bands;
}

std::vector<double> filteredBand(const Band& band, const RowSource& source, const Kernel& kernel_x, const Kernel& kernel_y)
{
	const auto width = static_cast<std::size_t>(band.width_px);
	const auto rows = static_cast<std::size_t>(band.last - band.first);
	std::vector<double> result(rows * width, 0.0);
	std::vector<double> wide(width + 2 * static_cast<std::size_t>(kernel_x.radius));
	std::vector<double> filtered(width);
	const int top = std::max(0, band.first - kernel_y.radius);
	const int bottom = std::min(band.height_px, band.last + kernel_y.radius);
	for (int y = top; y < bottom; ++y)
	{
		source(y, std::span(wide).subspan(static_cast<std::size_t>(kernel_x.radius), width));
		extend(wide, kernel_x.radius, band.width_px);
		std::fill(filtered.begin(), filtered.end(), 0.0);
		for (std::size_t k = 0; k < kernel_x.weights.size(); ++k)
		{
			const double weight = kernel_x.weights[k];
			for (std::size_t x = 0; x < width; ++x)
			{
				filtered[x] += weight * wide[x + k];
			}
		}
		// The first and the last row of the picture also represent those beyond it.
		const int from = y == 0 ? -kernel_y.radius : y;
		const int to = y == band.height_px - 1 ? y + kernel_y.radius : y;
		for (int at = from; at <= to; ++at)
		{
			for (int out = std::max(band.first, at - kernel_y.radius); out < std::min(band.last, at + kernel_y.radius + 1); ++out)
			{
				const double weight = kernel_y.weights[static_cast<std::size_t>(at - out + kernel_y.radius)];
				double* const target = result.data() + static_cast<std::size_t>(out - band.first) * width;
				for (std::size_t x = 0; x < width; ++x)
				{
					target[x] += weight * filtered[x];
				}
			}
		}
	}
	return result;
}

PixelTally total(std::span<const PixelTally> rows)
{
	PixelTally sum;
	for (const PixelTally& row : rows)
	{
		sum += row;
	}
	return sum;
}

} // namespace nook
