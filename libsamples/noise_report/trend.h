// SPDX-License-Identifier: GPL-3.0-or-later
// A measure at many counts → how it falls with the count, and which counts lie below the trend of their neighbours.
#pragma once

#include <map>
#include <optional>

namespace nook
{

using MeasureByCount = std::map<int, double>;

// Smaller values are zero but for rounding and the grid, and take part in no trend (the symmetric patterns' centre error, the
// sphere's bias).
inline constexpr double kNegligible = 2e-5;

// A count is marked as better than its neighbours from here down.
inline constexpr double kDipRatio = 0.95;

struct PowerFit // value ≈ factor · count^−exponent
{
	double factor = 0.0;
	double exponent = 0.0;
};

// Least squares in logarithms over the counts from `first_count` up. Absent with fewer than 4 values that are not negligible.
std::optional<PowerFit> fitPower(const MeasureByCount& values, int first_count = 4);

// The value over the geometric mean of up to two neighbours a side, no further than 4 counts away, each carried to this count
// along count^−exponent. Absent where a side has no neighbour or the value is negligible.
std::optional<double> localRatio(const MeasureByCount& values, int count, double exponent);

} // namespace nook
