// SPDX-License-Identifier: GPL-3.0-or-later
// Recipe → pattern.
#pragma once

#include "core/progress.h"
#include "pattern/recipe.h"

namespace nook
{

// Makes the pattern: points and weights rounded to 32-bit floats (held in doubles), so that what is measured is what is emitted.
// Deterministic: the recipe alone decides every bit. Throws Error (usage) where checkRecipe does.
Pattern generatePattern(const Recipe& recipe, const RunSettings& run = {});

} // namespace nook
