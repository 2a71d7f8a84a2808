// SPDX-License-Identifier: GPL-3.0-or-later
// A tile of very many samples → nearly its squared error behind a filter and a mean over frames, in a time that grows with the
// samples instead of with the pairs of samples that meet.
#pragma once

#include "pattern/energy.h"

#include <array>
#include <span>
#include <vector>

namespace nook
{

// The bytes that one evaluation takes for each variant, beside points, weights and their gradient.
std::size_t momentBytes(Domain domain, const TileShares& shares);

// The bytes that making one takes, for a while.
std::size_t formBytes(Domain domain);

class TileMoments
{
public:
	// Shares as of tileSquaredError.
	TileMoments(Domain domain, const TileShares& shares);

	// As tileSquaredError, with its gradient: exact among the samples of one variant, by moments between variants.
	// `threads` never changes the result.
	double operator()(std::span<const glm::dvec3> points, std::span<const double> weights, EnergyGradient& gradient, int threads);

private:
	using Exponents = std::array<int, 3>;

	struct Offset
	{
		int dx;
		int dy;
		std::vector<double> shares; // by frames later, or by the mean's frequency
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
	double m_own;                                     // share of a variant with itself
	bool m_even = true;                               // the same shares forwards and backwards in time
	std::vector<Exponents> m_exponents;               // of the monomials
	std::vector<std::array<std::size_t, 2>> m_ranges; // of the monomials of the same parity
	std::vector<double> m_form;                       // A, monomials × monomials
	std::vector<Offset> m_offsets;
	std::vector<double> m_waves;   // frames × frames, orthonormal
	std::vector<double> m_moments; // variants × monomials, as what follows
	std::vector<double> m_met;
	std::vector<double> m_spare;
};

} // namespace nook
