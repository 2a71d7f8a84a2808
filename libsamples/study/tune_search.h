// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates and what measuring one costs → the best of them for a budget of time, or for a bound of error, measuring most of them
// only coarsely: successive halving (Karnin, Koren, Somekh 2013; Jamieson and Talwalkar 2016) over the size of the picture, the
// number of views and the repetitions of a drawing.
//
// Which candidates go on is told by what they are expected to do at the last rung: what is bounded, time or error, is scaled by
// what a few of them, near the bound, were found to have there. At the end nothing is only expected to be better than the pick:
// what is, is drawn on all views. Of candidates whose errors do not differ significantly the cheapest is taken.
#pragma once

#include "core/progress.h"
#include "study/tune_trial.h"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

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

// The best known of a candidate.
struct Tried
{
	std::size_t candidate = 0;
	std::size_t rung = 0; // the last one that it was measured at
	Trial trial;          // there
	double time_s = 0.0;  // over levels; before the last rung both are what the last rung is expected to find
	double error = 0.0;
	std::string failed; // what made it impossible; else empty
};

// Measured at this rung or a later one.
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

// Measures everything at the last rung, for comparison with the search. Measurements of `known` at that rung are used again, and
// their cost counts.
TuneSearch searchGrid(std::size_t candidates, const TuneGoal& goal, const TuneSearchSettings& settings, const MeasureTrial& measure,
					  const TuneSearch* known = nullptr, const Progress& progress = {});

// Returns the front of those measured at this rung or a later one, by time.
std::vector<std::size_t> frontOf(const TuneSearch& search, std::size_t rung);

} // namespace nook
