// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: B. Loos and P.-P. Sloan, "Volumetric Obscurance", 2010, §4.5, and S. Lloyd, "Least squares quantization
// in PCM", 1982.
#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"
#include "pattern/methods.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
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
		target[i] = placeInDomain(layout.domain, points[i] + scale * step[i]);
	}
	return layout.expand(layout.freePoints(target));
}

// Points with their cells, and how far those are from equal.
struct Spread
{
	const Layout& layout;
	Points points;
	Cells cells = exactCells(layout.domain, points);
	double error = relativeSpread(cells.integrals);

	void take(Spread other)
	{
		points = std::move(other.points);
		cells = std::move(other.cells);
		error = other.error;
	}

	// One force step, shortened until the error falls and longer the next time if accepted. False if no step helps.
	bool repel(double& step)
	{
		const Points force = repulsion(layout.domain, points);
		for (int trial = 0; trial < 4; ++trial)
		{
			Spread candidate{layout, moved(layout, points, force, step)};
			if (candidate.error < error)
			{
				take(std::move(candidate));
				step *= 1.5;
				return true;
			}
			step *= 0.5;
		}
		return false;
	}
};

// One step of Lloyd's method: the weighted centroids, moved into the domain and onto the layout.
Points centroidsOf(const Layout& layout, const Cells& cells)
{
	Points target = cells.centroids;
	for (glm::dvec3& p : target)
	{
		// If one cell covers the whole sphere, its centroid is the centre; any direction will do.
		p = layout.domain == Domain::sphere && glm::dot(p, p) < 1e-20 ? glm::dvec3(0, 0, 1) : placeInDomain(layout.domain, p);
	}
	return layout.expand(layout.freePoints(target));
}

// The greatest distance that any point moves between the two sets.
double greatestMove(const Points& from, const Points& to)
{
	double greatest = 0.0;
	for (std::size_t i = 0; i < from.size(); ++i)
	{
		greatest = std::max(greatest, glm::distance(from[i], to[i]));
	}
	return greatest;
}

// Loos & Sloan 2010, §4.5.
void relaxElectro(const Layout& layout, Points& points, const Seen& seen)
{
	// Tuned on disk 9, 16, 33 and ball 12, 33 (32 starts): 100 rounds lower the plane error by at most 0.4 %, six force steps by
	// 0.3 %; a single force step raises it by up to 5 %.
	constexpr int kRounds = 40;
	constexpr int kForceSteps = 3;
	const double spacing = 1.0 / std::sqrt(static_cast<double>(points.size()));
	double step = 0.2 * spacing;
	Spread spread{layout, points};
	Points best = points;
	double best_error = spread.error;
	const auto keepBest = [&]
	{
		if (spread.error <= best_error)
		{
			best = spread.points;
			best_error = spread.error;
		}
		if (seen)
		{
			seen(spread.points);
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
		Points target = centroidsOf(layout, spread.cells);
		const double move = greatestMove(spread.points, target);
		spread.take({layout, std::move(target)});
		keepBest();
		step = std::clamp(step, 1e-4 * spacing, 0.2 * spacing);
		if (move < 1e-4 * spacing)
		{
			break;
		}
	}
	points = best;
}

// Moves every point to the weighted centroid of its cell until no point moves by more than `least_move`. `cells`: of the points.
template <class CellsOf>
void relaxToCentroids(const Layout& layout, Points& points, int max_rounds, double least_move, const Seen& seen,
					  const CellsOf& cells)
{
	for (int round = 0; round < max_rounds; ++round)
	{
		const Points target = centroidsOf(layout, cells());
		const double move = greatestMove(points, target);
		points = target;
		if (seen)
		{
			seen(points);
		}
		if (move < least_move)
		{
			break;
		}
	}
}

// Centroidal Voronoi.
void relaxLloyd(const Layout& layout, Points& points, int max_rounds, const Seen& seen)
{
	relaxToCentroids(layout, points, max_rounds, 1e-7, seen, [&] { return exactCells(layout.domain, points); });
}

// Capacity-constrained centroidal power diagram (de Goes et al. 2012): alternates equalisingPowers and centroids.
void relaxEqual(const Layout& layout, Points& points, int max_rounds, const Seen& seen)
{
	relaxToCentroids(layout, points, max_rounds, 1e-6, seen,
					 [&] { return exactCells(layout.domain, points, equalisingPowers(layout.domain, points)); });
}

// Minimises Σ d^−exponent of directions near the start; returns that energy.
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
	LbfgsSettings settings{.max_iterations = 1000, .relative_decrease = 1e-12, .seen = seenVariables(layout, seen)};
	const double value = minimise(objective, x, settings);
	layout.points(x, all);
	points = all;
	return value;
}

