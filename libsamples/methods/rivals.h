// SPDX-License-Identifier: GPL-3.0-or-later
// The methods that papers compare with, for `nook shade` alone: their settings, and the samples that are theirs.
// Kernels and sources: rivals_*.glsl. Defaults are the publications', at a radius of 1 m.
#pragma once

#include "pattern/pattern.h"

#include <glm/vec4.hpp>

#include <cstdint>
#include <vector>

namespace nook
{

struct RivalSettings
{
	double range = 2.7;           // crytek: what is that many radii in front counts as 1/2; > 0
	int directions = 6;           // horizon-based: 1 to 64
	int steps = 6;                // horizon-based: of each direction, 1 to 64
	double angle_bias_deg = 30.0; // horizon-based: elevation over the tangent plane that counts for nothing, [0, 90)
	int spiral_samples = 11;      // scalable: 1 to 256
	int spiral_turns = 7;         // scalable: 1 to 256
	double intensity = 1.0;       // scalable: factor of the obscurance, > 0
	double bias = 0.012;          // scalable: height over the tangent plane that counts for nothing, in radii, ≥ 0
	double epsilon = 0.01;        // scalable: keeps the quotient finite, in squares of the radius, > 0
	int levels = 5;               // scalable: coarser depths beside the picture, 0 to 8
};

// Crytek's points: the corners of a cube in turn, each further out than the one before (ShaderX7: times 1 + 2.4 / count), the last
// at distance 1; equal weights. Requires a multiple of 8.
Pattern crytekPoints(int count);

// Of a window of 4 × 4 pixels, one after the other: directions × (cos, sin, jitter, weight), turned by sixteen even parts of the
// angle between directions and jittered by sixteen even parts of a step, both in a random order.
std::vector<glm::vec4> horizonDirections(int directions, std::uint32_t seed = 1);

// (x, y, distance, weight): sample i of n at distance (i + 1/2) / n, `turns` turns over all of them.
std::vector<glm::vec4> spiral(int count, int turns);

} // namespace nook
