// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/tune_trial.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <utility>

namespace nook
{
namespace
{

double overLevels(const Trial& trial, OverLevels over, double ViewTrial::*value)
{
	std::map<std::size_t, std::pair<double, std::size_t>> sums;
	for (const ViewTrial& view : trial.views)
	{
		sums[view.level].first += view.*value;
		sums[view.level].second += 1;
	}
	double mean = 0.0;
	double worst = 0.0;
	for (const auto& [level, sum] : sums)
	{
		const double of_level = sum.first / static_cast<double>(sum.second);
		mean += of_level / static_cast<double>(sums.size());
		worst = std::max(worst, of_level);
	}
	return over == OverLevels::mean ? mean : worst;
}

} // namespace

double timeOf(const Trial& trial, OverLevels over)
{
	return overLevels(trial, over, &ViewTrial::time_s);
}

double errorOf(const Trial& trial, OverLevels over)
{
	return overLevels(trial, over, &ViewTrial::error);
}

uint64_t bytesOf(const Trial& trial)
{
	uint64_t most = 0;
	for (const ViewTrial& view : trial.views)
	{
		most = std::max(most, view.bytes);
	}
	return most;
}

bool reaches(const TuneGoal& goal, double time_s, double error)
{
	return goal.budget_s ? time_s <= *goal.budget_s : error <= *goal.max_error;
}

CandidateComparison compareTrials(const Trial& first, const Trial& second)
{
	assert(first.views.size() == second.views.size() && !first.views.empty());
	CandidateComparison made;
	made.views = first.views.size();
	const auto n = static_cast<double>(made.views);
	double first_time = 0.0;
	double second_time = 0.0;
	bool spread = true;
	bool differ = true;
	for (std::size_t i = 0; i < made.views; ++i)
	{
		const ViewTrial& one = first.views[i];
		const ViewTrial& other = second.views[i];
		made.error_difference += (other.error - one.error) / n;
		first_time += one.time_s;
		second_time += other.time_s;
		spread = spread && one.high_s > one.low_s && other.high_s > other.low_s;
		differ = differ && (one.high_s < other.low_s || other.high_s < one.low_s);
	}
	if (spread)
	{
		made.times_differ = differ;
	}
	if (first_time > 0.0)
	{
		made.time_ratio = second_time / first_time;
	}
	if (made.views > 1)
	{
		double squares = 0.0;
		for (std::size_t i = 0; i < made.views; ++i)
		{
			const double off = second.views[i].error - first.views[i].error - made.error_difference;
			squares += off * off;
		}
		made.error_standard = std::sqrt(squares / (n - 1.0) / n);
		made.errors_differ = std::fabs(made.error_difference) > 2.0 * *made.error_standard;
	}
	return made;
}

} // namespace nook
