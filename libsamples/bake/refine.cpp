// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/refine.h"

#include "bake/subdivide.h"
#include "bake/vertex_fit.h"
#include "core/random.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr int kMostRounds = 32; // each halves edges: a kilometre to a micrometre; shorter ones are not split anyway

// Edges are not cut to less than that: shadows of contact begin without width.
double leastEdge(const Tracer& tracer, const BakeSettings& settings)
{
	const double diagonal_m = glm::distance(tracer.bounds().least, tracer.bounds().most);
	return std::isfinite(settings.radius_m) ? settings.radius_m / 32.0 : diagonal_m / 4096.0;
}

bool isPair(const SurfaceSample& a, const SurfaceSample& b)
{
	return a.triangle == b.triangle && a.b == b.b && a.c == b.c && !a.back && b.back && !a.buried && !b.buried;
}

// Root mean square difference of each triangle's samples from its interpolated values, less what their rays do not know. Where both
// sides of one place have one value it is that of their mean, since splitting brings them no nearer. 0 where all lie inside matter.
std::vector<double> errorsOf(const Level& level, const Unknowns& unknowns, std::span<const SurfaceSample> samples,
							 std::span<const float> values)
{
	std::vector<double> squares(level.triangles.size(), 0.0);
	std::vector<uint32_t> counts(level.triangles.size(), 0);
	for (std::size_t i = 0; i < samples.size(); ++i)
	{
		const SurfaceSample& sample = samples[i];
		if (sample.buried)
		{
			continue;
		}
		const glm::uvec3 t = level.triangles[sample.triangle];
		const std::vector<uint32_t>& of = sample.back ? unknowns.of_back : unknowns.of_vertex;
		const float value =
			(1.0F - sample.b - sample.c) * values[of[t.x]] + sample.b * values[of[t.y]] + sample.c * values[of[t.z]];
		auto seen = static_cast<double>(sample.visibility);
		double unsure = static_cast<double>(sample.standard_error) * static_cast<double>(sample.standard_error);
		if (!unknowns.has_sides && i + 1 < samples.size() && isPair(sample, samples[i + 1]))
		{
			i += 1;
			const auto other = static_cast<double>(samples[i].standard_error);
			seen = 0.5 * (seen + static_cast<double>(samples[i].visibility));
			unsure = 0.25 * (unsure + other * other);
		}
		const double off = static_cast<double>(value) - seen;
		squares[sample.triangle] += off * off - unsure;
		counts[sample.triangle] += 1;
	}
	for (std::size_t t = 0; t < squares.size(); ++t)
	{
		squares[t] = counts[t] > 0 ? std::sqrt(std::max(0.0, squares[t] / counts[t])) : 0.0;
	}
	return squares;
}

// Triangles above the error, those first whose splitting saves most.
struct Worst
{
	std::vector<uint32_t> large; // that may be split
	std::size_t small = 0;       // whose edges are too short
	double area_m2 = 0.0;        // of both
};

Worst worstOf(const EdgeMarks& marks, std::span<const double> areas, std::span<const double> errors, double max_error,
			  double least_edge_m)
{
	Worst worst;
	for (std::size_t t = 0; t < errors.size(); ++t)
	{
		if (errors[t] > max_error)
		{
			worst.area_m2 += areas[t];
			if (marks.longest(t) > 2.0 * least_edge_m)
			{
				worst.large.push_back(static_cast<uint32_t>(t));
			}
			else
			{
				worst.small += 1;
			}
		}
	}
	const auto saved = [&](uint32_t t)
	{
		return areas[t] * errors[t] * errors[t];
	};
	std::sort(worst.large.begin(), worst.large.end(),
			  [&](uint32_t a, uint32_t b) { return saved(a) != saved(b) ? saved(a) > saved(b) : a < b; });
	return worst;
}

// Marks as many of them, from the first, as room is for; returns how many.
std::size_t markWorst(EdgeMarks& marks, std::span<const uint32_t> worst, std::size_t room)
{
	std::size_t count = worst.size();
	while (count > 0)
	{
		marks.clear();
		for (const uint32_t t : worst.first(count))
		{
			marks.mark(t);
		}
		const std::size_t made = marks.newVertices();
		if (made <= room)
		{
			break;
		}
		count = std::min(count - 1, static_cast<std::size_t>(0.95 * static_cast<double>(count) * static_cast<double>(room) /
															 static_cast<double>(made)));
	}
	return count;
}

