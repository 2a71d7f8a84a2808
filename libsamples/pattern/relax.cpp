// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: B. Loos and P.-P. Sloan, "Volumetric Obscurance", 2010, §4.5, and S. Lloyd, "Least squares quantization
// in PCM", 1982.
#include "core/math.h"
#include "core/parallel.h"
#include "pattern/lbfgs.h"
#include "pattern/methods.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

// Net 1/d⁴ repulsion on every point, scaled so that the strongest has length 1.
Points repulsion(Domain domain, const Points& points)
{
	const bool planar = isPlanar(domain);
	Points force(points.size(), glm::dvec3(0.0));
	double strongest = 0.0;
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		for (std::size_t j = 0; j < points.size(); ++j)
		{
			glm::dvec3 d = points[i] - points[j];
			d.z = planar ? 0.0 : d.z;
			const double d2 = glm::dot(d, d);
			if (i != j && d2 > 0.0)
			{
				force[i] += d / (d2 * d2 * std::sqrt(d2));
			}
		}
		strongest = std::max(strongest, glm::length(force[i]));
	}
	for (glm::dvec3& f : force)
	{
		f /= strongest > 0.0 ? strongest : 1.0;
	}
	return force;
}

Points moved(const Layout& layout, const Points& points, const Points& step, double scale)
{
	Points target = points;
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		target[i] = placeInDomain(layout.domain(), points[i] + scale * step[i]);
	}
	return layout.expand(layout.freePoints(target));
}

// Points with their cells, and how far those are from equal.
class Spread
{
public:
	Spread(const Recipe& recipe, const Layout& layout, Points points) : m_recipe(recipe), m_layout(layout)
	{
		take(std::move(points));
	}

	void take(Points points)
	{
		m_points = std::move(points);
		m_cells = voronoiCells(m_recipe.domain, m_recipe.voronoi, m_points);
		m_error = relativeSpread(m_cells.integrals);
	}

	// One force step: shortened until the error falls, else rejected; lengthened for the next time if accepted. False if no step
	// helps.
	bool repel(double& step)
	{
		const Points force = repulsion(m_recipe.domain, m_points);
		for (int trial = 0; trial < 4; ++trial)
		{
			Spread candidate(m_recipe, m_layout, moved(m_layout, m_points, force, step));
			if (candidate.m_error < m_error)
			{
				m_points.swap(candidate.m_points);
				m_cells = std::move(candidate.m_cells);
				m_error = candidate.m_error;
				step *= 1.5;
				return true;
			}
			step *= 0.5;
		}
		return false;
	}

	const Points& points() const
	{
		return m_points;
	}
	const Cells& cells() const
	{
		return m_cells;
	}
	double error() const
	{
		return m_error;
	}

private:
	const Recipe& m_recipe;
	const Layout& m_layout;
	Points m_points;
	Cells m_cells;
	double m_error = 0.0;
};

constexpr std::size_t kSteps = 100; // progress steps per start: about what the methods need for 64 points

} // namespace

Points centroidsOf(const Layout& layout, const Cells& cells)
{
	Points target = cells.centroids;
	for (glm::dvec3& p : target)
	{
		// If one cell covers the whole sphere, its centroid is the centre; any direction will do.
		p = layout.domain() == Domain::sphere && glm::dot(p, p) < 1e-20 ? glm::dvec3(0, 0, 1) : placeInDomain(layout.domain(), p);
	}
	return layout.expand(layout.freePoints(target));
}

double greatestMove(const Points& from, const Points& to)
{
	double greatest = 0.0;
	for (std::size_t i = 0; i < from.size(); ++i)
	{
		greatest = std::max(greatest, glm::distance(from[i], to[i]));
	}
	return greatest;
}

void relaxElectro(const Recipe& recipe, const Layout& layout, Points& points, const Seen& seen)
{
	// Tuned on disk 9, 16, 33 and ball 12, 33 (32 starts): 100 rounds lower the plane error by at most 0.4 %, six force steps by
	// 0.3 %; a single force step raises it by up to 5 %.
	constexpr int kRounds = 40;
	constexpr int kForceSteps = 3;
	const double spacing = 1.0 / std::sqrt(static_cast<double>(points.size()));
	double step = 0.2 * spacing;
	Spread spread(recipe, layout, points);
	Points best = points;
	double best_error = spread.error();
	const auto keepBest = [&]
	{
		if (spread.error() <= best_error)
		{
			best = spread.points();
			best_error = spread.error();
		}
		if (seen)
		{
			seen(spread.points());
		}
	};
	for (int round = 0; round < kRounds; ++round)
	{
		for (int k = 0; k < kForceSteps; ++k)
		{
			if (!spread.repel(step))
			{
				break;
			}
		}
		keepBest();
		// The periodic pull toward the weighted centroids.
		Points target = centroidsOf(layout, spread.cells());
		const double move = greatestMove(spread.points(), target);
		spread.take(std::move(target));
		keepBest();
		step = std::clamp(step, 1e-4 * spacing, 0.2 * spacing);
		if (move < 1e-4 * spacing)
		{
			break;
		}
	}
	points = best;
}

