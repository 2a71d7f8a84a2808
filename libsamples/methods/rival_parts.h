// SPDX-License-Identifier: GPL-3.0-or-later
// What the table of methods takes of those to compare with (rivals.h).
#pragma once

#include "methods/block.h"

namespace nook
{

inline constexpr int kSpiralVariants = 16; // turns of nookSaoTurn

ShadeSamples horizonSamples(const ShadeSettings& settings);
void setDirections(ShadeSettings& settings, int count);
int setBestHorizon(ShadeSettings& settings);

ShadeSamples spiralSamples(const ShadeSettings& settings);
void setSpiral(ShadeSettings& settings, int count);
int setBestSpiral(ShadeSettings& settings);
int spiralLevels(const ShadeSettings& settings);

ShadeSamples gtaoSamples(const ShadeSettings& settings);
void setGtaoSlices(ShadeSettings& settings, int count);
int setBestGtao(ShadeSettings& settings);

ShadeSamples bitmaskSamples(const ShadeSettings& settings);
void setBitmaskSlices(ShadeSettings& settings, int count);
int setBestBitmask(ShadeSettings& settings);

void fillCrytek(ShadeBlock& block, const ShadeSettings& settings);
void fillHorizon(ShadeBlock& block, const ShadeSettings& settings);
void fillSpiral(ShadeBlock& block, const ShadeSettings& settings);
void fillGtao(ShadeBlock& block, const ShadeSettings& settings);
void fillBitmask(ShadeBlock& block, const ShadeSettings& settings);

} // namespace nook
