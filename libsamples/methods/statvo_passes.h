// SPDX-License-Identifier: GPL-3.0-or-later
// The passes before StatVO's own: ranges, tables, and where layers are not needed.
#pragma once

#include "methods/passes.h"

namespace nook
{

// Fills in what StatVO takes from the block. Throws Error (unsupported) for tables that would need more than 4 GiB.
void fillStatVo(ShadeBlock& block, const ShadeSettings& settings);

// Appends the passes and their pictures; `method` then reads them, and has its block.
void addStatVo(ShadePlan& plan, ShadePass& method, const ShadeBlock& block, const ShadeSettings& settings, bool compute);

// The same for people who draw a module's passes: which functions into which pictures, a line each.
std::string statVoPassesText(const ShadeSettings& settings);

// One for all pixels, which no kernel reads: StatVO looks at all pixels instead.
ShadeSamples noSamples(const ShadeSettings& settings);

// "4 adaptive layers, full tables": for notes and summaries.
std::string layersText(const ShadeSettings& settings);

void setLayers(ShadeSettings& settings, int count);
int setBestLayers(ShadeSettings& settings);

} // namespace nook
