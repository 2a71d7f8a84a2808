// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/table_scan.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace nook
{
namespace
{

constexpr std::size_t kBand = 64; // columns that one thread sums at a time

} // namespace

void scanOnCpu(const PicturePlane& source, int axis, PicturePlane& target, const RunSettings& run)
{
	assert(source.counts.size() == target.counts.size() && source.width == target.width);
	const std::size_t row = source.index(0, 1);
	const auto height = static_cast<std::size_t>(source.height);
	if (axis == 0)
	{
		parallelFor(height, run.threads,
					[&](std::size_t y)
					{
						std::array<std::uint32_t, 4> sum{};
						for (std::size_t i = y * row; i < (y + 1) * row; ++i)
						{
							sum[i % 4] += source.counts[i];
							target.counts[i] = sum[i % 4];
						}
					});
		return;
	}
	parallelFor((row / 4 + kBand - 1) / kBand, run.threads,
				[&](std::size_t band)
				{
					const std::size_t first = 4 * kBand * band;
					const std::size_t end = std::min(row, first + 4 * kBand);
					for (std::size_t y = 0; y < height; ++y)
					{
						for (std::size_t i = y * row + first; i < y * row + end; ++i)
						{
							target.counts[i] = source.counts[i] + (y > 0 ? target.counts[i - row] : 0U);
						}
					}
				});
}

} // namespace nook