constexpr std::size_t kSteps = 100; // progress steps per start: about what the methods need for 64 points

// Gradient descent on the measure itself from many starts. The weights are functions of the points (cell integrals or the best
// fit), and the gradient includes their derivatives.

// Minimising plane² alone leaves cliff up to 2 % above the optimum for the same number of lines. Adding half of cliff² raises plane
// by 0.5 to 2 % and lowers cliff by 0.5 to 1.2 % (disk 9, 16, 32).
constexpr double kCliffShare = 0.5;

// How much plane error noise and window may cost relative to the paper's relaxation; the soft limit lies inside the hard one.
constexpr double kPlaneAllowance = 1.10;
constexpr double kSoftAllowance = 1.09;

// Above this count the fit's cubic cost is paid only once, after a descent with the cells' weights.
constexpr int kMaxFittedDescent = 128;

struct Term
{
	Ensemble ensemble;
	Part part;
	double factor;
};

std::vector<Term> termsOf(Domain domain, Minimise minimise)
{
	switch (minimise)
	{
	case Minimise::noise: return {{Ensemble::plane, Part::noise, 1.0}};
	case Minimise::cliff: return {{Ensemble::cliff, Part::whole, 1.0}};
	case Minimise::window: return {{Ensemble::plane, Part::window, 1.0}};
	case Minimise::rms: break;
	}
	std::vector<Term> terms{{Ensemble::plane, Part::whole, 1.0}};
	if (domain == Domain::disk)
	{
		terms.push_back({Ensemble::cliff, Part::whole, kCliffShare});
	}
	return terms;
}

void addScaled(EnergyGradient& sum, const EnergyGradient& other, double factor)
{
	for (std::size_t i = 0; i < other.points.size(); ++i)
	{
		sum.points[i] += factor * other.points[i];
		sum.weights[i] += factor * other.weights[i];
	}
}

// Sum of the terms, plus a penalty where plane² exceeds limit².
double valueAndGradient(Domain domain, const std::vector<Term>& terms, double plane_limit, std::span<const glm::dvec3> points,
						std::span<const double> weights, EnergyGradient& gradient, int threads)
{
	gradient.points.assign(points.size(), glm::dvec3(0.0));
	gradient.weights.assign(points.size(), 0.0);
	EnergyGradient part;
	double value = 0.0;
	for (const Term& term : terms)
	{
		value += term.factor * squaredError(domain, term.ensemble, term.part, points, weights, &part, threads);
		addScaled(gradient, part, term.factor);
	}
	if (plane_limit > 0.0)
	{
		constexpr double kStiffness = 20.0;
		const double limit2 = plane_limit * plane_limit;
		const double excess = squaredError(domain, Ensemble::plane, Part::whole, points, weights, &part, threads) - limit2;
		if (excess > 0.0)
		{
			value += kStiffness * excess * excess / limit2;
			addScaled(gradient, part, 2.0 * kStiffness * excess / limit2);
		}
	}
	return value;
}

int iterationLimit(int count)
{
	return count <= 256 ? 300 : count <= 1024 ? 120 : 60;
}

