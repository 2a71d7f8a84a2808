// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/math.h"
#include "core/random.h"
#include "core/round.h"
#include "pattern/methods.h"
#include "pattern/recipe.h"

#include "core/lists.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace nook
{
namespace
{

constexpr double kRim = 1.0 - 1e-6;     // greatest radius of a placed point
constexpr double kLimit = 1.0 - 0.5e-6; // greatest radius for an optimiser; a placed point stays below it after rounding

// Maps u in [0, 1)³ to a point distributed by the domain's measure. For a symmetric layout the azimuths cover half a turn, so that
// the points and their opposites together cover the domain.
glm::dvec3 pointOf(const Layout& layout, const glm::dvec3& u)
{
	const SinCos turn = sinCosOf((layout.symmetric ? kPi : 2.0 * kPi) * u.y);
	const auto ring = [&](double r)
	{
		return glm::dvec3(r * turn.cos, r * turn.sin, 0.0);
	};
	glm::dvec3 p(0.0);
	switch (layout.domain)
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
		if (layout.domain == Domain::ball)
		{
			p *= u.z > 0.0 ? powOf(u.z, 1.0 / 3.0) : 0.0;
		}
		break;
	}
	}
	return placeInDomain(layout.domain, p);
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

glm::dvec3 placeInDomain(Domain domain, const glm::dvec3& p)
{
	if (domain == Domain::sphere)
	{
		return glm::normalize(p);
	}
	glm::dvec3 q = p;
	if (domain != Domain::ball)
	{
		q.z = 0.0;
	}
	const double r = glm::length(q);
	if (r > kRim)
	{
		q *= kRim / r;
	}
	if (domain == Domain::hemisphere)
	{
		q.z = std::sqrt(1.0 - glm::dot(q, q));
	}
	return q;
}

Layout::Layout(const Recipe& recipe)
	: domain(recipe.domain), has_centre(recipe.centre || (recipe.symmetric && recipe.count % 2 != 0)), symmetric(recipe.symmetric),
	  free_count((static_cast<std::size_t>(recipe.count) - (has_centre ? 1U : 0U)) / (symmetric ? 2U : 1U))
{
}

std::vector<glm::dvec3> Layout::expand(std::span<const glm::dvec3> free) const
{
	std::vector<glm::dvec3> all;
	if (has_centre)
	{
		all.emplace_back(0.0);
	}
	for (const glm::dvec3& p : free)
	{
		all.push_back(p);
		if (symmetric)
		{
			all.push_back(-p);
		}
	}
	return all;
}

std::vector<glm::dvec3> Layout::freePoints(std::span<const glm::dvec3> all) const
{
	return listOf(free_count, [&](std::size_t k) { return all[firstFree(k)]; });
}

std::vector<double> Layout::variables(std::span<const glm::dvec3> all) const
{
	std::vector<double> result;
	for (std::size_t k = 0; k < free_count; ++k)
	{
		const glm::dvec3& p = all[firstFree(k)];
		for (std::size_t a = 0; a < dimension(); ++a)
		{
			result.push_back(p[static_cast<int>(a)]);
		}
	}
	return result;
}

bool Layout::points(std::span<const double> variables, std::vector<glm::dvec3>& all) const
{
	std::vector<glm::dvec3> free(free_count);
	for (std::size_t k = 0; k < free_count; ++k)
	{
		glm::dvec3 p(0.0);
		for (std::size_t a = 0; a < dimension(); ++a)
		{
			p[static_cast<int>(a)] = variables[k * dimension() + a];
		}
		const double r2 = glm::dot(p, p);
		if (domain == Domain::sphere)
		{
			if (!(r2 > 1e-6 && r2 < 1e6))
			{
				return false;
			}
			p /= std::sqrt(r2);
		}
		else if (!(r2 <= kLimit * kLimit))
		{
			return false;
		}
		if (domain == Domain::hemisphere)
		{
			p.z = std::sqrt(1.0 - r2);
		}
		free[k] = p;
	}
	all = expand(free);
	return true;
}

void Layout::pullBack(std::span<const double> variables, std::span<const glm::dvec3> all,
					  std::span<const glm::dvec3> point_gradient, std::span<double> gradient) const
{
	for (std::size_t k = 0; k < free_count; ++k)
	{
		const std::size_t i = firstFree(k);
		const glm::dvec3& p = all[i];
		glm::dvec3 g = point_gradient[i];
		if (symmetric)
		{
			g -= point_gradient[i + 1];
		}
		if (domain == Domain::sphere)
		{
			glm::dvec3 u(variables[3 * k], variables[3 * k + 1], variables[3 * k + 2]);
			g = (g - glm::dot(g, p) * p) / glm::length(u);
		}
		else if (domain == Domain::hemisphere)
		{
			g -= (g.z / p.z) * p; // ∂z/∂x = −x/z
		}
		for (std::size_t a = 0; a < dimension(); ++a)
		{
			gradient[k * dimension() + a] = g[static_cast<int>(a)];
		}
	}
}

void Layout::symmetrise(std::span<double> values) const
{
	if (!symmetric)
	{
		return;
	}
	for (std::size_t k = 0; k < free_count; ++k)
	{
		const std::size_t i = firstFree(k);
		values[i] = 0.5 * (values[i] + values[i + 1]);
		values[i + 1] = values[i];
	}
}

std::vector<glm::dvec3> randomPoints(const Layout& layout, Random& random)
{
	return layout.expand(listOf(layout.free_count, [&](std::size_t) { return randomPoint(layout, random); }));
}

std::vector<glm::dvec3> poissonPoints(const Layout& layout, Random& random)
{
	const bool planar = isPlanar(layout.domain);
	const std::size_t count = layout.expand(std::vector<glm::dvec3>(layout.free_count)).size();
	// About the spacing of a dense packing of that many balls in the domain.
	const double share = 1.0 / static_cast<double>(count);
	double distance = layout.domain == Domain::ball ? 1.8 * powOf(share, 1.0 / 3.0)
					  : planar                      ? 1.9 * std::sqrt(share)
													: 3.6 * std::sqrt(share);
	const auto flat = [&](glm::dvec3 p)
	{
		p.z = planar ? 0.0 : p.z;
		return p;
	};
	std::vector<glm::dvec3> free;
	std::vector<glm::dvec3> all = layout.expand(free);
	int misses = 0;
	while (free.size() < layout.free_count)
	{
		const glm::dvec3 p = randomPoint(layout, random);
		bool clear = !layout.symmetric || 2.0 * glm::length(p) >= distance;
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
		if (layout.symmetric)
		{
			all.push_back(-p);
		}
	}
	return layout.expand(free);
}

std::vector<glm::dvec3> haltonPoints(const Layout& layout)
{
	const auto freePoint = [&layout](std::size_t i)
	{
		const auto k = static_cast<unsigned>(i + 1);
		return pointOf(layout, {radicalInverse(k, 2), radicalInverse(k, 3), radicalInverse(k, 5)});
	};
	return layout.expand(listOf(layout.free_count, freePoint));
}

std::vector<glm::dvec3> vogelPoints(const Layout& layout)
{
	const auto count = static_cast<double>(layout.free_count);
	const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
	const auto freePoint = [&](std::size_t k)
	{
		const auto index = static_cast<double>(k);
		const double radial = fraction((index + 0.5) * 0.5 * (1.0 + golden)); // only the ball uses it
		// Vogel's spiral is uniform over the disk, r² = area; the weights account for the lines' measure.
		const double area = (index + 0.5) / count;
		const double share = layout.domain == Domain::disk ? 1.0 - (1.0 - area) * std::sqrt(1.0 - area) : area;
		return pointOf(layout, {share, fraction(index * golden), radial});
	};
	return layout.expand(listOf(layout.free_count, freePoint));
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
