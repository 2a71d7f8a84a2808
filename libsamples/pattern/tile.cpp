// SPDX-License-Identifier: GPL-3.0-or-later
// The mean over the window of K variants' estimates is the estimate of all their points together with weights / K. So the window's
// squared error is the energy distance of the union, and a tile is made by one descent on window² + λ · mean of the variants'
// plane².
#include "pattern/tile.h"

#include "core/error.h"
#include "core/number.h"
#include "core/round.h"
#include "pattern/tile_parts.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace nook
{

template <> std::span<const std::string_view> namesOf<TileKind>()
{
	static constexpr std::array<std::string_view, 4> names{"points", "transform", "even", "random"};
	return names;
}

namespace
{

constexpr double kPointsLambda = 0.05;
constexpr double kTransformLambda = 0.15; // below, the scales spread so far that single variants suffer

} // namespace

double lambdaOf(const TileRecipe& recipe)
{
	return recipe.lambda > 0.0 ? recipe.lambda : recipe.kind == TileKind::points ? kPointsLambda : kTransformLambda;
}

double tileError(Domain domain, const VariantUnion& all, std::size_t variants, double lambda, EnergyGradient& gradient, int threads)
{
	const auto k = static_cast<double>(variants);
	const std::size_t count = all.points.size() / variants;
	std::vector<double> shares(all.weights);
	for (double& w : shares)
	{
		w /= k;
	}
	double value = squaredError(domain, Ensemble::plane, Part::whole, all.points, shares, &gradient, threads);
	for (double& g : gradient.weights)
	{
		g /= k;
	}
	EnergyGradient own;
	for (std::size_t v = 0; v < variants; ++v)
	{
		const std::span<const glm::dvec3> points(all.points.data() + v * count, count);
		const std::span<const double> weights(all.weights.data() + v * count, count);
		value += lambda / k * squaredError(domain, Ensemble::plane, Part::whole, points, weights, &own, 1);
		for (std::size_t i = 0; i < count; ++i)
		{
			gradient.points[v * count + i] += lambda / k * own.points[i];
			gradient.weights[v * count + i] += lambda / k * own.weights[i];
		}
	}
	return value;
}

void checkTileRecipe(const TileRecipe& recipe, Domain domain)
{
	constexpr std::array<int, 5> kSizes{2, 3, 4, 5, 8};
	if (std::find(kSizes.begin(), kSizes.end(), recipe.size) == kSizes.end())
	{
		throw Error(ExitCode::usage, "--size: expected 2, 3, 4, 5 or 8");
	}
	if (recipe.starts < 0 || recipe.starts > 1000)
	{
		throw Error(ExitCode::usage, "--starts: expected a whole number from 1 to 1000");
	}
	if (recipe.lambda != -1.0 && !(recipe.lambda > 0.0 && recipe.lambda <= 1e6))
	{
		throw Error(ExitCode::usage, "--lambda: expected a number above 0, at most 1e6");
	}
	const bool descends = recipe.kind == TileKind::points || recipe.kind == TileKind::transform;
	if (!descends && (recipe.lambda != -1.0 || recipe.starts != 0))
	{
		throw Error(ExitCode::usage,
					"--lambda --starts: --kind even and random are not optimised; expected --kind points or transform");
	}
	if (domain == Domain::sphere)
	{
		throw Error(ExitCode::unsupported,
					"a tile of sphere patterns: rotations leave no error on the sphere; expected disk, ball or hemisphere");
	}
	if (domain == Domain::ball && (recipe.kind == TileKind::transform || recipe.kind == TileKind::even))
	{
		throw Error(ExitCode::unsupported,
					"--kind " + std::string(nameOf(recipe.kind)) +
						": rotations about the view axis are for disk and hemisphere; expected --kind points or random");
	}
}

std::string commandOf(const TileRecipe& recipe, const std::string& pattern_file)
{
	const TileRecipe plain;
	std::string command = "nook tile --pattern " + pattern_file + " --size " + std::to_string(recipe.size);
	if (recipe.kind != plain.kind)
	{
		command += " --kind " + std::string(nameOf(recipe.kind));
	}
	if (recipe.lambda != plain.lambda)
	{
		command += " --lambda " + numberText(recipe.lambda);
	}
	if (recipe.starts != plain.starts)
	{
		command += " --starts " + std::to_string(recipe.starts);
	}
	if (recipe.seed != plain.seed)
	{
		command += " --seed " + std::to_string(recipe.seed);
	}
	return command;
}

PatternTile generateTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run)
{
	checkTileRecipe(recipe, base.domain);
	PatternTile tile = recipe.kind == TileKind::points ? pointsTile(base, recipe, run) : transformedTile(base, recipe, run);
	tile.domain = base.domain;
	tile.size = recipe.size;
	for (Pattern& variant : tile.variants)
	{
		for (glm::dvec3& p : variant.points)
		{
			p = glm::dvec3(roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z));
		}
		for (double& w : variant.weights)
		{
			w = roundToFloat(w);
		}
	}
	return tile;
}

} // namespace nook
