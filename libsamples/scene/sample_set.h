// SPDX-License-Identifier: GPL-3.0-or-later
// Sample sets for integrals at many points: a spiral pattern, placed at random at each point so that its mean is unbiased, and the
// standard error of one such placement.
#pragma once

#include "core/random.h"

#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

enum class SampleDomain
{
	hemisphere, // directions about +z, cosine-weighted: uniform on the disk below
	ball,       // uniform in the unit ball
	box,        // uniform in [−1, 1]³
};

inline constexpr int kMaxSamples = 16384;

// Golden-angle patterns of pattern/methods.h (box: the Kronecker lattice of the same kind). A placement applies a random rotation
// and puts sample i at the quantile (i + s)/N of the radius with one random s for all, so every sample is uniform over its stratum
// and the strata tile the domain: the mean over placements is exact for any integrand. The box is shifted on the torus instead
// (Cranley and Patterson 1976), with its axes permuted and reversed at random.
class SampleSet
{
public:
	// Requires 1 ≤ count ≤ kMaxSamples.
	SampleSet(SampleDomain domain, int count);

	int count() const
	{
		return m_count;
	}

	// One placement; writes count() numbers each to x, y, z. Uses only `random`.
	void place(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const;

	// Squared standard error of the mean of `values` (count() values in [0, 1] of one placement): see sample_set.cpp.
	double squaredError(std::span<const float> values) const;

private:
	struct Pair
	{
		uint16_t first = 0;
		uint16_t second = 0;
	};
	void placeDirections(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const;
	void placeInBall(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const;
	void placeInBox(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const;
	void findPairs();

	SampleDomain m_domain;
	int m_count;
	std::vector<float> m_x; // hemisphere: cosine of the azimuth; ball: unit direction; box: in [0, 1)
	std::vector<float> m_y;
	std::vector<float> m_z;
	std::vector<float> m_radii; // ball: at the middle of the stratum
	std::vector<Pair> m_pairs;  // neighbours, each pair once
};

} // namespace nook
