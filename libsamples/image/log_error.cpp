// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Morgan McGuire, "Ambient Occlusion Volumes", High Performance Graphics, 2010, eq. 14.
#include "core/math.h"
#include "core/parallel.h"
#include "image/compare.h"
#include "pattern/filter_band.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace nook
{
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

} // namespace nook
