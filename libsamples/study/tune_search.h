// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates and what measuring one costs → the best of them for a budget of time, or for a bound of error, measuring most of them
// only coarsely: successive halving (Karnin, Koren, Somekh 2013; Jamieson and Talwalkar 2016) over the size of the picture, the
// number of views and the repetitions of a drawing.
//
// Candidates go on by what the last rung is expected to find: the bounded quantity, time or error, is scaled by that of a few
// candidates near the bound, which are drawn there. In the end no candidate is only expected to be better than the pick: those that
// are get drawn on all views. The cheapest candidate is taken among those whose errors do not differ significantly.
#pragma once

#include "core/progress.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

// A candidate's measurements on some views → its time and its error over levels, whether that reaches a goal, and how certain it is
// that another one is better.

// A candidate on one view.
struct ViewTrial
{
	std::size_t level = 0; // views of one level count as one level
	double time_s = 0.0;   // median
	double low_s = 0.0;    // quartiles
	double high_s = 0.0;
	double error = 0.0;
	uint64_t bytes = 0; // size of what its level needs for it: volumes, or a bake
};

struct Trial
{
	std::vector<ViewTrial> views;
	double cost_s = 0.0;   // what measuring took
	double pictures = 0.0; // of full size: the pixels of all drawings, those that warm up among them
};

// How levels are summed up; within a level, times and errors are means over its views.
enum class OverLevels
{
	mean,
	worst, // the greatest time of any level, and the greatest error of any
};

// Exactly one of the two bounds is set.
struct TuneGoal
{
	std::optional<double> budget_s;  // > 0: least error within
	std::optional<double> max_error; // > 0: least time with no more
	OverLevels over = OverLevels::mean;
};

double timeOf(const Trial& trial, OverLevels over);
double errorOf(const Trial& trial, OverLevels over);

// Returns the bytes of the level that needs the most.
uint64_t bytesOf(const Trial& trial);

// Returns whether that time or that error is within the bound.
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

// How thoroughly a candidate is measured.
struct Fidelity
{
	double scale = 1.0;    // side of the picture as a share of the full one, (0, 1]
	std::size_t views = 1; // the first ones
	int repetitions = 1;   // drawings after one that warms up
};

// Throws Error for a candidate that cannot be drawn: it is left out, with what the error says.
using MeasureTrial = std::function<Trial(std::size_t candidate, const Fidelity& fidelity)>;

struct TuneSearchSettings
{
	// Coarse to full: the last one is what counts, at scale 1, and the one before it draws the same once.
	std::vector<Fidelity> rungs;
	double keep_coarse = 0.15; // share of a rung's candidates that goes on, where pictures are smaller
	double keep_full = 0.4;    // the same at full size
	std::size_t least = 4;     // candidates that go on, at the least

	// The rung before the last one.
	std::size_t once() const
	{
		return rungs.size() - 2;
	}
};

// A candidate and what is known of it.
struct Tried
{
	std::size_t candidate = 0;
	std::size_t rung = 0; // the last one that it was measured at
	Trial trial;          // there
	double time_s = 0.0;  // over levels; before the last rung both are what the last rung is expected to find
	double error = 0.0;
	std::string failed; // what made it impossible; else empty
};

// Returns whether it was measured at this rung or a later one.
inline bool isFrom(const Tried& tried, std::size_t rung)
{
	return tried.failed.empty() && tried.rung >= rung && !tried.trial.views.empty();
}

struct RungCost
{
	std::size_t candidates = 0;
	double cost_s = 0.0; // those measured ahead for its scale included
};

struct TuneSearch
{
	std::vector<Tried> tried;              // candidate i is item i
	std::optional<std::size_t> pick;       // reaches the goal; none: nothing does
	std::optional<std::size_t> nearest;    // where there is no pick: the fastest, or one with the least error
	std::optional<std::size_t> instead_of; // has the least error, but by too little to be worth its time
	std::optional<std::size_t> runner_up;  // reaches the goal as well, at the last rung or the one before
	std::vector<RungCost> rungs;
	double cost_s = 0.0;
	double pictures = 0.0; // as a trial's

	// Returns the pick, or the nearest candidate; none where nothing could be drawn.
	std::optional<std::size_t> taken() const
	{
		return pick ? pick : nearest;
	}
};

// Requires at least one candidate and two rungs, and a goal of one kind.
TuneSearch searchCandidates(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings,
							const MeasureTrial& measure, const Progress& progress = {});

// Returns the measurements with pick, or nearest, and instead_of and runner_up set by the goal.
TuneSearch chooseOf(TuneSearch measured, const TuneGoal& goal, const TuneSearchSettings& settings);

// Returns the front of those measured at this rung or a later one, by time.
std::vector<std::size_t> frontOf(const TuneSearch& search, std::size_t rung);

} // namespace nook
