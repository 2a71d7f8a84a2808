// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake.h"

#include "bake/refine.h"
#include "bake/surface_samples.h"
#include "bake/unknowns.h"
#include "bake/vertex_fit.h"
#include "core/work_units.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

// The place and side that each value stands for: its first vertex that has a normal.
std::vector<ReferencePoint> pointsOf(const Level& level, const Unknowns& unknowns)
{
	const std::vector<glm::vec3> normals = vertexNormals(level);
	std::vector<ReferencePoint> points(unknowns.count, {glm::dvec3(0.0), glm::dvec3(0.0, 1.0, 0.0), 0.0});
	std::vector<uint8_t> done(unknowns.count, 0);
	const auto put = [&](uint32_t i, glm::dvec3 position, glm::dvec3 normal)
	{
		if (done[i] == 0)
		{
			points[i] = {position, normal, 0.0};
			done[i] = 1;
		}
	};
	for (std::size_t v = 0; v < normals.size(); ++v)
	{
		if (normals[v] != glm::vec3(0.0F))
		{
			const glm::dvec3 normal = glm::normalize(glm::dvec3(normals[v]));
			put(unknowns.of_vertex[v], level.positions[v], normal);
			put(unknowns.of_back[v], level.positions[v], -normal);
		}
	}
	return points;
}

VertexBake atPoints(const Tracer& tracer, const Unknowns& unknowns, const BakeSettings& settings, const RunSettings& run)
{
	const Level& level = tracer.level();
	const std::vector<ReferencePoint> points = pointsOf(level, unknowns);
	ReferenceSettings how;
	how.measure = settings.bent ? ReferenceMeasure::bent : ReferenceMeasure::obscurance;
	how.radius_m = settings.radius_m;
	how.falloff = settings.falloff;
	how.falloff_u_m = settings.falloff_u_m;
	how.rays = settings.rays;
	how.seed = settings.seed;
	const std::vector<ReferenceValue> values = referenceAtPoints(tracer, points, how, run);
	VertexBake bake;
	FittedValues at_points;
	double squares = 0.0;
	for (const ReferenceValue& value : values)
	{
		squares += value.standard_error * value.standard_error;
		bake.rays += static_cast<std::size_t>(value.rays);
		at_points.values.push_back(static_cast<float>(value.visibility));
		if (settings.bent)
		{
			at_points.bent.emplace_back(value.bent);
		}
	}
	bake.points = values.size();
	at_points.standard_error = std::sqrt(squares / static_cast<double>(values.size()));
	take(bake, level, unknowns, at_points);
	return bake;
}

VertexBake overSurface(const Tracer& tracer, const Unknowns& unknowns, const BakeSettings& settings, const RunSettings& run)
{
	const Level& level = tracer.level();
	const std::vector<double> areas = areasOf(level);
	const int rays = std::min(settings.rays, kRaysOfPoint);
	const double all = static_cast<double>(unknowns.count) * settings.rays;
	const SamplePlaces places(level, samplesOfTriangles(areas, static_cast<std::size_t>(std::ceil(all / rays))), settings.seed);
	if (isPart(run)) // without the others' samples there is nothing to fit, and a block of them at a time is enough
	{
		std::vector<SurfaceSample> block;
		const auto place_block = [&](std::size_t first, std::size_t size)
		{
			block.resize(size);
			places.place(first, block);
			return std::span(block);
		};
		traceSamples(tracer, level, places.count(), place_block, settings, rays, settings.seed, run, "rays");
		VertexBake none;
		const FittedValues nothing{std::vector<float>(unknowns.count, 1.0F),
								   std::vector<glm::dvec3>(settings.bent ? unknowns.count : 0, glm::dvec3(0.0)), 0.0};
		take(none, level, unknowns, nothing);
		return none;
	}
	std::vector<SurfaceSample> samples = places.all();
	traceSamples(tracer, level, samples, settings, rays, settings.seed, run, "rays");
	const ProgressCounter stage(run.progress, "fit");
	const FittedValues fitted = fitValues(level, areas, unknowns, samples, settings.seed, fitSettingsOf(settings));
	VertexBake bake;
	bake.points = samples.size();
	bake.rays = samples.size() * static_cast<std::size_t>(rays);
	bake.buried = buriedOf(samples);
	bake.shut = shutOf(samples);
	take(bake, level, unknowns, fitted);
	return bake;
}

} // namespace

VertexBake bakeVertices(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run)
{
	assert(settings.rays >= 1 && settings.radius_m > 0.0 && settings.normals != NormalKind::from_depth);
	if (settings.max_error > 0.0)
	{
		return refineBake(tracer, settings, run);
	}
	const Unknowns unknowns = unknownsOf(tracer.level(), settings.sides);
	VertexBake bake =
		settings.fit == BakeFit::points ? atPoints(tracer, unknowns, settings, run) : overSurface(tracer, unknowns, settings, run);
	bake.unknowns = unknowns.count;
	return bake;
}

} // namespace nook
