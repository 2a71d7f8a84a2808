// SPDX-License-Identifier: GPL-3.0-or-later
// Mean distances of many pairs of lines at once with vector instructions, bit-identical to the scalar code (energy_kernels.h). For
// energy.cpp.
#pragma once

#include <array>
#include <cstddef>

namespace nook
{

// Pairs of lines a and b. A weight is the line's weight times the pair's.
struct LinePairs
{
	static constexpr std::size_t kMost = 64;

	template <class T> using Of = std::array<T, kMost>;
	Of<double> rho2; // squared distance in the plane
	Of<double> half_a, half_b;
	Of<double> weight_a, weight_b;

	// Results: the distance K, and the growth of w_b K along a's point (its gradient is −along_a · (p_a − p_b) + turn_a · p_a) and
	// of w_a K along b's.
	Of<double> distance;
	Of<double> along_a, along_b;
	Of<double> turn_a, turn_b;
};

// Computes the first `count` pairs; the values after them are unspecified.
void findTerms(LinePairs& pairs, std::size_t count);

} // namespace nook
