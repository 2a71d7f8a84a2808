// SPDX-License-Identifier: GPL-3.0-or-later
// Which candidates share what takes long to make, and about how long each takes: how a report is shared out.
#pragma once

#include "bench/candidates.h"

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// Candidates of one name draw the same samples or the same volumes, in whatever view.
std::string sharedBy(const Candidate& candidate);

// What a view is like, as far as time goes.
struct ViewCost
{
	std::size_t pixels = 0;
	std::size_t triangles = 0; // of its level
	int repetitions = 0;
};

// Estimates. The first candidate of each name has what is made once.
class CandidateCosts
{
public:
	CandidateCosts(std::span<const Candidate> candidates, const ViewCost& view);

	// Of one thread.
	double seconds(std::size_t candidate) const
	{
		return m_seconds[candidate];
	}

private:
	std::vector<double> m_seconds;
};

} // namespace nook
