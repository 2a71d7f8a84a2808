// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/texture_fill.h"

#include <algorithm>
#include <cstddef>

namespace nook
{
namespace
{

constexpr int kRings = 4; // what bilinear filters read in the first two mipmaps

void addRing(std::vector<float>& values, int size_px)
{
	const std::vector<float> before = values;
	const auto at = [&](int x, int y)
	{
		return static_cast<std::size_t>(y) * static_cast<std::size_t>(size_px) + static_cast<std::size_t>(x);
	};
	for (int y = 0; y < size_px; ++y)
	{
		for (int x = 0; x < size_px; ++x)
		{
			if (before[at(x, y)] >= 0.0F)
			{
				continue;
			}
			float sum = 0.0F;
			float count = 0.0F;
			for (int v = std::max(0, y - 1); v <= std::min(size_px - 1, y + 1); ++v)
			{
				for (int u = std::max(0, x - 1); u <= std::min(size_px - 1, x + 1); ++u)
				{
					if (before[at(u, v)] >= 0.0F)
					{
						sum += before[at(u, v)];
						count += 1.0F;
					}
				}
			}
			if (count > 0.0F)
			{
				values[at(x, y)] = sum / count;
			}
		}
	}
}

// Means of what is filled, by two and two, down to one texel; empty ones take the coarser level's.
void pull(std::vector<float>& values, int size_px)
{
	if (size_px <= 1)
	{
		values[0] = values[0] < 0.0F ? 1.0F : values[0];
		return;
	}
	const int half = (size_px + 1) / 2;
	std::vector<float> sums(static_cast<std::size_t>(half) * static_cast<std::size_t>(half), 0.0F);
	std::vector<float> counts(sums.size(), 0.0F);
	const auto parentOf = [&](std::size_t i)
	{
		const auto size = static_cast<std::size_t>(size_px);
		return i / size / 2 * static_cast<std::size_t>(half) + i % size / 2;
	};
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		if (values[i] >= 0.0F)
		{
			sums[parentOf(i)] += values[i];
			counts[parentOf(i)] += 1.0F;
		}
	}
	for (std::size_t i = 0; i < sums.size(); ++i)
	{
		sums[i] = counts[i] > 0.0F ? sums[i] / counts[i] : -1.0F;
	}
	pull(sums, half);
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		values[i] = values[i] < 0.0F ? sums[parentOf(i)] : values[i];
	}
}

} // namespace

void fillEmpty(std::vector<float>& values, int size_px)
{
	for (int ring = 0; ring < kRings; ++ring)
	{
		addRing(values, size_px);
	}
	pull(values, size_px);
}

} // namespace nook
