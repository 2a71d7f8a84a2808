// SPDX-License-Identifier: GPL-3.0-or-later
// What both ways of running the kernels hand to them.
#pragma once

#include "methods/kernels.h"
#include "methods/settings.h"

#include <glm/mat4x4.hpp>

#include <span>

namespace nook
{

constexpr int kMomentLevels = 6; // texels of up to 64 pixels' side

// The same projection, scaled by a power of two so that w is about 1 a metre or 1: 32 bits hold it and its square, however the
// matrix was scaled.
glm::dmat4 unitProjection(const glm::dmat4& projection);

// The picture's size and where pixels are in space: size, pixel_size, across_x, across_y, aside, w_slope, w_start, first and last.
// Throws Error (unsupported) for a projection with a skew.
void fillCamera(ShadeBlock& block, const glm::dmat4& projection, int width_px, int height_px);

// What of a picture decides its block.
struct ShadeFrame
{
	int width_px = 0;
	int height_px = 0;
	glm::dmat4 projection{1.0};
	std::span<const float> depth{};         // GBuffer::depth; empty: not known yet
	std::span<const float> depth_error_m{}; // GBuffer::depth_error_m
};

// Requires the block's camera. Throws Error (invalid_input), naming the pixel, where a depth, or half the picture there, is no
// length whose square the kernels can hold; so no kernel meets an infinity or a radius of 0.
void checkLengths(const ShadeFrame& frame, const ShadeBlock& block);

// Throws as fillCamera and checkLengths.
ShadeBlock blockOf(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings);

} // namespace nook
