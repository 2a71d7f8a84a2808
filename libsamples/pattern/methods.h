// SPDX-License-Identifier: GPL-3.0-or-later
// The relaxations behind generatePattern: a starting set → a better one. Points follow the layout throughout.
#pragma once

#include "core/progress.h"
#include "pattern/cells.h"
#include "pattern/energy.h"
#include "pattern/generate.h"
#include "pattern/layout.h"
#include "pattern/start_progress.h"

namespace nook
{

using Points = std::vector<glm::dvec3>;

// What a relaxation tells of its points after each step. May be empty.
using Seen = std::function<void(std::span<const glm::dvec3> points)>;

// Of one start.
inline Seen seenBy(const Watch& watch, std::size_t start)
{
	return watch ? Seen([&watch, start](std::span<const glm::dvec3> points) { watch(start, points); }) : Seen();
}

// The same for an optimiser's variables.
inline std::function<void(std::span<const double> variables)> seenVariables(const Layout& layout, const Seen& seen)
{
	if (!seen)
	{
		return {};
	}
	return [&layout, &seen](std::span<const double> variables)
	{
		Points points;
		layout.points(variables, points);
		seen(points);
	};
}

// The same, and each step is one of the start's part of a stage. Where nobody asks for either, none.
inline Seen counted(const RunSettings& run, StartProgress& told, const Seen& seen)
{
	if (!run.progress)
	{
		return seen;
	}
	return [&told, seen](std::span<const glm::dvec3> points)
	{
		told.step();
		if (seen)
		{
			seen(points);
		}
	};
}

// Cells of a Voronoi diagram, exact or on the paper's grid.
Cells voronoiCells(Domain domain, VoronoiMode mode, std::span<const glm::dvec3> points);

// Weights for points that stand where they are, by the recipe's rule; opposite points get equal weights; sum 1.
std::vector<double> weightsFor(const Recipe& recipe, const Layout& layout, std::span<const glm::dvec3> points);

// Non-negative weights of sum 1 with the least squared error over the half-space ensemble of these points.
std::vector<double> fittedWeights(Domain domain, std::span<const glm::dvec3> points);

// Where the points of these cells go in one step of Lloyd's: the weighted centroids, in the domain and as the layout wants them.
Points centroidsOf(const Layout& layout, const Cells& cells);

// The farthest that any point moves from one set to the other.
double greatestMove(const Points& from, const Points& to);

// Loos & Sloan 2010, §4.5.
void relaxElectro(const Recipe& recipe, const Layout& layout, Points& points, const Seen& seen);

// Centroidal Voronoi: every point to the weighted centroid of its cell, until none moves by more than 1e-7.
void relaxLloyd(const Recipe& recipe, const Layout& layout, Points& points, const Seen& seen, int max_rounds = 400);

// Directions with the least Σ d^−exponent near the start; returns that energy.
double relaxSphereEnergy(const Layout& layout, double exponent, Points& points, const Seen& seen);

// Power-diagram weights with which every cell has the integral 1/count. Newton's method (Kitagawa, Mérigot and Thibert 2019);
// relative spread below 1e-12 unless points coincide. Throws Error (runtime) where it does not converge.
std::vector<double> equalisingPowers(Domain domain, std::span<const glm::dvec3> points);

// Capacity-constrained centroidal power diagram (de Goes et al. 2012): alternates equalisingPowers and centroids.
void relaxEqual(const Layout& layout, Points& points, int rounds, const Seen& seen);

// The best of the recipe's starts after its own relaxation (electro, lloyd or equal): electro by its own goal, equal
// integrals (on the sphere least energy), the others by the plane error.
Points relaxStarts(const Recipe& recipe, const Layout& layout, const RunSettings& run, const Watch& watch);

// Gradient descent on the recipe's measure; returns the value reached. For noise and window, plane_limit is the greatest plane
// error allowed (soft), 0: none.
double descend(const Recipe& recipe, const Layout& layout, Points& points, Minimise minimise, double plane_limit, int threads,
			   const Seen& seen);

// The recipe's measure for finished points and weights: what descend lowers.
double measureValue(Domain domain, Minimise minimise, std::span<const glm::dvec3> points, std::span<const double> weights);

// The best of the recipe's starts, each refined.
Points refine(const Recipe& recipe, const Layout& layout, const RunSettings& run, const Watch& watch);

// The list of points in another order (opposite points stay together, a centre stays first).
Points reorder(Order order, const Layout& layout, const Points& points);

} // namespace nook
