// SPDX-License-Identifier: GPL-3.0-or-later
// One pattern turned about the view axis by another angle in each pixel and frame, as engines do it: the rivals of tiles.
#pragma once

#include "pattern/energy.h"
#include "pattern/pattern.h"

#include <cstdint>
#include <vector>

namespace nook
{

// frames · size² angles in turns, 0 ≤ t < 1: frame after frame, row by row, as the variants of a PatternTile.
struct Rotations
{
	int size = 1;
	int frames = 1;
	std::vector<double> turns;
};

enum class RotationNoise
{
	white,   // hashed
	sixteen, // sixteen even angles in 4 × 4 pixels (size 4), in the order of ordered dither; the next frame a golden angle further
	gradient, // interleaved gradient noise (Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, 2014),
			  // moved by 5.588238 pixels a frame
	r2, // frac(a₁ x + a₂ y), a = (1/p, 1/p²), p³ = p + 1 (Roberts, The Unreasonable Effectiveness of Quasirandom Sequences,
		// 2018); the next frame a golden ratio further
};

Rotations rotationsOf(RotationNoise noise, int size, int frames, uint64_t seed = 1);

// What turning costs behind a filter: the squared plane error of two turned patterns' mean, by the angle between them, decides all.
class RotationError
{
public:
	explicit RotationError(const Pattern& pattern);

	// rms error behind the filter and the frames that the shares stand for, as errorBehind of the tile with these variants.
	double of(const Rotations& rotations, const TileShares& shares) const;

	// Even angles in the order whose error is least: swaps of two at a time that lower it, from a random order, `sweeps` tries an
	// angle. In space and time at once, as Wolfe et al., Spatiotemporal Blue Noise Masks (EGSR 2022), and for a filter, as Donnelly
	// et al., Filter-Adapted Spatiotemporal Sampling (I3D 2024), whose loss for one number a pixel is replaced by the pattern's
	// own.
	Rotations optimised(int size, int frames, const TileShares& shares, int sweeps, uint64_t seed = 1) const;

private:
	double pairOf(double turn) const;

	std::vector<double> m_pairs; // by the angle in turns, kAngles of them
};

// The pattern turned about the z axis.
Pattern turned(const Pattern& pattern, double turns);

} // namespace nook
