// SPDX-License-Identifier: GPL-3.0-or-later
// Which candidates share what takes long to make, and about how long each takes: how a report is shared out.
#pragma once

#include "bench/candidates.h"

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

// What a view is like, as far as time goes.
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

	// Of one thread.
	double seconds(std::size_t candidate) const
	{
		return m_seconds[candidate];
	}

private:
	std::vector<double> m_seconds;
};

// Of both limits of a view.
double limitSeconds(const ViewCost& view);

} // namespace nook