// Progress items per descent.
std::size_t stepsOf(const Recipe& recipe)
{
	return static_cast<std::size_t>(iterationLimit(recipe.count)) + 1;
}

// Gradient descent on the recipe's measure; returns the value reached. plane_limit: soft limit of the plane error; 0: none.
double descend(const Recipe& recipe, const Layout& layout, Points& points, Minimise minimise_what, double plane_limit, int threads,
			   const Seen& seen)
{
	const std::vector<Term> terms = termsOf(recipe.domain, minimise_what);
	const bool fitted = recipe.weights == WeightRule::fitted && recipe.count <= kMaxFittedDescent;
	const bool voronoi = recipe.weights != WeightRule::equal && !fitted;
	Points all;
	EnergyGradient by_all;
	const Objective objective = [&](std::span<const double> x, std::span<double> gradient)
	{
		if (!layout.points(x, all))
		{
			return std::numeric_limits<double>::infinity();
		}
		Cells cells;
		std::vector<double> weights;
		if (voronoi)
		{
			cells = exactCells(recipe.domain, all);
			weights = cells.integrals;
		}
		else
		{
			weights = weightsFor(recipe, layout, all);
		}
		const double value = valueAndGradient(recipe.domain, terms, plane_limit, all, weights, by_all, threads);
		if (voronoi) // the fitted weights are stationary, the equal ones constant
		{
			addCellGradient(recipe.domain, all, cells.facets, by_all.weights, by_all.points);
		}
		layout.pullBack(x, all, by_all.points, gradient);
		return value;
	};
	std::vector<double> x = layout.variables(points);
	LbfgsSettings settings{.max_iterations = iterationLimit(recipe.count), .seen = seenVariables(layout, seen)};
	const double value = minimise(objective, x, settings);
	const bool allowed = layout.points(x, points);
	assert(allowed);
	static_cast<void>(allowed);
	return value;
}

// The recipe's measure of given points and weights: the objective of descend.
double measureValue(Domain domain, Minimise minimise_what, std::span<const glm::dvec3> points, std::span<const double> weights)
{
	return sumOver(termsOf(domain, minimise_what),
				   [&](const Term& term) { return term.factor * squaredError(domain, term.ensemble, term.part, points, weights); });
}

struct Candidate
{
	Points points;
	double value = 0.0;
	double plane = 0.0;
};

void relaxStart(const Recipe& recipe, const Layout& layout, std::size_t index, Points& points, const Seen& seen)
{
	if (recipe.count > 256)
	{
		relaxLloyd(layout, points, 20, seen);
	}
	else if (index % 4 == 0 && recipe.domain != Domain::sphere)
	{
		relaxElectro(layout, points, seen);
	}
	else if (index % 4 == 0)
	{
		relaxSphereEnergy(layout, 1.0, points, seen);
	}
	else if (index % 4 == 1)
	{
		relaxEqual(layout, points, 5, seen);
	}
}

// Indices of the candidates, best first; stable.
std::vector<std::size_t> ranking(const std::vector<Candidate>& candidates)
{
	std::vector<std::size_t> order = countingFrom(std::size_t{0}, candidates.size());
	std::stable_sort(order.begin(), order.end(),
					 [&](std::size_t l, std::size_t r) { return candidates[l].value < candidates[r].value; });
	return order;
}

// True if the plane error is limited relative to the paper's relaxation.
bool isBounded(const Recipe& recipe)
{
	return recipe.minimise == Minimise::noise || recipe.minimise == Minimise::window;
}

double planeOf(const Recipe& recipe, const Layout& layout, const Points& points)
{
	return std::sqrt(squaredError(recipe.domain, Ensemble::plane, Part::whole, points, weightsFor(recipe, layout, points)));
}