// How many samples a triangle has: `least`, or one in each cell of its area, so that what stands on a large one is seen.
struct Density
{
	std::size_t least = 2;
	double cell_m2 = 0.0;
};

Density densityOf(const Tracer& tracer, const BakeSettings& settings, int rays, double area_m2)
{
	constexpr double kMostCells = 1e6; // of a level that is large against the radius
	const double side_m = 8.0 * leastEdge(tracer, settings);
	// There are about two triangles for each vertex; two samples tell a difference from noise.
	return {static_cast<std::size_t>(std::max(2, settings.rays / rays / 2)), std::max(side_m * side_m, area_m2 / kMostCells)};
}

// New samples for triangles that have too few, traced, in their places; returns how many.
std::size_t topUp(const Tracer& tracer, const Level& level, std::vector<SurfaceSample>& samples, const Density& density, int rays,
				  uint32_t seed, const BakeSettings& settings, const RunSettings& run)
{
	const std::vector<double> areas = areasOf(level);
	std::vector<std::size_t> missing;
	missing.reserve(areas.size());
	for (const double area_m2 : areas)
	{
		missing.push_back(std::max(density.least, static_cast<std::size_t>(area_m2 / density.cell_m2)));
	}
	for (const SurfaceSample& sample : samples)
	{
		missing[sample.triangle] -= std::min<std::size_t>(missing[sample.triangle], 1);
	}
	std::vector<SurfaceSample> added = SamplePlaces(level, missing, seed).all();
	traceSamples(tracer, level, added, settings, rays, seed, run, "rays");
	const std::size_t before = samples.size();
	samples.insert(samples.end(), added.begin(), added.end());
	std::inplace_merge(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(before), samples.end(),
					   [](const SurfaceSample& a, const SurfaceSample& b) { return a.triangle < b.triangle; });
	return added.size();
}

double totalOf(std::span<const double> values)
{
	double sum = 0.0;
	for (const double value : values)
	{
		sum += value;
	}
	return sum;
}

} // namespace

VertexBake refineBake(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run)
{
	assert(settings.max_error > 0.0 && settings.fit == BakeFit::surface);
	VertexBake bake;
	Level& level = bake.refined.emplace(tracer.level());
	const int rays = std::min(settings.rays, kRaysOfPoint);
	const Density density = densityOf(tracer, settings, rays, totalOf(areasOf(level)));
	const double least_edge_m = leastEdge(tracer, settings);
	std::vector<SurfaceSample> samples;
	bake.points = topUp(tracer, level, samples, density, rays, settings.seed, settings, run);
	bool is_last = false;
	for (int round = 1;; ++round)
	{
		const ProgressCounter stage(run.progress, "fit");
		const std::vector<double> areas = areasOf(level);
		const Unknowns unknowns = unknownsOf(level, settings.sides);
		const FittedValues fitted = fitValues(level, areas, unknowns, samples, settings.seed, fitSettingsOf(settings));
		take(bake, level, unknowns, fitted);
		EdgeMarks marks(level, unknowns);
		const Worst worst =
			worstOf(marks, areas, errorsOf(level, unknowns, samples, fitted.values), settings.max_error, least_edge_m);
		bake.above = worst.large.size() + worst.small;
		bake.area_above_m2 = worst.area_m2;
		if (is_last || worst.large.empty() ||
			static_cast<double>(worst.large.size()) < settings.few * static_cast<double>(areas.size()))
		{
			break;
		}
		const std::size_t room = settings.max_vertices - std::min(settings.max_vertices, level.positions.size());
		const std::size_t marked = markWorst(marks, worst.large, room);
		bake.capped = marked < worst.large.size();
		is_last = bake.capped || round == kMostRounds;
		if (marked == 0)
		{
			break;
		}
		splitMarked(level, samples, marks);
		const auto seed = settings.seed + static_cast<uint32_t>(round) * 0x85ebca6bU; // another sequence for each round
		bake.points += topUp(tracer, level, samples, density, rays, seed, settings, run);
	}
	bake.rays = bake.points * static_cast<std::size_t>(rays);
	bake.buried = buriedOf(samples);
	bake.shut = shutOf(samples);
	return bake;
}

} // namespace nook
