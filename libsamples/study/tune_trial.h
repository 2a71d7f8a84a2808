// SPDX-License-Identifier: GPL-3.0-or-later
// A candidate's measurements on some views → its time and its error over levels, whether that reaches a goal, and how certain it is
// that another one is better.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace nook
{

// On one view.
struct ViewTrial
{
	std::size_t level = 0; // views of one level count as one level
	double time_s = 0.0;   // median
	double low_s = 0.0;    // quartiles
	double high_s = 0.0;
	double error = 0.0;
	uint64_t bytes = 0; // of what its level needs for it: volumes, or a bake
};

struct Trial
{
	std::vector<ViewTrial> views;
	double cost_s = 0.0;   // what measuring took
	double pictures = 0.0; // of full size: the pixels of all drawings, those that warm up among them
};

// Over levels; within a level times and errors are means over its views.
enum class OverLevels
{
	mean,
	worst, // the greatest time of any level, and the greatest error of any
};

// One of the two.
struct TuneGoal
{
	std::optional<double> budget_s;  // > 0: least error within
	std::optional<double> max_error; // > 0: least time with no more
	OverLevels over = OverLevels::mean;
};

double timeOf(const Trial& trial, OverLevels over);
double errorOf(const Trial& trial, OverLevels over);

// Returns the bytes of the level that needs most.
uint64_t bytesOf(const Trial& trial);

// Reaches the goal.
bool reaches(const TuneGoal& goal, double time_s, double error);

// How sure it is that one candidate is better than another, from trials on the same views.
struct CandidateComparison
{
	std::size_t views = 0;
	double error_difference = 0.0;        // second less first, mean over views
	std::optional<double> error_standard; // standard error of that mean; none with fewer than two views
	bool errors_differ = false;           // by more than twice that (about 95 %)
	std::optional<double> time_ratio;     // second to first, mean over views; none where the first takes none (a bake)
	std::optional<bool> times_differ;     // the quartiles overlap on no view; none where one of them was drawn once
};
CandidateComparison compareTrials(const Trial& first, const Trial& second);

} // namespace nook
