// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/advice.h"

#include "core/costs.h"
#include "scene/topology.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace nook
{
namespace
{

constexpr double kMemoryATriangle = 650.0; // for either asset
constexpr double kMemoryAtLeast = 20e6;
constexpr double kOnePlane = 1e-4; // sine of the angle up to which volumes merge neighbours

glm::dvec3 twiceAreaOf(const Level& level, std::size_t t)
{
	const glm::uvec3 corner = level.triangles[t];
	const glm::dvec3 a = level.positions[corner.x];
	return glm::cross(level.positions[corner.y] - a, level.positions[corner.z] - a);
}

bool isOnePlane(glm::dvec3 a, glm::dvec3 b)
{
	const double lengths = glm::length(a) * glm::length(b);
	return lengths > 0.0 && glm::dot(a, b) > 0.0 && glm::length(glm::cross(a, b)) <= kOnePlane * lengths;
}

void findComponents(const Level& level, const std::vector<uint32_t>& place, LevelFacts& facts, int threads)
{
	const std::size_t count = level.triangles.size();
	std::vector<glm::uvec3> placed(count);
	for (std::size_t t = 0; t < count; ++t)
	{
		const glm::uvec3 corners = level.triangles[t];
		placed[t] = {place[corners.x], place[corners.y], place[corners.z]};
	}
	const EdgeTable edges(placed, {}, place.size(), threads);
	Groups components(count);
	Groups patches(count);
	std::vector<uint8_t> open(count, 0);
	edges.each(0, edges.vertexCount(),
			   [&](std::span<const HalfEdge> edge)
			   {
				   const bool pair = isPair(edge);
				   for (const HalfEdge& side : edge)
				   {
					   components.join(edge[0].triangle(), side.triangle());
					   open[side.triangle()] |= pair ? 0 : 1;
				   }
				   if (pair && isOnePlane(twiceAreaOf(level, edge[0].triangle()), twiceAreaOf(level, edge[1].triangle())))
				   {
					   patches.join(edge[0].triangle(), edge[1].triangle());
				   }
			   });
	std::vector<uint8_t> open_component(count, 0);
	for (std::size_t t = 0; t < count; ++t)
	{
		open_component[components.rootOf(static_cast<uint32_t>(t))] |= open[t];
	}
	for (std::size_t t = 0; t < count; ++t)
	{
		const uint32_t root = components.rootOf(static_cast<uint32_t>(t));
		facts.components += root == t ? 1U : 0U;
		facts.closed += root == t && open_component[t] == 0 ? 1U : 0U;
		facts.open_triangles += open_component[root];
		facts.patches += patches.rootOf(static_cast<uint32_t>(t)) == t ? 1U : 0U;
	}
}

void findSizes(const Level& level, LevelFacts& facts)
{
	std::vector<double> areas;
	areas.reserve(level.triangles.size());
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		areas.push_back(0.5 * glm::length(twiceAreaOf(level, t)));
	}
	std::sort(areas.begin(), areas.end());
	const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
	const double coarse_m2 = 0.25 * facts.radius_m * facts.radius_m;
	double below = 0.0;
	double coarse = 0.0;
	for (const double area : areas)
	{
		below += area;
		coarse += area > coarse_m2 ? area : 0.0;
		if (facts.median_edge_m == 0.0 && below >= 0.5 * total)
		{
			facts.median_edge_m = std::sqrt(area);
		}
	}
	facts.coarse_share = total > 0.0 ? coarse / total : 0.0;
}

} // namespace

double suggestedRadius(const Level& level)
{
	const Bounds bounds = boundsOf(level);
	const double wanted = glm::length(bounds.most - bounds.least) / 40.0;
	if (!(wanted > 1e-5))
	{
		return 1e-5;
	}
	for (const double step : {1.5, 1.0, 0.5, 0.25})
	{
		if (step <= wanted)
		{
			return step;
		}
	}
	double radius_m = 0.1;
	while (radius_m > wanted)
	{
		radius_m *= 0.5;
	}
	return radius_m;
}

LevelFacts levelFacts(const Level& level, int threads)
{
	LevelFacts facts;
	const Bounds bounds = boundsOf(level);
	facts.diagonal_m = glm::length(bounds.most - bounds.least);
	facts.radius_m = suggestedRadius(level);
	const std::vector<uint32_t> place = weldPositions(level.positions, threads);
	for (std::size_t v = 0; v < place.size(); ++v)
	{
		facts.places += place[v] == v ? 1U : 0U;
	}
	facts.sharing = place.size() - facts.places;
	findComponents(level, place, facts, threads);
	findSizes(level, facts);
	return facts;
}

// Constants here and above are geometric means over the levels of docs/measurements/bake.md, "What nook info expects".
AssetEstimate volumesEstimate(const Level& level, const LevelFacts& facts)
{
	constexpr double kVolumesAPatch = 1.0;
	constexpr double kBytesAVolume = 52.0;
	const auto triangles = static_cast<double>(level.triangles.size());
	return {kBytesAVolume * kVolumesAPatch * static_cast<double>(facts.patches), cost::kVolume_s * triangles,
			kMemoryAtLeast + kMemoryATriangle * triangles};
}

AssetEstimate bakeEstimate(const Level& level, int rays)
{
	const auto vertices = static_cast<double>(level.positions.size());
	return {4.0 * vertices, cost::kRay_s * rays * vertices,
			kMemoryAtLeast + kMemoryATriangle * static_cast<double>(level.triangles.size())};
}

Advice adviceFor(const LevelFacts& facts, const AssetEstimate& volumes, const AssetEstimate& bake)
{
	constexpr double kSmoothMesh = 20.0; // edges per patch: caves and terrain have 24 and 25, Sponza 15, other architecture 4 to 5
	constexpr double kMuch_bytes = 16e6; // size of volumes that took minutes per picture
	const bool split = facts.coarse_share >= 0.25;
	if (volumes.bytes > kMuch_bytes)
	{
		return {Asset::bake, "volumes of so many polygons take minutes a picture and tens of megabytes", split};
	}
	if (volumes.bytes > kSmoothMesh * bake.bytes)
	{
		return {Asset::bake, "each facet of its smooth surface would be a volume, while vertices are few", split};
	}
	if (facts.coarse_share < 0.5)
	{
		return {Asset::bake, "most of the surface lies in triangles that are small against the distance", split};
	}
	return {Asset::volumes, "most of the surface lies in triangles that are larger than its shadows", false};
}

ScaleDoubt scaleDoubt(const LevelFacts& facts)
{
	return facts.diagonal_m < 1.0 ? ScaleDoubt::small : facts.diagonal_m > 5000.0 ? ScaleDoubt::large : ScaleDoubt::none;
}

} // namespace nook
