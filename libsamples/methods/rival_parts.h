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

void fillCrytek(ShadeBlock& block, const ShadeSettings& settings);
void fillHorizon(ShadeBlock& block, const ShadeSettings& settings);
void fillSpiral(ShadeBlock& block, const ShadeSettings& settings);

} // namespace nook
