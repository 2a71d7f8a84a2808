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

// The picture's size and where pixels are in space: size, across_x, across_y, w.x, w.y and rect. Throws Error (unsupported) for a
// projection with a skew.
void fillCamera(ShadeBlock& block, const glm::dmat4& projection, int width_px, int height_px);

// What of a picture decides its block.
struct ShadeFrame
{
	int width_px = 0;
	int height_px = 0;
	glm::dmat4 projection{1.0};
	std::span<const float> depth{};         // with depth_error_m alone
	std::span<const float> depth_error_m{}; // GBuffer::depth_error_m
};

// Throws as fillCamera.
ShadeBlock blockOf(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings);

} // namespace nook
