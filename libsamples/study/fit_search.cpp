// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/fit_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace nook
{
namespace
{

// Rounds to three digits, the same on every machine: powers of ten up to 1e22 are exact.
double threeDigits(double value)
{
	double unit = 1.0;
	while (value * unit < 100.0)
	{
		unit *= 10.0;
	}
	return std::floor(value * unit + 0.5) / unit;
}

class NumberSearch
{
public:
	NumberSearch(const std::vector<FitNumber>& numbers, const std::function<double(const std::vector<double>&)>& error)
		: m_numbers(numbers), m_error(error)
	{
	}

	double at(const std::vector<double>& values)
	{
		const auto found = m_known.find(values);
		return found != m_known.end() ? found->second : m_known.emplace(values, m_error(values)).first->second;
	}

	double moved(std::size_t i, double value) const
	{
		return threeDigits(std::clamp(value, m_numbers[i].least, m_numbers[i].most));
	}

	// The best of each number up and down by a factor.
	std::vector<double> explored(std::vector<double> from, double factor)
	{
		for (std::size_t i = 0; i < from.size(); ++i)
		{
			for (const double by : {factor, 1.0 / factor})
			{
				std::vector<double> tried = from;
				tried[i] = moved(i, from[i] * by);
				if (at(tried) < at(from))
				{
					from = tried;
					break;
				}
			}
		}
		return from;
	}

	// Repeats the step from `before` to `now`.
	std::vector<double> onward(const std::vector<double>& before, const std::vector<double>& now) const
	{
		std::vector<double> next = now;
		for (std::size_t i = 0; i < next.size(); ++i)
		{
			next[i] = moved(i, now[i] * now[i] / before[i]);
		}
		return next;
	}

private:
	const std::vector<FitNumber>& m_numbers;
	const std::function<double(const std::vector<double>&)>& m_error;
	std::map<std::vector<double>, double> m_known;
};

} // namespace

std::size_t stepsOf(const FitSearch& search)
{
	std::size_t steps = 0;
	for (double factor = search.first_step; factor >= search.last_step; factor = std::sqrt(factor))
	{
		steps += 1;
	}
	return steps;
}

std::vector<double> fitNumbers(const std::vector<FitNumber>& numbers, const FitSearch& settings,
							   const std::function<double(const std::vector<double>&)>& error)
{
	NumberSearch search(numbers, error);
	std::vector<double> best;
	for (std::size_t i = 0; i < numbers.size(); ++i)
	{
		best.push_back(search.moved(i, numbers[i].start));
	}
	for (double factor = settings.first_step; factor >= settings.last_step; factor = std::sqrt(factor))
	{
		for (std::vector<double> next = search.explored(best, factor); search.at(next) < search.at(best);)
		{
			const std::vector<double> before = best;
			best = next;
			next = search.explored(search.onward(before, best), factor);
			if (!(search.at(next) < search.at(best)))
			{
				next = search.explored(best, factor);
			}
		}
		if (settings.step_done)
		{
			settings.step_done();
		}
	}
	return best;
}

} // namespace nook