// Relaxes every start. Minimises the rms error with the weights of `first` unless another measure decides in the end.
std::vector<Candidate> relaxedStarts(const Recipe& recipe, const Recipe& first, const Layout& layout, const RunSettings& run,
									 const Watch& watch)
{
	const auto starts = static_cast<std::size_t>(defaultStarts(recipe));
	std::vector<Candidate> candidates(starts);
	const std::size_t steps = stepsOf(recipe);
	ProgressCounter progress(run.progress, "starts", starts * steps);
	parallelFor(starts, run.threads,
				[&](std::size_t k)
				{
					Random random(recipe.seed, k);
					Candidate& candidate = candidates[k];
					StartProgress start_progress(progress, steps);
					const Seen seen = counted(run, start_progress, seenBy(watch, k));
					candidate.points = poissonPoints(layout, random);
					relaxStart(recipe, layout, k, candidate.points, seen);
					if (!isBounded(recipe))
					{
						candidate.value =
							descend(first, layout, candidate.points, Minimise::rms, 0.0, starts == 1 ? run.threads : 1, seen);
					}
				});
	return candidates;
}

// Refines the candidates in `order` on the final measure with the requested weights.
std::vector<Candidate> finished(const Recipe& recipe, const Layout& layout, const std::vector<Candidate>& candidates,
								const std::vector<std::size_t>& order, const RunSettings& run, const Watch& watch)
{
	const bool bounded = isBounded(recipe);
	const int inner_threads = candidates.size() == 1 ? run.threads : 1;
	double plane_scale = 0.0;
	if (bounded)
	{
		Recipe paper = recipe;
		paper.method = Method::electro;
		plane_scale = planeOf(recipe, layout, relaxStarts(paper, layout, run, watch));
	}
	std::vector<Candidate> finals(order.size());
	const std::size_t steps = stepsOf(recipe);
	ProgressCounter progress(run.progress, "descent", order.size() * steps);
	parallelFor(order.size(), run.threads,
				[&](std::size_t k)
				{
					Candidate& candidate = finals[k];
					candidate.points = candidates[order[k]].points;
					StartProgress start_progress(progress, steps);
					descend(recipe, layout, candidate.points, recipe.minimise, kSoftAllowance * plane_scale, inner_threads,
							counted(run, start_progress, seenBy(watch, order[k])));
					candidate.value = measureValue(recipe.domain, recipe.minimise, candidate.points,
												   weightsFor(recipe, layout, candidate.points));
					candidate.plane = planeOf(recipe, layout, candidate.points);
					if (bounded && candidate.plane > kPlaneAllowance * plane_scale)
					{
						candidate.value += 1.0 + candidate.plane; // chosen only if no other candidate meets the limit
					}
				});
	return finals;
}

} // namespace

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
						relaxElectro(layout, points, seen);
						values[k] = relativeSpread(exactCells(recipe.domain, points).integrals);
					}
					else
					{
						if (recipe.method == Method::lloyd)
						{
							relaxLloyd(layout, points, 400, seen);
						}
						else
						{
							relaxEqual(layout, points, 100, seen);
						}
						values[k] =
							squaredError(recipe.domain, Ensemble::plane, Part::whole, points, weightsFor(recipe, layout, points));
					}
				});
	return sets[static_cast<std::size_t>(std::min_element(values.begin(), values.end()) - values.begin())];
}

Points refine(const Recipe& recipe, const Layout& layout, const RunSettings& run, const Watch& watch)
{
	// Except on the disk, equal weights are close to the cells' weights and need no cells.
	Recipe first = recipe;
	if (recipe.domain != Domain::disk)
	{
		first.weights = WeightRule::equal;
	}
	const std::vector<Candidate> candidates = relaxedStarts(recipe, first, layout, run, watch);
	std::vector<std::size_t> order = ranking(candidates);
	if (recipe.minimise == Minimise::rms)
	{
		if (first.weights == recipe.weights)
		{
			return candidates[order.front()].points;
		}
		order.resize(std::min(order.size(), std::max<std::size_t>(3, candidates.size() / 8)));
	}
	const std::vector<Candidate> finals = finished(recipe, layout, candidates, order, run, watch);
	return finals[ranking(finals).front()].points;
}

} // namespace nook
