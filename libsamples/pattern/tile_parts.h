// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the ways to make a tile. For tile*.cpp.
#pragma once

#include "pattern/energy.h"
#include "pattern/methods.h"
#include "pattern/tile.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace nook
{

inline constexpr int kDefaultTileStarts = 4;
inline constexpr int kLargestAlone = 4; // pixels: for larger tiles the last start is near copies of a smaller one

// All points of all variants, one variant after the other.
struct VariantUnion
{
	Points points;
	std::vector<double> weights; // sum 1 in each variant
};

// window² + λ · mean plane², and its gradient by every point and weight.
double tileError(Domain domain, const VariantUnion& all, std::size_t variants, double lambda, EnergyGradient& gradient,
				 int threads);

// Number of variants with their own samples.
inline std::size_t variantsOf(const TileRecipe& recipe)
{
	return static_cast<std::size_t>(recipe.size * recipe.size * (recipe.moves ? 1 : recipe.frames));
}

// The recipe's λ, or the default for its filters and frames.
double lambdaOf(const TileRecipe& recipe);

// Structure read from the points: variants keep the symmetry and the centre of their base.
Recipe structureOf(const Pattern& base);

// Reorders each variant's samples so that prefixes have small errors, alone and behind the recipe's filter (none: in the window's
// mean). Opposite samples stay together, and a centre stays first.
void orderProgressively(const Pattern& base, const TileRecipe& recipe, std::vector<Pattern>& variants, const RunSettings& run);

// Upper estimate of the memory of pointsTile, bytes.
uint64_t pointsMemory(const Pattern& base, const TileRecipe& recipe, int threads);

// Pair weights of the recipe's errors behind filters and over frames, or of the window's mean.
TileShares seenShares(const TileRecipe& recipe);

// Those weights plus λ times the variants' own: the objective of the descent.
TileShares sharesOf(const TileRecipe& recipe);

// Variants with their own samples, as the variables of one descent.
class TileProblem
{
public:
	virtual ~TileProblem() = default;
	virtual std::vector<double> start(std::size_t number, Random& random) const = 0;

	// Starts near given variants, perturbed: exact copies of a smaller tile would stay copies.
	virtual std::vector<double> startNear(std::span<const Pattern> variants, Random& random) const = 0;

	// False if the variables are out of range.
	virtual bool unpack(std::span<const double> x, VariantUnion& all) const = 0;

	// Converts the gradient by the samples to that by the variables.
	virtual void pullBack(std::span<const double> x, const VariantUnion& all, const EnergyGradient& by_all,
						  std::span<double> gradient) const = 0;
};
std::unique_ptr<TileProblem> sliceProblem(const Pattern& base, const TileRecipe& recipe, std::size_t variants);

// Variants with their own samples, not yet rounded. `near`: variants of a tile that the last start begins near, or none.
PatternTile pointsTile(const Pattern& base, const TileRecipe& recipe, std::span<const Pattern> near, const RunSettings& run);

// Variants that are rotated or reflected copies of the base.
PatternTile transformedTile(const Pattern& base, const TileRecipe& recipe);

// Approximates a large tile's squared error behind a filter and a mean over frames in time linear in the samples.

// Memory of one evaluation per variant, in addition to points, weights and their gradient.
std::size_t momentBytes(Domain domain, const TileShares& shares);

// Temporary memory for the constructor.
std::size_t formBytes(Domain domain);

class TileMoments
{
public:
	// `shares` as for tileSquaredError.
	TileMoments(Domain domain, const TileShares& shares);

	// Like tileSquaredError, with its gradient: exact within a variant, by moments between them, for any number of threads.
	double operator()(std::span<const glm::dvec3> points, std::span<const double> weights, EnergyGradient& gradient, int threads);

private:
	using Exponents = std::array<int, 3>;

	struct Offset
	{
		int dx;
		int dy;
		std::vector<double> shares; // by frames later, or by frequency
	};

	void makeForm();
	void makeOffsets(const TileShares& shares);
	void findMoments(std::span<const glm::dvec3> points, std::span<const double> weights, int threads);
	void turnInTime(const std::vector<double>& from, std::vector<double>& to, bool back, int threads) const;
	void meet(const std::vector<double>& from, std::vector<double>& to, int threads) const;
	double pullBack(std::span<const glm::dvec3> points, std::span<const double> weights, EnergyGradient& gradient, int threads);

	Domain m_domain;
	std::size_t m_size;
	std::size_t m_frames;
	double m_own;                                     // weight of a variant with itself
	bool m_even = true;                               // the weights are symmetric in time
	std::vector<Exponents> m_exponents;               // of the monomials
	std::vector<std::array<std::size_t, 2>> m_ranges; // ranges of the monomials with equal parity
	std::vector<double> m_form;                       // A, monomials × monomials
	std::vector<Offset> m_offsets;
	std::vector<double> m_waves;   // frames × frames, orthonormal
	std::vector<double> m_moments; // variants × monomials, like the following
	std::vector<double> m_met;
	std::vector<double> m_spare;
};

} // namespace nook
