// SPDX-License-Identifier: GPL-3.0-or-later
// Mean distances of many pairs of lines at once, in the processor's vectors, to the same bits as one by one (energy_kernels.h). For
// energy.cpp.
#pragma once

#include <array>
#include <cstddef>

namespace nook
{

// Pairs of a line a and a line b. A weight is that of a line times how much the pair counts.
struct LinePairs
{
	static constexpr std::size_t kMost = 64;

	template <class T> using Of = std::array<T, kMost>;
	Of<double> rho2; // squared distance in the plane
	Of<double> half_a, half_b;
	Of<double> weight_a, weight_b;

	// Found by findTerms: the distance K, and by how much w_b K grows along a's point (its gradient is −along_a · (p_a − p_b) +
	// turn_a · p_a), w_a K along b's.
	Of<double> distance;
	Of<double> along_a, along_b;
	Of<double> turn_a, turn_b;
};

// The first `count` pairs; what lies behind them is anything.
void findTerms(LinePairs& pairs, std::size_t count);

} // namespace nook
