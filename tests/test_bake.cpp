// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility at vertices compared with closed forms and with rays.
#include "bake_levels.h"

#include "bake/bake.h"
#include "bake/subdivide.h"
#include "bake/surface_samples.h"
#include "scene/load.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace nook;
using namespace nook::test;

namespace
{

double rmseOf(const Level& level, BakeSettings settings, BakeFit fit)
{
	settings.fit = fit;
	const Tracer tracer(level, {});
	return checkBake(tracer, level, bakeVertices(tracer, settings, {}), settings, 1000, {}).rmse;
}

} // namespace

TEST_CASE("bake: a plane reads 1, by either fit", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-1.0, 0.0, -1.0}, 2.0, 4);
	const Tracer tracer(level, {});
	for (const BakeFit fit : {BakeFit::surface, BakeFit::points})
	{
		BakeSettings settings = within(10.0);
		settings.fit = fit;
		const VertexBake bake = bakeVertices(tracer, settings, {});
		REQUIRE(bake.visibility.size() == level.positions.size());
		CHECK(std::all_of(bake.visibility.begin(), bake.visibility.end(), [](float v) { return v > 0.9999F; }));
		CHECK(bake.buried == 0);
		CHECK(checkBake(tracer, level, bake, settings, 100, {}).rmse < 1e-4);
	}
}

TEST_CASE("bake: beside a wall without end a floor reads 1/2, as far as the edge that they share", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {0.0, 0.0, -0.5}, 1.0, 3);
	const std::size_t floor = level.positions.size();
	addQuad(level, {0.0, 0.0, 1e4}, {0.0, 0.0, -2e4}, {0.0, 1e4, 0.0}); // faces +x
	const Tracer tracer(level, {});
	BakeSettings settings = within(std::numeric_limits<double>::infinity());
	settings.rays = 1024;
	const VertexBake bake = bakeVertices(tracer, settings, {});
	for (std::size_t v = 0; v < floor; ++v)
	{
		CAPTURE(v, bake.visibility[v]);
		CHECK(std::fabs(bake.visibility[v] - 0.5F) < 0.02F);
	}
	CHECK(bake.standard_error > 0.0);
	CHECK(bake.standard_error < 0.02);
}

TEST_CASE("bake: the fit finds a linear function again, and keeps to values from 0 to 1", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {0.0, 0.0, 0.0}, 1.0, 5);
	const std::vector<double> areas = areasOf(level);
	const Unknowns unknowns = unknownsOf(level);
	std::vector<SurfaceSample> samples = SamplePlaces(level, samplesOfTriangles(areas, 2000), 1).all();
	const auto fitted = [&](double slope)
	{
		for (SurfaceSample& sample : samples)
		{
			const glm::uvec3 t = level.triangles[sample.triangle];
			const auto b = static_cast<double>(sample.b);
			const auto c = static_cast<double>(sample.c);
			const double x = (1.0 - b - c) * level.positions[t.x].x + b * level.positions[t.y].x + c * level.positions[t.z].x;
			sample.visibility = static_cast<float>(std::clamp(0.2 + slope * x, 0.0, 1.0));
		}
		return fitValues(level, areas, unknowns, samples, 1).values;
	};
	const std::vector<float> linear = fitted(0.5);
	const std::vector<float> steep = fitted(4.0); // 1 from x = 0.2 on: without bounds the values beyond would overshoot
	for (std::size_t v = 0; v < level.positions.size(); ++v)
	{
		const float x = static_cast<float>(level.positions[v].x);
		CHECK(std::fabs(linear[unknowns.of_vertex[v]] - (0.2F + 0.5F * x)) < 0.01F);
		CHECK(steep[unknowns.of_vertex[v]] >= 0.0F);
		CHECK(steep[unknowns.of_vertex[v]] <= 1.0F);
	}
}

TEST_CASE("bake: vertices of one place share a value where their normals agree", "[bake]")
{
	Level level = emptyLevel();
	addQuad(level, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0});
	addQuad(level, {1.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0}); // goes on
	addQuad(level, {0.0, 0.0, 1.0}, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}); // stands up
	const Unknowns unknowns = unknownsOf(level);
	CHECK(unknowns.count == 10);
	CHECK(unknowns.of_vertex[1] == unknowns.of_vertex[4]);
	CHECK(unknowns.of_vertex[0] != unknowns.of_vertex[8]);
	CHECK(unknowns.place_of_vertex[0] == unknowns.place_of_vertex[8]);
}

