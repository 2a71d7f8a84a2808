// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/recipe.h"

#include "core/parallel.h"
#include "core/round.h"
#include "pattern/methods.h"
#include "pattern/starts.h"

#include <cmath>

namespace nook
{
namespace
{

Points makePoints(const Recipe& recipe, const Layout& layout, const RunSettings& run, const Watch& watch)
{
	Random random(recipe.seed, 0);
	switch (recipe.method)
	{
	case Method::refine: return refine(recipe, layout, run, watch);
	case Method::random: return randomPoints(layout, random);
	case Method::poisson: return poissonPoints(layout, random);
	case Method::halton: return haltonPoints(layout);
	case Method::vogel: return vogelPoints(layout);
	case Method::electro:
	case Method::equal:
	case Method::lloyd: break;
	}
	return relaxStarts(recipe, layout, run, watch);
}

} // namespace

Pattern generatePattern(const Recipe& recipe, const RunSettings& run, const Watch& watch)
{
	checkRecipe(recipe);
	const Layout layout(recipe);
	Pattern pattern;
	pattern.domain = recipe.domain;
	pattern.points = reorder(recipe.order, layout, makePoints(recipe, layout, run, watch));
	for (glm::dvec3& p : pattern.points)
	{
		p = glm::dvec3(roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z));
	}
	// Weights and powers must match the rounded points that are emitted.
	if (recipe.method == Method::equal)
	{
		pattern.powers = equalisingPowers(recipe.domain, pattern.points);
		layout.symmetrise(pattern.powers);
	}
	pattern.weights = weightsFor(recipe, layout, pattern.points);
	for (double& w : pattern.weights)
	{
		w = roundToFloat(w);
	}
	return pattern;
}

} // namespace nook
