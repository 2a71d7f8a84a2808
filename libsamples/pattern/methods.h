// SPDX-License-Identifier: GPL-3.0-or-later
// The relaxations behind generatePattern: each improves a starting set. Points always follow the layout.
#pragma once

#include "core/progress.h"
#include "core/random.h"
#include "pattern/cells.h"
#include "pattern/energy.h"
#include "pattern/recipe.h"

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace nook
{

// The nearest valid position: disk z = 0; directions of unit length; radii at most 1 − 1e-6; hemisphere lifted from (x, y).
glm::dvec3 placeInDomain(Domain domain, const glm::dvec3& p);

// Separates a pattern's free points from those that follow: a fixed centre first, then the free points, each followed by its
// opposite if the pattern is symmetric.
class Layout
{
public:
	explicit Layout(const Recipe& recipe);

	const Domain domain;
	const bool has_centre;
	const bool symmetric;
	const std::size_t free_count;

	// Number of variables per free point: (x, y) or (x, y, z).
	std::size_t dimension() const
	{
		return isPlanar(domain) ? 2 : 3;
	}

	std::vector<glm::dvec3> expand(std::span<const glm::dvec3> free) const;    // all points
	std::vector<glm::dvec3> freePoints(std::span<const glm::dvec3> all) const; // its inverse

	// Converts to an optimiser's variables (dimension × free_count) and back. False if a point leaves the domain.
	std::vector<double> variables(std::span<const glm::dvec3> all) const;
	bool points(std::span<const double> variables, std::vector<glm::dvec3>& all) const;

	// Converts the gradient by every point (in space) to the gradient by the variables.
	void pullBack(std::span<const double> variables, std::span<const glm::dvec3> all, std::span<const glm::dvec3> point_gradient,
				  std::span<double> gradient) const;

	// Replaces values of opposite points with their mean.
	void symmetrise(std::span<double> values) const;

private:
	std::size_t firstFree(std::size_t k) const
	{
		return (has_centre ? 1U : 0U) + (symmetric ? 2 * k : k);
	}
};

// Each step of a descent counts as one item; its end counts the remaining ones, since most descents stop early.
class StartProgress
{
public:
	// `steps` ≥ 1; further steps are not counted.
	StartProgress(ProgressCounter& progress, std::size_t steps) : m_progress(progress), m_left(steps) {}
	StartProgress& operator=(StartProgress&&) = delete;
	~StartProgress()
	{
		try
		{
			m_progress.finish(m_left);
		}
		catch (...) // the run is cancelled, which its next step reports again
		{
		}
	}

	void step()
	{
		if (m_left > 1)
		{
			m_left -= 1;
			m_progress.finishOne();
		}
	}

private:
	ProgressCounter& m_progress;
	std::size_t m_left;
};

using Points = std::vector<glm::dvec3>;

// Called with the points after each step. May be empty.
using Seen = std::function<void(std::span<const glm::dvec3> points)>;

// Reports one start's points to `watch`.
inline Seen seenBy(const Watch& watch, std::size_t start)
{
	return watch ? Seen([&watch, start](std::span<const glm::dvec3> points) { watch(start, points); }) : Seen();
}

// Likewise for an optimiser's variables.
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

// Also counts each step as progress of its start. Empty if neither is requested.
inline Seen counted(const RunSettings& run, StartProgress& start_progress, const Seen& seen)
{
	if (!run.progress)
	{
		return seen;
	}
	return [&start_progress, seen](std::span<const glm::dvec3> points)
	{
		start_progress.step();
		if (seen)
		{
			seen(points);
		}
	};
}

// Weights of fixed points by the recipe's rule; opposite points get equal weights; sum 1.
std::vector<double> weightsFor(const Recipe& recipe, const Layout& layout, std::span<const glm::dvec3> points);

// Non-negative weights with sum 1 that minimise the points' squared error over the half-space ensemble.
std::vector<double> fittedWeights(Domain domain, std::span<const glm::dvec3> points);

// Power-diagram weights for which every cell's integral is 1/count. Newton's method (Kitagawa, Mérigot and Thibert 2019); relative
// spread below 1e-12 unless points coincide. Throws Error (runtime) if it does not converge.
std::vector<double> equalisingPowers(Domain domain, std::span<const glm::dvec3> points);

// The best of the recipe's starts after its own relaxation (electro, lloyd or equal). Ranked by equal integrals for electro (on the
// sphere: least energy), by the plane error for the others.
Points relaxStarts(const Recipe& recipe, const Layout& layout, const RunSettings& run, const Watch& watch);

// The best of the recipe's starts, each refined.
Points refine(const Recipe& recipe, const Layout& layout, const RunSettings& run, const Watch& watch);

// Reorders the points (opposite points stay together, a centre stays first).
Points reorder(Order order, const Layout& layout, const Points& points);

// Point sets without relaxation: independent, Poisson, Halton, Vogel. All follow the layout and the domain's measure.

std::vector<glm::dvec3> randomPoints(const Layout& layout, Random& random);

// Dart throwing (Cook 1986). The minimum distance starts at that of a dense packing and shrinks by 5 % when darts keep missing.
std::vector<glm::dvec3> poissonPoints(const Layout& layout, Random& random);

// Halton's sequence in bases 2, 3, 5 from index 1, mapped through the measure's inverse distribution.
std::vector<glm::dvec3> haltonPoints(const Layout& layout);

// Golden-angle spiral (Vogel 1979; sphere: Swinbank and Purser 2006); radii in the ball follow a golden-ratio sequence.
std::vector<glm::dvec3> vogelPoints(const Layout& layout);

struct LbfgsSettings
{
	int max_iterations = 200;
	int memory = 12;                  // number of step pairs kept
	double relative_decrease = 1e-10; // stop when ten iterations together lower the value by less than this fraction
	std::function<void(std::span<const double> x)> seen{}; // called after each iteration; may be empty
};

// Progress items per descent: the iterations plus the start's value.
inline std::size_t stepsOf(const LbfgsSettings& settings)
{
	return static_cast<std::size_t>(settings.max_iterations) + 1;
}

// Returns the value at x and writes the gradient (same size as x); infinity where x is invalid (the gradient is then ignored).
using Objective = std::function<double(std::span<const double> x, std::span<double> gradient)>;

// Limited-memory BFGS with a backtracking line search. Replaces x with the best point found and returns its value. The start must
// be valid. Sums run in index order, so the result is the same everywhere.
double minimise(const Objective& objective, std::vector<double>& x, const LbfgsSettings& settings = {});

} // namespace nook
