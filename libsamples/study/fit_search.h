// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers above 0 and what is wrong with them → numbers with less of that.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace nook
{

struct FitNumber
{
	double start = 1.0;
	double least = 1e-3;
	double most = 1e3;
};

struct FitSearch
{
	double first_step = 1.4; // factor
	double last_step = 1.03;
	std::function<void()> step_done{}; // after each of stepsOf(); may be empty
};

std::size_t stepsOf(const FitSearch& search);

// Pattern search (R. Hooke, T. A. Jeeves, "Direct Search Solution of Numerical and Statistical Problems", 1961) over logarithms:
// one number after another up and down by a step, on along what helped, steps halved where nothing does. Numbers have three digits,
// so that what is written down is what was tried. `error` is asked once for equal numbers.
std::vector<double> fitNumbers(const std::vector<FitNumber>& numbers, const FitSearch& search,
							   const std::function<double(const std::vector<double>&)>& error);

} // namespace nook
