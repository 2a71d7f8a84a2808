// SPDX-License-Identifier: GPL-3.0-or-later
// Variants that are transformed copies of the base: descent on angles and scales, even rotations, or random reflections.
#include "core/math.h"
#include "core/parallel.h"
#include "core/round.h"
#include "pattern/lbfgs.h"
#include "pattern/start_progress.h"
#include "pattern/starts.h"
#include "pattern/tile_parts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace nook
{
namespace
{

Points transformed(Domain domain, std::span<const glm::dvec3> points, const TileTransform& t)
{
	Points result;
	for (const glm::dvec3& p : points)
	{
		if (domain == Domain::ball)
		{
			result.push_back(p - 2.0 * glm::dot(t.axis, p) * t.axis);
			continue;
		}
		const double y = t.handedness * p.y;
		glm::dvec3 q(t.scale * (t.cos * p.x - t.sin * y), t.scale * (t.sin * p.x + t.cos * y), 0.0);
		if (domain == Domain::hemisphere)
		{
			q.z = std::sqrt(std::max(0.0, 1.0 - glm::dot(q, q)));
		}
		result.push_back(q);
	}
	return result;
}

double greatestRadius(std::span<const glm::dvec3> points)
{
	double greatest = 0.0;
	for (const glm::dvec3& p : points)
	{
		greatest = std::max(greatest, std::sqrt(p.x * p.x + p.y * p.y));
	}
	return greatest;
}

std::vector<TileTransform> evenTransforms(std::size_t variants)
{
	std::vector<TileTransform> result(variants);
	for (std::size_t v = 0; v < variants; ++v)
	{
		const SinCos turn = sinCosOf(2.0 * kPi * static_cast<double>(v) / static_cast<double>(variants));
		result[v].cos = v == 0 ? 1.0 : turn.cos;
		result[v].sin = v == 0 ? 0.0 : turn.sin;
	}
	return result;
}

// VO §4.5: reflections about random directions, in the plane or in space.
std::vector<TileTransform> randomReflections(Domain domain, std::size_t variants, uint32_t seed)
{
	Random random(seed, 0);
	std::vector<TileTransform> result(variants);
	for (TileTransform& t : result)
	{
		const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
		if (domain == Domain::ball)
		{
			const double z = 1.0 - 2.0 * random.uniform();
			const double r = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
			t.axis = {r * turn.cos, r * turn.sin, z};
		}
		t.cos = turn.cos;
		t.sin = turn.sin;
		t.handedness = -1.0;
	}
	return result;
}

// The tile's error as a function of the variants' angles and scales.
class TransformsError
{
public:
	TransformsError(const Pattern& base, const TileRecipe& recipe)
		: m_base(base), m_variants(static_cast<std::size_t>(recipe.size * recipe.size)), m_lambda(lambdaOf(recipe)),
		  m_largest(std::min(1.5, 0.999 / greatestRadius(base.points)))
	{
	}

	std::vector<double> start(Random& random) const
	{
		std::vector<double> x;
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			x.push_back(2.0 * kPi * random.uniform());
			x.push_back(std::min(m_largest, 0.8 + 0.4 * random.uniform()));
		}
		return x;
	}

	// Every second variant is a reflection.
	static TileTransform transformOf(std::span<const double> x, std::size_t v)
	{
		const SinCos turn = sinCosOf(x[2 * v]);
		return TileTransform{turn.cos, turn.sin, x[2 * v + 1], v % 2 == 0 ? 1.0 : -1.0, {}};
	}

	double operator()(std::span<const double> x, std::span<double> gradient, EnergyGradient& by_all) const
	{
		VariantUnion all;
		for (std::size_t v = 0; v < m_variants; ++v)
		{
			if (!(x[2 * v + 1] > 0.5 && x[2 * v + 1] <= m_largest && std::fabs(x[2 * v]) < 1000.0))
			{
				return std::numeric_limits<double>::infinity();
			}
			const Points points = transformed(m_base.domain, m_base.points, transformOf(x, v));
			all.points.insert(all.points.end(), points.begin(), points.end());
			all.weights.insert(all.weights.end(), m_base.weights.begin(), m_base.weights.end());
		}
		const double value = tileError(m_base.domain, all, m_variants, m_lambda, by_all, 1);
		std::fill(gradient.begin(), gradient.end(), 0.0);
		for (std::size_t i = 0; i < all.points.size(); ++i)
		{
			const std::size_t v = i / m_base.count();
			const glm::dvec3& p = all.points[i];
			glm::dvec3 g = by_all.points[i];
			if (m_base.domain == Domain::hemisphere)
			{
				g -= g.z / p.z * p;
			}
			gradient[2 * v] += g.y * p.x - g.x * p.y;
			gradient[2 * v + 1] += (g.x * p.x + g.y * p.y) / x[2 * v + 1];
		}
		return value;
	}

private:
	const Pattern& m_base;
	std::size_t m_variants;
	double m_lambda;
	double m_largest; // scale
};

// Angles and scales by descent.
std::vector<TileTransform> descendedTransforms(const Pattern& base, const TileRecipe& recipe, const RunSettings& run)
{
	const auto variants = static_cast<std::size_t>(recipe.size * recipe.size);
	const auto starts = static_cast<std::size_t>(recipe.starts != 0 ? recipe.starts : 4 * kDefaultTileStarts);
	const TransformsError error(base, recipe);
	std::vector<std::vector<double>> ends(starts);
	std::vector<double> values(starts);
	LbfgsSettings settings;
	settings.relative_decrease = 1e-5;
	ProgressCounter progress(run.progress, "starts", starts * stepsOf(settings));
	parallelFor(starts, run.threads,
				[&](std::size_t k)
				{
					Random random(recipe.seed, k);
					ends[k] = error.start(random);
					EnergyGradient by_all;
					const Objective objective = [&](std::span<const double> x, std::span<double> gradient)
					{
						return error(x, gradient, by_all);
					};
					StartProgress start_progress(progress, stepsOf(settings));
					LbfgsSettings watched = settings;
					watched.seen = [&start_progress](std::span<const double>)
					{
						start_progress.step();
					};
					values[k] = minimise(objective, ends[k], watched);
				});
	const std::size_t best = static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin());
	std::vector<TileTransform> result;
	for (std::size_t v = 0; v < variants; ++v)
	{
		result.push_back(TransformsError::transformOf(ends[best], v));
	}
	return result;
}

PatternTile copiesOf(const Pattern& base, std::vector<TileTransform> transforms)
{
	PatternTile tile;
	for (TileTransform& t : transforms)
	{
		t.cos = roundToFloat(t.cos);
		t.sin = roundToFloat(t.sin);
		t.scale = roundToFloat(t.scale);
		t.axis = glm::dvec3(roundToFloat(t.axis.x), roundToFloat(t.axis.y), roundToFloat(t.axis.z));
		Pattern variant;
		variant.domain = base.domain;
		variant.points = transformed(base.domain, base.points, t);
		variant.weights = base.weights;
		tile.variants.push_back(variant);
	}
	tile.transforms = std::move(transforms);
	return tile;
}

} // namespace

PatternTile transformedTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run)
{
	const auto variants = static_cast<std::size_t>(recipe.size * recipe.size);
	switch (recipe.kind)
	{
	case TileKind::even: return copiesOf(base, evenTransforms(variants));
	case TileKind::random: return copiesOf(base, randomReflections(base.domain, variants, recipe.seed));
	case TileKind::transform:
	case TileKind::points: break;
	}
	return copiesOf(base, descendedTransforms(base, recipe, run));
}

} // namespace nook