TEST_CASE("bake: what lies under a box does not count, and edges of contact do not darken the floor", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-2.0, 0.0, -2.0}, 4.0, 3); // vertices at ±2/3 are partly under the box
	addBox(level, {-1.0, 0.0, -1.0}, {1.0, 0.5, 1.0});
	const Tracer tracer(level, {});
	CHECK(isBuried(tracer, {0.1, 1e-5, 0.2}, {0.0, 1.0, 0.0}));
	CHECK_FALSE(isBuried(tracer, {1.5, 1e-5, 0.2}, {0.0, 1.0, 0.0}));
	CHECK_FALSE(isBuried(tracer, {1.0 + 1e-5, 0.2, 0.2}, {1.0, 0.0, 0.0}));
	const VertexBake bake = bakeVertices(tracer, within(0.5), {});
	CHECK(bake.buried > 0);
	CHECK(bake.visibility[0] > 0.9F); // a corner of the floor
	CHECK(rmseOf(level, within(0.5), BakeFit::surface) < 0.6 * rmseOf(level, within(0.5), BakeFit::points));
}

TEST_CASE("bake: a gap that no ray gets out of does not darken the floor around it", "[bake]")
{
	// A sheet a millimetre above the middle of a floor of nine squares, from ±1 to beyond their vertices at ±2/3: the open floor
	// sees the sky, as the sheet has no height.
	Level level = emptyLevel();
	addFloor(level, {-2.0, 0.0, -2.0}, 4.0, 3);
	addQuad(level, {-1.0, 2e-3, 1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, -2.0});
	addQuad(level, {-1.0, 1e-3, -1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, 2.0}); // its lower side is a front, so nothing is inside matter
	const Tracer tracer(level, {});
	const BakeSettings settings = within(0.5);
	const VertexBake bake = bakeVertices(tracer, settings, {});
	CHECK(bake.buried == 0);
	CHECK(bake.shut > 20);
	for (std::size_t v = 0; v < 16; ++v)
	{
		CAPTURE(v, bake.visibility[v]);
		CHECK(bake.visibility[v] > 0.75F);
	}
	const BakeCheck check = checkBake(tracer, level, bake, settings, 1000, {});
	CHECK(check.shut > 100);
	CHECK(check.rmse_seen < 0.1);
	CHECK(check.rmse > 0.2); // values in the gap are too bright, which is reported
}

TEST_CASE("bake: ground under a low body stays dark where its triangles are small enough to show it", "[bake]")
{
	// Like under a car: 10 cm high with rays of 1.5 m, so that hardly any escapes. Triangles of 20 cm.
	Level level = emptyLevel();
	addFloor(level, {-4.0, 0.0, -4.0}, 8.0, 40);
	addBox(level, {-1.0, 0.1, -2.0}, {1.0, 1.2, 2.0});
	const Tracer tracer(level, {});
	const BakeSettings settings = within(1.5);
	const VertexBake bake = bakeVertices(tracer, settings, {});
	CHECK(bake.shut > 100);
	const auto at = [&bake](int x, int z)
	{
		return bake.visibility[static_cast<std::size_t>(z * 41 + x)];
	};
	CAPTURE(at(20, 20), at(20, 14), at(5, 5));
	CHECK(at(20, 20) < 0.06F); // low weights are noisy
	CHECK(at(20, 14) < 0.05F); // 80 cm from the edge
	CHECK(at(5, 5) > 0.95F);
	CHECK(checkBake(tracer, level, bake, settings, 2000, {}).rmse < 0.03);
}

TEST_CASE("bake: triangles of a sheet that face against their neighbours are turned, and only those", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-2.0, 0.0, -2.0}, 4.0, 4);
	addBox(level, {-3.0, -3.0, -3.0}, {3.0, -0.01, 3.0}); // closes the floor's lower side
	const std::vector<glm::uvec3> good = level.triangles;
	std::swap(level.triangles[13].y, level.triangles[13].z);
	const std::vector<glm::uvec3> reversed = level.triangles;
	CHECK(alignSheets(level, 1) == 0); // its back is not drawn
	CHECK(level.triangles == reversed);
	level.material_list[0].two_sided = true;
	Level turned = level;
	CHECK(alignSheets(turned, 2) == 1);
	CHECK(turned.triangles[13] == glm::uvec3(good[13].x, good[13].y, good[13].z));
	CHECK(alignSheets(turned, 2) == 0);
	CHECK(rmseOf(turned, within(0.5), BakeFit::surface) < 0.5 * rmseOf(level, within(0.5), BakeFit::surface));
}

TEST_CASE("bake: the fit is nearer to rays than values at the vertices, with as many bytes", "[bake]")
{
	const LoadedLevel loaded = loadLevel("builtin:cornell", {}, {});
	CHECK(rmseOf(loaded.level, within(0.5), BakeFit::surface) < 0.6 * rmseOf(loaded.level, within(0.5), BakeFit::points));
}

TEST_CASE("bake: one thread and two give the same values; another seed gives others", "[bake]")
{
	const LoadedLevel loaded = loadLevel("builtin:cornell", {}, {});
	const Tracer tracer(loaded.level, {});
	BakeSettings settings = within(0.5);
	const VertexBake one = bakeVertices(tracer, settings, {1, {}});
	const VertexBake two = bakeVertices(tracer, settings, {2, {}});
	CHECK(one.visibility == two.visibility);
	CHECK(one.standard_error == two.standard_error);
	settings.seed = 2;
	CHECK(bakeVertices(tracer, settings, {2, {}}).visibility != one.visibility);
}

