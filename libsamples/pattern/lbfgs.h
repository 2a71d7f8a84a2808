// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth function and a starting point → a nearby minimum.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace nook
{

struct LbfgsSettings
{
	int max_iterations = 200;
	int memory = 12;                  // pairs of steps kept
	double relative_decrease = 1e-10; // stop when ten iterations together lower the value by less than this share of it
	std::function<void(std::span<const double> x)> seen{}; // after each iteration; may be empty
};

// What a stage of such descents counts of each: its iterations and the start's value.
inline std::size_t stepsOf(const LbfgsSettings& settings)
{
	return static_cast<std::size_t>(settings.max_iterations) + 1;
}

// Returns the value at x and writes the gradient (same size as x); infinity where x is not allowed (the gradient is then ignored).
using Objective = std::function<double(std::span<const double> x, std::span<double> gradient)>;

// Limited-memory BFGS with a backtracking line search; x is replaced by the best point found, whose value is returned.
// The start must be allowed. Sums run in index order, so the result is the same everywhere.
double minimise(const Objective& objective, std::vector<double>& x, const LbfgsSettings& settings = {});

} // namespace nook
