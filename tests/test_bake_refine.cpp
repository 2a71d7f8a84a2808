// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles are split until the vertex bake meets the requested error.
#include "bake_levels.h"

#include "bake/surface_samples.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace nook;
using namespace nook::test;

namespace
{

Level floorUnderBox()
{
	Level level = emptyLevel();
	addQuad(level, {-2.0, 0.0, 2.0}, {4.0, 0.0, 0.0}, {0.0, 0.0, -4.0});
	addBox(level, {-0.31, 0.0, -0.27}, {0.29, 0.5, 0.33});
	return level;
}

// Number of vertices inside an edge where another triangle ends: a crack would open there.
std::size_t verticesWithinEdges(const Level& level)
{
	std::size_t found = 0;
	for (const glm::uvec3& t : level.triangles)
	{
		for (int edge = 0; edge < 3; ++edge)
		{
			const glm::dvec3 a = level.positions[t[edge]];
			const glm::dvec3 way = level.positions[t[(edge + 1) % 3]] - a;
			for (const glm::dvec3& p : level.positions)
			{
				const double share = glm::dot(p - a, way) / glm::dot(way, way);
				found += share > 1e-6 && share < 1.0 - 1e-6 && glm::distance(p, a + share * way) < 1e-9 ? 1U : 0U;
			}
		}
	}
	return found;
}

double surfaceOf(const Level& level)
{
	double sum = 0.0;
	for (const double area : areasOf(level))
	{
		sum += area;
	}
	return sum;
}

} // namespace

TEST_CASE("bake: where few triangles may be left to split, it ends earlier, and no more are left", "[bake]")
{
	const Level level = floorUnderBox();
	const Tracer tracer(level, {});
	BakeSettings settings = within(0.5);
	settings.max_error = 0.02;
	const VertexBake all = bakeVertices(tracer, settings, {});
	settings.few = 0.05;
	const VertexBake most = bakeVertices(tracer, settings, {});
	REQUIRE(all.refined);
	REQUIRE(most.refined);
	const auto triangles = static_cast<double>(most.refined->triangles.size());
	CAPTURE(triangles, all.refined->triangles.size(), all.above, most.above);
	CHECK(most.refined->triangles.size() < all.refined->triangles.size());
	CHECK(static_cast<double>(most.above) < static_cast<double>(all.above) + 0.05 * triangles);
	settings.few = 0.999; // all but the last triangle of the level may stay unsplit
	CHECK(bakeVertices(tracer, settings, {}).refined->triangles.size() <= most.refined->triangles.size());
}

TEST_CASE("bake: triangles are split until the error is what was asked for, and no crack opens", "[bake]")
{
	const Level level = floorUnderBox();
	const Tracer tracer(level, {});
	BakeSettings settings = within(0.5);
	const double before = checkBake(tracer, level, bakeVertices(tracer, settings, {}), settings, 1000, {}).rmse;
	settings.max_error = 0.05;
	const VertexBake bake = bakeVertices(tracer, settings, {});
	REQUIRE(bake.refined);
	const Level& refined = *bake.refined;
	CHECK(refined.triangles.size() > 4 * level.triangles.size());
	CHECK(refined.meshes.back().triangle_count == refined.triangles.size());
	CHECK(refined.materials.size() == refined.triangles.size());
	CHECK(bake.visibility.size() == refined.positions.size());
	CHECK_FALSE(bake.capped);
	CHECK(std::fabs(surfaceOf(refined) - surfaceOf(level)) < 1e-9);
	CHECK(bake.area_above_m2 < 0.02 * surfaceOf(level));
	CHECK(verticesWithinEdges(level) == 0);
	CHECK(verticesWithinEdges(refined) == 0);
	const double after = checkBake(tracer, refined, bake, settings, 1000, {}).rmse;
	CAPTURE(before, after);
	CHECK(after < 0.05);
	CHECK(after < 0.5 * before);
	CHECK(bakeVertices(tracer, settings, {2, {}}).visibility == bake.visibility);
}

TEST_CASE("bake: no more vertices than allowed, and it is said that more were wanted", "[bake]")
{
	const Level level = floorUnderBox();
	const Tracer tracer(level, {});
	BakeSettings settings = within(0.5);
	settings.max_error = 0.01;
	for (const std::size_t most : {std::size_t{5}, level.positions.size(), std::size_t{100}})
	{
		settings.max_vertices = most;
		const VertexBake bake = bakeVertices(tracer, settings, {});
		CHECK(bake.visibility.size() <= std::max(most, level.positions.size()));
		CHECK(bake.capped);
		CHECK(bake.above > 0);
	}
}
