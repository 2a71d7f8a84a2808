// SPDX-License-Identifier: GPL-3.0-or-later
// Candidates by what they are, not by what they are called.
#pragma once

#include "bench/candidates.h"

#include <optional>

namespace nook
{

// What is not said is of no matter; but nothing may be added: no thickness or other feature that has a word, every pixel by itself,
// radii as they are.
struct CandidateQuery
{
	const MethodRow* row = nullptr; // its method; null: rays
	std::optional<int> count{};
	std::optional<SampleSource> source{};
	std::optional<ShadeFilter> filter{};
	std::optional<VolumeRecipe> volumes{};
};

bool fits(const Candidate& candidate, const CandidateQuery& query);

} // namespace nook
