// SPDX-License-Identifier: GPL-3.0-or-later
// Tiles and their errors, for the tests of tiles.
#pragma once

#include "testing.h"

#include "core/random.h"
#include "pattern/energy.h"
#include "pattern/pattern.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"

namespace nook
{

inline Recipe recipeOf(Domain domain, int count)
{
	Recipe recipe;
	recipe.domain = domain;
	recipe.count = count;
	return recipe;
}

inline double planeErrorOf(const Pattern& p)
{
	return std::sqrt(squaredError(p.domain, Ensemble::plane, Part::whole, p.points, p.weights));
}

// A tile of random, unoptimised points.
inline PatternTile scattered(Domain domain, int size, const TileTime& time, std::size_t count)
{
	PatternTile tile;
	tile.domain = domain;
	tile.size = size;
	tile.frames = time.frames;
	tile.moves = time.moves;
	unsigned index = 1;
	for (int v = 0; v < size * size * layersOf(tile); ++v)
	{
		Pattern variant;
		variant.domain = domain;
		for (std::size_t i = 0; i < count; ++i, ++index)
		{
			variant.points.emplace_back(radicalInverse(index, 2) - 0.5, radicalInverse(index, 3) - 0.5,
										domain == Domain::ball ? radicalInverse(index, 5) - 0.5 : 0.0);
			variant.weights.push_back((1.0 + radicalInverse(index, 7)));
		}
		const double sum = std::accumulate(variant.weights.begin(), variant.weights.end(), 0.0);
		for (double& w : variant.weights)
		{
			w /= sum;
		}
		tile.variants.push_back(variant);
	}
	return tile;
}

inline double errorOf(const PatternTile& tile, const TileShares& shares, EnergyGradient* gradient = nullptr)
{
	std::vector<glm::dvec3> points;
	std::vector<double> weights;
	for (const Pattern& variant : tile.variants)
	{
		points.insert(points.end(), variant.points.begin(), variant.points.end());
		weights.insert(weights.end(), variant.weights.begin(), variant.weights.end());
	}
	return tileSquaredError(tile.domain, shares, points, weights, gradient);
}

} // namespace nook
