// SPDX-License-Identifier: GPL-3.0-or-later
// Of all candidates of a view: which are measured over the radius, which are drawn behind a mean over frames, which are shown.
#pragma once

#include "error_report/error_report.h"

#include <cstddef>
#include <set>
#include <vector>

namespace nook
{

// Methods whose time over the radius papers speak of; without filters, which have their own time.
std::vector<Candidate> sweepOf(const std::vector<Candidate>& grid);

// Of each screen-space method with samples the candidate that takes fewest and has a filter, where one has. `candidates`: of the
// view's points.
std::vector<std::size_t> framesPoints(const std::vector<Candidate>& candidates, const ErrorView& view);

// At most `count` points: the front's, evenly spaced, and the best recipe of each method.
std::set<std::size_t> chosenPoints(const ErrorView& view, std::size_t count);

// All that chosenPoints() chooses from: the front, and the best recipe of each method. Of some of a view's points, with their own
// front: whatever of them is chosen from all is among these.
std::set<std::size_t> likelyPoints(const ErrorView& view);

} // namespace nook
