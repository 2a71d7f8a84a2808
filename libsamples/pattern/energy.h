// SPDX-License-Identifier: GPL-3.0-or-later
// Points and weights → the squared error of the pattern over all half-spaces, in closed form and with its gradient.
#pragma once

#include "core/progress.h"
#include "pattern/pattern.h"

#include <span>
#include <vector>

namespace nook
{

// Which ensemble of occluders the error is the mean square over (docs/reference/measures.md).
enum class Ensemble
{
	plane, // half-spaces n·x > c, n and c uniform
	cliff, // disk only: vertical planes
};

// Which part of the error over the rotations of the pattern (about the view axis; in the ball any rotation).
enum class Part
{
	whole,  // noise² + bias²: the pattern as it stands
	window, // what the mean of kWindowRotations even rotations leaves (ball and sphere: of all rotations)
	bias,   // what the mean of all rotations leaves
	noise,  // whole − bias: the variance over the rotations
};

inline constexpr int kWindowRotations = 16;

struct EnergyGradient
{
	std::vector<glm::dvec3> points; // ∂/∂ each point; directions: in space, not yet projected to the tangent plane
	std::vector<double> weights;
};

// The squared error, exact up to rounding (1e-15 absolute); `gradient` may be null. weights: ≥ 0, sum 1.
// `threads` never changes the result.
double squaredError(Domain domain, Ensemble ensemble, Part part, std::span<const glm::dvec3> points,
					std::span<const double> weights, EnergyGradient* gradient = nullptr, int threads = 1);

// How much the samples of any two variants of a tile count together, by the offset of the second's pixel and frame from the
// first's: frames × size × size offsets, rows of x, periodic, the same for an offset and its opposite (tile_filter.h).
struct TileShares
{
	int size = 0;
	int frames = 1;
	std::vector<double> pairs; // their sum is how much the means count that they stand for
};

// For frames · size² groups of as many samples, one after the other, whose weights have sum 1: the sum of the squared errors of all
// those means, each pixel's mean counted alike. `progress`: of a stage of these groups. Otherwise as squaredError.
double tileSquaredError(Domain domain, const TileShares& shares, std::span<const glm::dvec3> points,
						std::span<const double> weights, EnergyGradient* gradient = nullptr, int threads = 1,
						ProgressCounter* progress = nullptr);

// The pieces of the quadratic form in the weights: squared error = Σ w_i linear_i − ½ Σ w_i w_j pairs_ij + constant
// (pairs row by row). For the fitted weights.
struct QuadraticForm
{
	std::vector<double> linear;
	std::vector<double> pairs;
	double constant = 0.0;
};
QuadraticForm quadraticForm(Domain domain, Ensemble ensemble, std::span<const glm::dvec3> points);

// Its pairs between the samples of two patterns, first × second, row by row.
std::vector<double> pairTerms(Domain domain, std::span<const glm::dvec3> first, std::span<const glm::dvec3> second);

} // namespace nook
