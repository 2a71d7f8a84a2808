// SPDX-License-Identifier: GPL-3.0-or-later
// The passes before StatVO's own: ranges, tables, and where layers are not needed.
#pragma once

#include "methods/passes.h"

namespace nook
{

// Fills in what StatVO takes from the block. Throws Error (unsupported) for tables that would need more than 4 GiB.
void fillStatVo(ShadeBlock& block, const ShadeSettings& settings);

// Appends the passes and their pictures; `method` then reads them, and has its block.
void addStatVo(ShadePlan& plan, ShadePass& method, const ShadeBlock& block, const StatVoSettings& settings, bool compute);

} // namespace nook