TEST_CASE("bake: the stated standard error is what other seeds differ by", "[bake]")
{
	// A box in the open: the variation over a triangle adds to the rays' noise, so the difference may be larger, but not by much.
	const LoadedLevel loaded = loadLevel("builtin:cornell", {}, {});
	const Tracer tracer(loaded.level, {});
	BakeSettings settings = within(0.5);
	settings.fit = BakeFit::points;
	const VertexBake first = bakeVertices(tracer, settings, {});
	settings.seed = 7;
	const VertexBake second = bakeVertices(tracer, settings, {});
	double squares = 0.0;
	for (std::size_t v = 0; v < first.visibility.size(); ++v)
	{
		squares += std::pow(static_cast<double>(first.visibility[v] - second.visibility[v]), 2.0);
	}
	const double found = std::sqrt(squares / static_cast<double>(first.visibility.size()));
	CHECK(found < 2.0 * std::sqrt(2.0) * first.standard_error);
}

TEST_CASE("bake: odd levels: one triangle, unused vertices, slivers, one ray", "[bake]")
{
	Level level = emptyLevel();
	addVertex(level, {9.0, 9.0, 9.0});
	addTriangle(level, addVertex(level, {0.0, 0.0, 0.0}), addVertex(level, {1.0, 0.0, 0.0}), addVertex(level, {0.0, 1e-12, 0.0}));
	addTriangle(level, addVertex(level, {0.0, 0.0, 1e6}), addVertex(level, {1e6, 0.0, 0.0}), addVertex(level, {0.0, 1e6, 0.0}));
	const Tracer tracer(level, {});
	for (const int rays : {1, 33})
	{
		BakeSettings settings = within(1.0);
		settings.rays = rays;
		for (const BakeFit fit : {BakeFit::surface, BakeFit::points})
		{
			settings.fit = fit;
			const VertexBake bake = bakeVertices(tracer, settings, {});
			REQUIRE(bake.visibility.size() == 7);
			CHECK(std::all_of(bake.visibility.begin(), bake.visibility.end(), [](float v) { return v >= 0.0F && v <= 1.0F; }));
			CHECK(std::isfinite(bake.standard_error));
			CHECK(std::isfinite(checkBake(tracer, level, bake, settings, 10, {}).rmse));
		}
	}
}

TEST_CASE("bake: bent normals beside a wall without end lean away from it", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {0.0, 0.0, -0.5}, 1.0, 3);
	const std::size_t floor = level.positions.size();
	addQuad(level, {0.0, 0.0, 1e4}, {0.0, 0.0, -2e4}, {0.0, 1e4, 0.0}); // faces +x
	const Tracer tracer(level, {});
	BakeSettings settings = within(std::numeric_limits<double>::infinity());
	settings.rays = 1024;
	settings.bent = true;
	for (const BakeFit fit : {BakeFit::surface, BakeFit::points})
	{
		settings.fit = fit;
		const VertexBake bake = bakeVertices(tracer, settings, {});
		// Over the quarter sphere: (1/π) ∫ ω (n·ω) dω = (2/(3π), 1/3, 0).
		const glm::vec3 expected = glm::normalize(glm::vec3(2.0F / (3.0F * 3.14159265F), 1.0F / 3.0F, 0.0F));
		for (std::size_t v = 0; v < floor; ++v)
		{
			CAPTURE(v, bake.bent[v].x, bake.bent[v].y);
			const bool within_wall = fit == BakeFit::points && level.positions[v].x == 0.0;
			CHECK((within_wall || glm::distance(bake.bent[v], expected) < 0.05F));
		}
		CHECK(checkBake(tracer, level, bake, settings, 100, {}).angle_rad < 0.1);
	}
}

TEST_CASE("bake: what is baked beside something is the difference to it", "[bake]")
{
	const LoadedLevel loaded = loadLevel("builtin:cornell", {}, {});
	const Tracer tracer(loaded.level, {});
	BakeSettings settings = within(0.5);
	const VertexBake plain = bakeVertices(tracer, settings, {});
	const BakeCheck alone = checkBake(tracer, loaded.level, plain, settings, 500, {});
	CHECK(alone.rmse_without == 0.0);
	settings.base = [](glm::dvec3, glm::dvec3)
	{
		return 0.75;
	};
	const VertexBake difference = bakeVertices(tracer, settings, {});
	for (std::size_t v = 0; v < plain.visibility.size(); ++v)
	{
		CHECK(std::fabs(plain.visibility[v] - (0.75F + difference.visibility[v])) < 0.3F); // bounds differ
	}
	const BakeCheck check = checkBake(tracer, loaded.level, difference, settings, 500, {});
	CHECK(check.rmse < 1.1 * alone.rmse);
	CHECK(check.rmse_without > 1.5 * check.rmse);
}
