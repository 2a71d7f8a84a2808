// SPDX-License-Identifier: GPL-3.0-or-later
// Samples and settings of methods that are quick to make.
#pragma once

#include "methods/block.h"
#include "pattern/recipe.h"

namespace nook::test
{

inline ShadeSamples samplesFor(ShadeMethod method, int count)
{
	Recipe recipe;
	recipe.domain = domainOf(method);
	recipe.count = count;
	recipe.starts = 2;
	return samplesOf(method, {generatePattern(recipe)});
}

inline ShadeSettings statVo(int layers, int cell_px = 1, bool quadrants = false)
{
	ShadeSettings settings;
	settings.method = ShadeMethod::statvo;
	settings.statvo.layers = layers;
	settings.statvo.cell_px = cell_px;
	settings.statvo.quadrants = quadrants;
	return settings;
}

} // namespace nook::test
