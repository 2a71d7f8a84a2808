// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/filter_band.h"

#include "core/math.h"
#include "pattern/quality.h"

#include <algorithm>
#include <array>
#include <iterator>

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

constexpr std::array<int, 3> kBegun{2, 4, 8}; // frames in means that have just begun

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

std::vector<Measure> measuresBehind(const PatternTile& tile, const std::vector<TileFilter>& filters, double ema, double most_steps,
									const RunSettings& run)
{
	std::vector<Measure> measures;
	const TileTime time{tile.frames, ema, tile.moves};
	const std::size_t count = tile.variants.front().count();
	std::vector<int> lasts;
	std::copy_if(kBegun.begin(), kBegun.end(), std::back_inserter(lasts), [&](int last) { return last < tile.frames; });
	ProgressCounter progress(run.progress, "behind filters", filters.size() * (tile.frames > 1 ? 5 + lasts.size() : 2));
	for (const TileFilter& filter : filters)
	{
		const auto error = [&](const std::vector<TileFilter>& parts, int last, glm::ivec2 pan) -> std::optional<double>
		{
			std::vector<TileShares> shares;
			double steps = 0.0;
			for (const TileFilter& part : parts)
			{
				steps += stepsOfShares(tile.size, part, time, pan != glm::ivec2(0));
				if (steps > most_steps)
				{
					return std::nullopt;
				}
				shares.push_back(sharesOf(tile.size, part, time, last, pan));
			}
			return stepsOfError(shares.front(), count) <= most_steps ? std::optional(errorBehind(tile, shares, run)) : std::nullopt;
		};
		const auto add = [&](const std::string& name, const std::vector<TileFilter>& parts, int last, glm::ivec2 pan)
		{
			if (const std::optional<double> found = error(parts, last, pan))
			{
				measures.push_back({filter.name + name, *found});
			}
			progress.finishOne();
		};
		add("", {filter}, 1, {0, 0});
		add(", half", halvesOf(filter), 1, {0, 0});
		if (tile.frames > 1)
		{
			add(", frames", {filter}, 0, {0, 0});
			add(", frames, panned", {filter}, 0, {1, 0});
			for (const int last : lasts)
			{
				add(", first " + std::to_string(last), {filter}, last, {0, 0});
			}
			add(", cycle", {filter}, tile.frames, {0, 0});
		}
	}
	return measures;
}

} // namespace nook
