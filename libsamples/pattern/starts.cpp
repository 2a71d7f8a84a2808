// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/methods.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/random.h"
#include "core/round.h"
#include "pattern/recipe.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace nook
{
namespace
{

// Maps u in [0, 1)³ to a point distributed by the domain's measure. For a symmetric layout the azimuths cover half a turn, so that
// the points and their opposites together cover the domain.
glm::dvec3 pointOf(const Layout& layout, const glm::dvec3& u)
{
	const SinCos turn = sinCosOf((layout.symmetric() ? kPi : 2.0 * kPi) * u.y);
	const auto ring = [&](double r)
	{
		return glm::dvec3(r * turn.cos, r * turn.sin, 0.0);
	};
	glm::dvec3 p(0.0);
	switch (layout.domain())
	{
	case Domain::disk: // the measure within r is 1 − (1−r²)^{3/2}
		p = ring(std::sqrt(std::max(0.0, 1.0 - powOf(1.0 - u.x, 2.0 / 3.0))));
		break;
	case Domain::hemisphere: p = ring(std::sqrt(u.x)); break;
	case Domain::slice: break; // has no layout
	case Domain::sphere:
	case Domain::ball:
	{
		const double z = 1.0 - 2.0 * u.x;
		p = ring(std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z))));
		p.z = z;
		if (layout.domain() == Domain::ball)
		{
			p *= u.z > 0.0 ? powOf(u.z, 1.0 / 3.0) : 0.0;
		}
		break;
	}
	}
	return placeInDomain(layout.domain(), p);
}

glm::dvec3 randomPoint(const Layout& layout, Random& random)
{
	glm::dvec3 u;
	u.x = random.uniform();
	u.y = random.uniform();
	u.z = random.uniform();
	return pointOf(layout, u);
}

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

std::vector<glm::dvec3> randomPoints(const Layout& layout, Random& random)
{
	return layout.expand(listOf(layout.freeCount(), [&](std::size_t) { return randomPoint(layout, random); }));
}

std::vector<glm::dvec3> poissonPoints(const Layout& layout, Random& random)
{
	const bool planar = isPlanar(layout.domain());
	const std::size_t count = layout.expand(std::vector<glm::dvec3>(layout.freeCount())).size();
	// About the spacing of a dense packing of that many balls in the domain.
	const double share = 1.0 / static_cast<double>(count);
	double distance = layout.domain() == Domain::ball ? 1.8 * powOf(share, 1.0 / 3.0)
					  : planar                        ? 1.9 * std::sqrt(share)
													  : 3.6 * std::sqrt(share);
	const auto flat = [&](glm::dvec3 p)
	{
		p.z = planar ? 0.0 : p.z;
		return p;
	};
	std::vector<glm::dvec3> free;
	std::vector<glm::dvec3> all = layout.expand(free);
	int misses = 0;
	while (free.size() < layout.freeCount())
	{
		const glm::dvec3 p = randomPoint(layout, random);
		bool clear = !layout.symmetric() || 2.0 * glm::length(p) >= distance;
		for (std::size_t i = 0; clear && i < all.size(); ++i)
		{
			clear = glm::distance(flat(p), flat(all[i])) >= distance;
		}
		if (!clear)
		{
			misses += 1;
			if (misses == 100)
			{
				distance *= 0.95;
				misses = 0;
			}
			continue;
		}
		free.push_back(p);
		all.push_back(p);
		if (layout.symmetric())
		{
			all.push_back(-p);
		}
	}
	return layout.expand(free);
}

std::vector<glm::dvec3> haltonPoints(const Layout& layout)
{
	std::vector<glm::dvec3> free;
	for (unsigned k = 1; k <= layout.freeCount(); ++k)
	{
		free.push_back(pointOf(layout, {radicalInverse(k, 2), radicalInverse(k, 3), radicalInverse(k, 5)}));
	}
	return layout.expand(free);
}

std::vector<glm::dvec3> vogelPoints(const Layout& layout)
{
	const auto count = static_cast<double>(layout.freeCount());
	const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
	std::vector<glm::dvec3> free;
	for (std::size_t k = 0; k < layout.freeCount(); ++k)
	{
		const auto index = static_cast<double>(k);
		const double radial = fraction((index + 0.5) * 0.5 * (1.0 + golden)); // only the ball uses it
		// Vogel's spiral is uniform over the disk, r² = area; the weights account for the lines' measure.
		const double area = (index + 0.5) / count;
		const double share = layout.domain() == Domain::disk ? 1.0 - (1.0 - area) * std::sqrt(1.0 - area) : area;
		free.push_back(pointOf(layout, {share, fraction(index * golden), radial}));
	}
	return layout.expand(free);
}

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
