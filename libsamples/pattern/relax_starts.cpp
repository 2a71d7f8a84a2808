// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/parallel.h"
#include "pattern/methods.h"
#include "pattern/starts.h"

namespace nook
{
namespace
{

constexpr std::size_t kSteps = 100; // progress steps per start: about what the methods need for 64 points

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
