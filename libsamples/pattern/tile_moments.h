// SPDX-License-Identifier: GPL-3.0-or-later
// Approximates a large tile's squared error behind a filter and a mean over frames in time linear in the samples, not in the pairs
// of samples.
#pragma once

#include "pattern/energy.h"

#include <array>
#include <span>
#include <vector>

namespace nook
{

// Memory of one evaluation per variant, in addition to points, weights and their gradient.
std::size_t momentBytes(Domain domain, const TileShares& shares);

// Temporary memory for the constructor.
std::size_t formBytes(Domain domain);

class TileMoments
{
public:
	// `shares` as for tileSquaredError.
	TileMoments(Domain domain, const TileShares& shares);

	// Like tileSquaredError, with its gradient: exact among the samples of one variant, by moments between variants. `threads`
	// never changes the result.
	double operator()(std::span<const glm::dvec3> points, std::span<const double> weights, EnergyGradient& gradient, int threads);

private:
	using Exponents = std::array<int, 3>;

	struct Offset
	{
		int dx;
		int dy;
		std::vector<double> shares; // by frames later, or by frequency
	};

	void makeForm();
	void makeOffsets(const TileShares& shares);
	void findMoments(std::span<const glm::dvec3> points, std::span<const double> weights, int threads);
	void turnInTime(const std::vector<double>& from, std::vector<double>& to, bool back, int threads) const;
	void meet(const std::vector<double>& from, std::vector<double>& to, int threads) const;
	double pullBack(std::span<const glm::dvec3> points, std::span<const double> weights, EnergyGradient& gradient, int threads);

	Domain m_domain;
	std::size_t m_size;
	std::size_t m_frames;
	double m_own;                                     // weight of a variant with itself
	bool m_even = true;                               // the weights are symmetric in time
	std::vector<Exponents> m_exponents;               // of the monomials
	std::vector<std::array<std::size_t, 2>> m_ranges; // ranges of the monomials with equal parity
	std::vector<double> m_form;                       // A, monomials × monomials
	std::vector<Offset> m_offsets;
	std::vector<double> m_waves;   // frames × frames, orthonormal
	std::vector<double> m_moments; // variants × monomials, like the following
	std::vector<double> m_met;
	std::vector<double> m_spare;
};

} // namespace nook
