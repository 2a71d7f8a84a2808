// SPDX-License-Identifier: GPL-3.0-or-later
// What the ways to make a tile share. For tile*.cpp.
#pragma once

#include "pattern/energy.h"
#include "pattern/methods.h"
#include "pattern/tile.h"

#include <memory>

namespace nook
{

inline constexpr int kDefaultTileStarts = 4;
inline constexpr int kLargestAlone = 4; // pixels: the last start of larger tiles is near copies of a smaller one

// All points of all variants, one variant after the other.
struct VariantUnion
{
	Points points;
	std::vector<double> weights; // of sum 1 in each variant
};

// window² + λ · mean plane², and its gradient by every point and weight.
double tileError(Domain domain, const VariantUnion& all, std::size_t variants, double lambda, EnergyGradient& gradient,
				 int threads);

// The recipe's λ, or the default of its kind.
double lambdaOf(const TileRecipe& recipe);

// The points' structure, read off the points: variants keep the symmetry and the centre of their base.
Recipe structureOf(const Pattern& base);

// Each variant's samples in another order, whose prefixes err little alone and behind the recipe's filter (none: in the window's
// mean); opposite ones stay together, a centre stays first.
void orderProgressively(const Pattern& base, const TileRecipe& recipe, std::vector<Pattern>& variants, const RunSettings& run);

// An upper estimate of what pointsTile takes, bytes.
uint64_t pointsMemory(const Pattern& base, const TileRecipe& recipe, int threads);

// How much a recipe counts its errors behind filters and over frames, or that of the window's mean.
TileShares seenShares(const TileRecipe& recipe);

// Those shares and λ times the variants' own: the objective of the descent.
TileShares sharesOf(const TileRecipe& recipe);

// Variants with samples of their own as the variables of one descent.
class TileProblem
{
public:
	virtual ~TileProblem() = default;
	virtual std::vector<double> start(std::size_t number, Random& random) const = 0;

	// Starts near variants that are given: shaken, since copies of a smaller tile would stay copies.
	virtual std::vector<double> startNear(std::span<const Pattern> variants, Random& random) const = 0;

	// False where the variables are out of all bounds.
	virtual bool unpack(std::span<const double> x, VariantUnion& all) const = 0;

	// Gradient by the samples → by the variables.
	virtual void pullBack(std::span<const double> x, const VariantUnion& all, const EnergyGradient& by_all,
						  std::span<double> gradient) const = 0;
};
std::unique_ptr<TileProblem> sliceProblem(const Pattern& base, const TileRecipe& recipe, std::size_t variants);

// Variants with samples of their own; not yet rounded. `near`: variants of a tile that the last start is near, or none.
PatternTile pointsTile(const Pattern& base, const TileRecipe& recipe, std::span<const Pattern> near, const RunSettings& run);

// Variants that are turned, reflected or scaled copies of the base.
PatternTile transformedTile(const Pattern& base, const TileRecipe& recipe, const RunSettings& run);

} // namespace nook