void relaxLloyd(const Recipe& recipe, const Layout& layout, Points& points, const Seen& seen, int max_rounds)
{
	for (int round = 0; round < max_rounds; ++round)
	{
		const Points target = centroidsOf(layout, voronoiCells(recipe.domain, recipe.voronoi, points));
		const double move = greatestMove(points, target);
		points = target;
		if (seen)
		{
			seen(points);
		}
		if (move < 1e-7)
		{
			break;
		}
	}
}

double relaxSphereEnergy(const Layout& layout, double exponent, Points& points, const Seen& seen)
{
	// Minimises log(energy)/exponent: same minimum, but no overflow or bad scaling for high exponents.
	Points all;
	Points gradient_points;
	const auto objective = [&](std::span<const double> x, std::span<double> gradient)
	{
		if (!layout.points(x, all))
		{
			return std::numeric_limits<double>::infinity();
		}
		gradient_points.assign(all.size(), glm::dvec3(0.0));
		double energy = 0.0;
		for (std::size_t i = 0; i < all.size(); ++i)
		{
			for (std::size_t j = i + 1; j < all.size(); ++j)
			{
				const glm::dvec3 d = all[i] - all[j];
				const double d2 = glm::dot(d, d);
				if (d2 == 0.0)
				{
					return std::numeric_limits<double>::infinity();
				}
				const double term = exponent == 1.0 ? 1.0 / std::sqrt(d2) : powOf(d2, -0.5 * exponent);
				energy += term;
				const glm::dvec3 pull = (exponent * term / d2) * d;
				gradient_points[i] -= pull;
				gradient_points[j] += pull;
			}
		}
		if (energy == 0.0) // a single direction
		{
			return 0.0;
		}
		for (glm::dvec3& g : gradient_points)
		{
			g /= exponent * energy;
		}
		layout.pullBack(x, all, gradient_points, gradient);
		return logOf(energy) / exponent;
	};
	std::vector<double> x = layout.variables(points);
	LbfgsSettings settings;
	settings.max_iterations = 1000;
	settings.relative_decrease = 1e-12;
	settings.seen = seenVariables(layout, seen);
	const double value = minimise(objective, x, settings);
	layout.points(x, all);
	points = all;
	return value;
}

Points relaxStarts(const Recipe& recipe, const Layout& layout, const RunSettings& run, const Watch& watch)
{
	const auto starts = static_cast<std::size_t>(defaultStarts(recipe));
	std::vector<Points> sets(starts);
	std::vector<double> values(starts);
	ProgressCounter progress(run.progress, "starts", starts * kSteps);
	parallelFor(starts, run.threads,
				[&](std::size_t k)
				{
					Random random(recipe.seed, k);
					StartProgress start_progress(progress, kSteps);
					const Seen seen = counted(run, start_progress, seenBy(watch, k));
					Points& points = sets[k];
					points = poissonPoints(layout, random);
					const bool energy = recipe.method == Method::electro && recipe.domain == Domain::sphere;
					if (energy)
					{
						values[k] = relaxSphereEnergy(layout, recipe.exponent == 0.0 ? 1.0 : recipe.exponent, points, seen);
					}
					else if (recipe.method == Method::electro)
					{
						// The paper's objective: equal integrals.
						relaxElectro(recipe, layout, points, seen);
						values[k] = relativeSpread(voronoiCells(recipe.domain, recipe.voronoi, points).integrals);
					}
					else
					{
						if (recipe.method == Method::lloyd)
						{
							relaxLloyd(recipe, layout, points, seen);
						}
						else
						{
							relaxEqual(layout, points, 100, seen);
						}
						values[k] =
							squaredError(recipe.domain, Ensemble::plane, Part::whole, points, weightsFor(recipe, layout, points));
					}
				});
	std::size_t best = 0;
	for (std::size_t k = 1; k < starts; ++k)
	{
		best = values[k] < values[best] ? k : best;
	}
	return sets[best];
}

} // namespace nook
