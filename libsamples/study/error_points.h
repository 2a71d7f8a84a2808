// SPDX-License-Identifier: GPL-3.0-or-later
// A report's candidates on a view → about what each costs, and which points are shown. For error_measure.cpp.
#pragma once

#include "study/candidates.h"
#include "study/error_report.h"

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// Which candidates share what takes long to make, and about how long each takes: how a report is shared out.

// Candidates of one name draw the same samples, on whatever level, or the same volumes or bake of this level. `level`: any name
// that is its own.
std::string sharedBy(const Candidate& candidate, const std::string& level);

// The facts of a view that its costs depend on.
struct ViewCost
{
	std::string level; // a name that is its own
	std::size_t pixels = 0;
	std::size_t triangles = 0; // of its level
	int repetitions = 0;
};

// Estimates of the seconds that each candidate takes on one thread. The first candidate of each name bears what is made once.
// `made`: the names of views before; grows.
std::vector<double> candidateSeconds(std::span<const Candidate> candidates, const ViewCost& view, std::set<std::string>& made);

// Returns at most `count` points: the front's, evenly spaced, and the best recipe of each method.
std::set<std::size_t> chosenPoints(const ErrorView& view, std::size_t count);

// Returns all that chosenPoints() chooses from: the front, and the best recipe of each method. With some of a view's points and
// their own front, the result contains whatever of them is chosen from all points.
std::set<std::size_t> likelyPoints(const ErrorView& view);

void visit(Archive& archive, ScreenLimit& limit);

} // namespace nook
