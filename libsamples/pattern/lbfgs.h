// SPDX-License-Identifier: GPL-3.0-or-later
// Finds a local minimum of a smooth function near a starting point.
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
	int memory = 12;                  // number of step pairs kept
	double relative_decrease = 1e-10; // stop when ten iterations together lower the value by less than this fraction
	std::function<void(std::span<const double> x)> seen{}; // called after each iteration; may be empty
};

// Progress items per descent: the iterations plus the start's value.
inline std::size_t stepsOf(const LbfgsSettings& settings)
{
	return static_cast<std::size_t>(settings.max_iterations) + 1;
}

// Returns the value at x and writes the gradient (same size as x); infinity where x is invalid (the gradient is then ignored).
using Objective = std::function<double(std::span<const double> x, std::span<double> gradient)>;

// Limited-memory BFGS with a backtracking line search. Replaces x with the best point found and returns its value. The start must
// be valid. Sums run in index order, so the result is the same everywhere.
double minimise(const Objective& objective, std::vector<double>& x, const LbfgsSettings& settings = {});

} // namespace nook
