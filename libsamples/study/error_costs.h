// SPDX-License-Identifier: GPL-3.0-or-later
// Which candidates share what takes long to make, and about how long each takes: how a report is shared out.
#pragma once

#include "study/candidates.h"

#include <cstddef>
#include <set>
#include <span>
#include <string>
#include <vector>

namespace nook
{

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

// Estimates. The first candidate of each name has what is made once.
class CandidateCosts
{
public:
	// `made`: the names of views before; grows.
	CandidateCosts(std::span<const Candidate> candidates, const ViewCost& view, std::set<std::string>& made);

	// On one thread.
	double seconds(std::size_t candidate) const
	{
		return m_seconds[candidate];
	}

private:
	std::vector<double> m_seconds;
};

// Returns the seconds that the screen-space limit of a view takes.
double limitSeconds(const ViewCost& view);

} // namespace nook
