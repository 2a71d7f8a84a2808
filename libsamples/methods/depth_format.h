// SPDX-License-Identifier: GPL-3.0-or-later
// What holds an engine's depths and normals → the parts of the uniform block that turn them into metres and say how exact they are
// (depth.glsl).
#pragma once

#include "core/clip_range.h"

#include <glm/mat4x4.hpp>

#include <span>

namespace nook
{

struct ShadeBlock;

struct DepthFormat
{
	bool device = false;                          // what a depth buffer holds, 0 to 1; else metres along the view direction
	ClipRange clip = ClipRange::minus_one_to_one; // device: what 0 to 1 stand for
	int bits = 32;                                // device: 16 and 24 whole numbers, 32 floats; metres: 16 and 32 floats
};

// Fills depth, far_end, depth_step and depth_share; requires w_slope and w_start. Throws Error (invalid_input) where device depth
// is asked of a projection whose z is singular, and (unsupported) where its z depends on x or y.
void fillDepth(ShadeBlock& block, const glm::dmat4& projection, const DepthFormat& format);

// depth_step and depth_share so that no depth is off by more than nookDepthError says: of linear depths with their errors, the
// lesser of what a depth buffer of the projection and what floats would have. Requires w_slope and w_start.
void fillMeasuredError(ShadeBlock& block, std::span<const float> depths, std::span<const float> depth_error_m);

// Sine of the angle by which rounding may turn a normal: of three components of 8 to 16 bits; 0 for 32. Whole steps: 2 / (2ᵇ − 1),
// for components from 0 to 1 and, within a hundredth, from −1 to 1.
double normalError(int bits);

} // namespace nook
