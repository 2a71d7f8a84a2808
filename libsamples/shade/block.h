// SPDX-License-Identifier: GPL-3.0-or-later
// What both ways of running the kernels hand to them.
#pragma once

#include "shade/kernels.h"
#include "shade/shade.h"

#include <vector>

namespace nook
{

constexpr int kMomentLevels = 6; // texels of up to 64 pixels' side

// The picture's size and where pixels are in space: size, across_x, across_y, w.x, w.y and rect. Throws Error (unsupported) for a
// projection with a skew.
void fillCamera(ShadeBlock& block, const glm::dmat4& projection, int width_px, int height_px);

// Throws as fillCamera.
ShadeBlock blockOf(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings);

// The part of the block that methods to compare with have for themselves.
void fillRivals(ShadeBlock& block, const ShadeSettings& settings);

// Depths with NOOK_SKY for infinity.
std::vector<float> finiteDepths(const GBuffer& gbuffer);

} // namespace nook
