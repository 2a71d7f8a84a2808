// SPDX-License-Identifier: GPL-3.0-or-later
// Samples and settings of methods that are quick to make.
#pragma once

#include "methods/block.h"
#include "pattern/recipe.h"
#include "shade/shade.h"

namespace nook::test
{

inline ShadeSamples samplesFor(ShadeMethod method, int count)
{
	Recipe recipe{.domain = domainOf(method), .count = count, .starts = 2};
	return samplesOf(method, {generatePattern(recipe)});
}

inline std::vector<float> visibilityOf(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings)
{
	return shadeOnCpu(gbuffer, samples, settings, {2, {}}).visibility;
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
