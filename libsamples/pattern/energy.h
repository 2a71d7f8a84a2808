// SPDX-License-Identifier: GPL-3.0-or-later
// Squared error of weighted points over all half-spaces, in closed form with its gradient.
#pragma once

#include "core/progress.h"
#include "pattern/pattern.h"

#include <span>
#include <vector>

namespace nook
{

// The ensemble of occluders whose mean square error is taken (docs/reference/measures.md).
enum class Ensemble
{
	plane, // half-spaces n·x > c, n and c uniform
	cliff, // disk only: vertical planes
};

// Part of the error with respect to rotations of the pattern (about the view axis; in the ball any rotation).
enum class Part
{
	whole,  // noise² + bias²: the pattern without rotation
	window, // error of the mean over kWindowRotations even rotations (ball and sphere: over all rotations)
	bias,   // error of the mean over all rotations
	noise,  // whole − bias: the variance over the rotations
};

inline constexpr int kWindowRotations = 16;

struct EnergyGradient
{
	std::vector<glm::dvec3> points; // ∂/∂ each point; directions: in space, not projected to the tangent plane
	std::vector<double> weights;
};

// The squared error, exact to 1e-15, for any number of threads; `gradient` may be null. Weights are ≥ 0 with sum 1.
double squaredError(Domain domain, Ensemble ensemble, Part part, std::span<const glm::dvec3> points,
					std::span<const double> weights, EnergyGradient* gradient = nullptr, int threads = 1);

// Weights of the pairs of a tile's variants, by the offset of the second's pixel and frame from the first's: frames × size × size
// offsets, rows along x, periodic, equal for an offset and its opposite (tile_filter.h).
struct TileShares
{
	int size = 0;
	int frames = 1;
	std::vector<double> pairs; // their sum is the total weight of the means they describe

	// Those from 1 to end - 1 that have a weight.
	std::vector<std::size_t> offsets(std::size_t end) const;
};

// For frames · size² groups of equally many consecutive samples, whose weights sum to 1: the sum of the squared errors of all
// means, with equal weight per pixel. `progress` counts these groups. Otherwise like squaredError.
double tileSquaredError(Domain domain, const TileShares& shares, std::span<const glm::dvec3> points,
						std::span<const double> weights, EnergyGradient* gradient = nullptr, int threads = 1,
						ProgressCounter* progress = nullptr);

// The squared error as a form in the weights: Σ w_i linear_i − ½ Σ w_i w_j pairs_ij + constant (pairs row by row).
struct QuadraticForm
{
	std::vector<double> linear;
	std::vector<double> pairs;
	double constant = 0.0;
};
QuadraticForm quadraticForm(Domain domain, Ensemble ensemble, std::span<const glm::dvec3> points);

// Pair terms between the samples of two patterns, first × second, row by row.
std::vector<double> pairTerms(Domain domain, std::span<const glm::dvec3> first, std::span<const glm::dvec3> second);

} // namespace nook
