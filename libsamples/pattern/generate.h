// SPDX-License-Identifier: GPL-3.0-or-later
// Recipe → pattern.
#pragma once

#include "core/progress.h"
#include "pattern/recipe.h"

#include <cstddef>
#include <functional>
#include <span>

namespace nook
{

// Called with the number of a start and where its points are while they move; several starts move at once where there are several
// threads. Never changes the result. May be empty.
using Watch = std::function<void(std::size_t start, std::span<const glm::dvec3> points)>;

// Makes the pattern: points and weights rounded to 32-bit floats (held in doubles), so that what is measured is what is emitted.
// Deterministic: the recipe alone decides every bit. Throws Error (usage) where checkRecipe does.
Pattern generatePattern(const Recipe& recipe, const RunSettings& run = {}, const Watch& watch = {});

} // namespace nook
