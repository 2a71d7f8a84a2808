// SPDX-License-Identifier: GPL-3.0-or-later
// Measurements of a search and a goal → the candidate to take, and the ones to measure before that is certain.
#pragma once

#include "study/tune_search.h"

#include <cstddef>
#include <optional>
#include <vector>

namespace nook
{

// Where the errors of two candidates do not differ significantly, the second is taken if its error is no greater than this many
// times the first's, and its time no longer than this many times the first's. A significance over few views is coarse, and less
// than 5 % of a time is the clock's.
inline constexpr double kAlikeError = 1.02;
inline constexpr double kAlikeTime = 0.95;

// By how much what a rung expects may be off, and the candidate still goes on: at coarse size, and at full size with fewer views.
// Tuned on the grids of test_tune_search.cpp.
inline constexpr double kTimeSlack = 1.5;
inline constexpr double kErrorSlack = 1.15;
inline constexpr double kFullSizeSlack = 1.06;

// Drawn once on all views: errors are what they are, and a time this much longer is not that of the pick.
inline constexpr double kOnceSlack = 1.15;

class TuneChoice
{
public:
	TuneChoice(const TuneGoal& goal, const TuneSearchSettings& settings)
		: m_goal(goal), m_settings(settings), m_once(settings.once()), m_last(settings.rungs.size() - 1)
	{
	}

	// The quantity to minimise, and the bounded one as a share of its bound.
	double wanted(const Tried& tried) const
	{
		return m_goal.budget_s ? tried.error : tried.time_s;
	}
	double bounded(const Tried& tried) const
	{
		return m_goal.budget_s ? tried.time_s / *m_goal.budget_s : tried.error / *m_goal.max_error;
	}

	// Returns the candidates `left` at a rung that go on.
	std::vector<std::size_t> best(const TuneSearch& search, const std::vector<std::size_t>& left, std::size_t rung) const;

	// Returns those drawn once on all views that can be the pick, best first; the nearest where none can.
	std::vector<std::size_t> possible(const TuneSearch& search, const std::vector<std::size_t>& left) const;

	// Sets pick, or nearest, and instead_of and runner_up. Of what was measured in full the one with the least of what is wanted;
	// where that is an error, the fastest of those that are like it.
	void choose(TuneSearch& search) const;

	// Not measured in full, but expected to reach the goal and to be better than the pick: the best of them. None where there is no
	// pick.
	std::optional<std::size_t> expectedBetter(const TuneSearch& search) const;

	// Not measured in full, and expected to be the fastest of those that are like the pick, or what comes nearest.
	std::optional<std::size_t> expectedAlike(const TuneSearch& search) const;

private:
	double slackAt(std::size_t rung) const;
	bool isAlike(const Tried& best, const Tried& other) const;
	static bool isCheaper(const Tried& one, const Tried& other); // in time, and of equal times in bytes

	TuneGoal m_goal;
	TuneSearchSettings m_settings;
	std::size_t m_once; // the rung where all views are drawn once
	std::size_t m_last;
};

} // namespace nook
