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

// How much of one of its 32 sectors a surface covers before a bit mask counts that as covered.
enum class BitmaskHit
{
	half,    // the paper
	whole,   // all of it
	touched, // 1/1000: the authors' published sample
};

struct RivalSettings
{
	double range = 2.7;              // crytek: what is that many radii in front counts as 1/2; > 0
	int directions = 6;              // horizon-based: 1 to 64
	int steps = 6;                   // horizon-based: of each direction, 1 to 64
	double angle_bias_deg = 30.0;    // horizon-based: elevation over the tangent plane that counts for nothing, [0, 90)
	int spiral_samples = 11;         // scalable: 1 to 256
	int spiral_turns = 7;            // scalable: 1 to 256
	double intensity = 1.0;          // scalable: factor of the obscurance, > 0
	double bias = 0.012;             // scalable: height over the tangent plane that counts for nothing, in radii, ≥ 0
	double epsilon = 0.01;           // scalable: keeps the quotient finite, in squares of the radius, > 0
	int levels = 5;                  // scalable: coarser depths beside the picture, 0 to 8
	int gtao_slices = 3;             // GTAO: planes through the view ray, 1 to 16
	int gtao_steps = 6;              // GTAO: depths on either side of each, 1 to 32
	double gtao_falloff = 0.385;     // GTAO: radii from which horizons fade to the tangent, [0, 1)
	double gtao_thickness = 0.01;    // GTAO: share of the way down that a step below the horizon brings it, [0, 1]
	int bitmask_slices = 3;          // bit masks: planes through the view ray, 1 to 16
	int bitmask_steps = 6;           // bit masks: depths on either side of each, 1 to 32
	double bitmask_thickness = 0.25; // bit masks: of surfaces, in radii, > 0
	BitmaskHit bitmask_hit = BitmaskHit::half;
};

// Crytek's points: the corners of a cube in turn, each further out than the one before (ShaderX7: times 1 + 2.4 / count), the last
// at distance 1; equal weights. Requires a multiple of 8.
Pattern crytekPoints(int count);

// Of a window of 4 × 4 pixels, one after the other: directions × (cos, sin, jitter, weight), turned by sixteen even parts of the
// angle between directions and jittered by sixteen even parts of a step, both in a random order.
std::vector<glm::vec4> horizonDirections(int directions, std::uint32_t seed = 1);

// Of a window of 4 × 4 pixels, one after the other: slices × (cos, sin, jitter, weight), turned by sixteen even parts of the angle
// between slices and jittered by four even parts of a step, in the order of GTAO.
std::vector<glm::vec4> sliceDirections(int slices);

// (x, y, distance, weight): sample i of n at distance (i + 1/2) / n, `turns` turns over all of them.
std::vector<glm::vec4> spiral(int count, int turns);

} // namespace nook
