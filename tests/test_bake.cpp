// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility at vertices compared with closed forms and with rays.
#include "bake_levels.h"
#include "testing.h"

#include "bake/probes.h"
#include "bake/surface_samples.h"
#include "core/json_reader.h"
#include "scene/gbuffer.h"
#include "scene/level_glb.h"
#include "scene/load.h"

#include <nlohmann/json.hpp>

namespace
{

double rmseOf(const Level& level, BakeSettings settings, BakeFit fit)
{
	settings.fit = fit;
	const Tracer tracer(level, {});
	return checkBake(tracer, level, bakeVertices(tracer, settings, {}), settings, 1000, {}).rmse;
}

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
	return sumOver(areasOf(level));
}

} // namespace

TEST_CASE("bake: a plane reads 1, by either fit", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-1.0, 0.0, -1.0}, 2.0, 4);
	const Tracer tracer(level, {});
	const BakeFit fit = GENERATE(BakeFit::surface, BakeFit::points);
	BakeSettings settings = within(10.0);
	settings.fit = fit;
	const VertexBake bake = bakeVertices(tracer, settings, {});
	REQUIRE(bake.visibility.size() == level.positions.size());
	CHECK(std::all_of(bake.visibility.begin(), bake.visibility.end(), [](float v) { return v > 0.9999F; }));
	CHECK(bake.buried == 0);
	CHECK(checkBake(tracer, level, bake, settings, 100, {}).rmse < 1e-4);
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
		return fitValues(level, areas, unknowns, samples, BakeSettings()).values;
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
	const int rays = GENERATE(1, 33);
	BakeSettings settings = within(1.0);
	settings.rays = rays;
	const BakeFit fit = GENERATE(BakeFit::surface, BakeFit::points);
	settings.fit = fit;
	const VertexBake bake = bakeVertices(tracer, settings, {});
	REQUIRE(bake.visibility.size() == 7);
	CHECK(std::all_of(bake.visibility.begin(), bake.visibility.end(), [](float v) { return v >= 0.0F && v <= 1.0F; }));
	CHECK(std::isfinite(bake.standard_error));
	CHECK(std::isfinite(checkBake(tracer, level, bake, settings, 10, {}).rmse));
}

TEST_CASE("bake: only chosen parts darken, and only chosen parts get values", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-1.0, 0.0, -1.0}, 2.0, 4);
	const std::size_t vertices = level.positions.size();
	const std::size_t triangles = level.triangles.size();
	addBox(level, {-0.5, 0.2, -0.5}, {0.5, 1.2, 0.5});
	level.meshes = {{"floor", 0, triangles}, {"box", triangles, 12}};
	const std::vector<uint8_t> floor = chosenTriangles(level, std::vector<std::string>{"floor"}, "receivers");
	const LevelPart part = partOf(level, floor, 1);
	REQUIRE(part.level.positions.size() == vertices);
	BakeSettings settings = within(10.0);
	settings.receivers = &part.level;
	const Tracer all(level, {});
	const Tracer alone(level, {}, nullptr, floor);
	for (const BakeFit fit : {BakeFit::surface, BakeFit::points})
	{
		settings.fit = fit;
		const VertexBake open = bakeVertices(alone, settings, {});
		REQUIRE(open.visibility.size() == vertices);
		CHECK(std::all_of(open.visibility.begin(), open.visibility.end(), [](float v) { return v > 0.9999F; }));
		const VertexBake dark = bakeVertices(all, settings, {2, {}, nullptr});
		REQUIRE(dark.visibility.size() == vertices);
		CHECK(*std::min_element(dark.visibility.begin(), dark.visibility.end()) < 0.5F);
		CHECK(dark.visibility == bakeVertices(all, settings, {1, {}, nullptr}).visibility);
	}
}

TEST_CASE("bake: a coarse level has the values of the detailed one that it stands for", "[bake]")
{
	// Steps of 0.2 m on a floor beside a wall, and a floor for all of them.
	Level detailed = emptyLevel();
	addFloor(detailed, {-2.0, 0.0, -2.0}, 4.0, 8);
	addBox(detailed, {-2.0, 0.0, -2.0}, {-1.0, 0.2, 2.0});
	addBox(detailed, {1.5, 0.0, -2.0}, {1.7, 2.0, 2.0});
	Level coarse = emptyLevel();
	addFloor(coarse, {-1.9, 0.1, -1.9}, 3.3, 34);
	const Tracer tracer(detailed, {});
	const auto valuesOf = [&](double cage_m, BakeFit fit)
	{
		BakeSettings settings = within(1.5);
		settings.fit = fit;
		settings.receivers = &coarse;
		settings.cage_m = cage_m;
		const VertexBake bake = bakeVertices(tracer, settings, {});
		const BakeCheck check = checkBake(tracer, coarse, bake, settings, 2000, {});
		CHECK((check.missed == 0) == (cage_m > 0.1));
		return bake.visibility;
	};
	for (const BakeFit fit : {BakeFit::surface, BakeFit::points})
	{
		const std::vector<float> values = valuesOf(0.15, fit);
		CHECK(valuesOf(0.05, fit) != values); // meets neither the steps nor the floor
		ReferenceSettings rays = raysOf(within(1.5), 1024, 7);
		for (std::size_t v = 0; v < values.size(); v += 7)
		{
			const glm::dvec3 at = coarse.positions[v];
			if (std::fabs(at.x + 1.0) < 0.11)
			{
				continue; // the edge of the steps lies within a triangle
			}
			const glm::dvec3 place(at.x, at.x < -1.0 ? 0.2 : 0.0, at.z);
			const double known =
				referenceAtPoints(tracer, std::vector<ReferencePoint>{{place, {0.0, 1.0, 0.0}, 0.0}}, rays, {})[0].visibility;
			CAPTURE(at.x, at.z, known, values[v]);
			CHECK(std::fabs(static_cast<double>(values[v]) - known) < 0.06);
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
	const BakeFit fit = GENERATE(BakeFit::surface, BakeFit::points);
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

TEST_CASE("bake: what is baked beside something is the difference to it", "[bake]")
{
	const LoadedLevel loaded = loadLevel("builtin:cornell", {}, {});
	const Tracer tracer(loaded.level, {});
	BakeSettings settings = within(0.5);
	const VertexBake plain = bakeVertices(tracer, settings, {});
	const BakeCheck alone = checkBake(tracer, loaded.level, plain, settings, 500, {});
	CHECK(alone.rmse_without == 0.0);
	settings.base = [](std::span<const ReferencePoint> points)
	{
		return std::vector<double>(points.size(), 0.75);
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

TEST_CASE("bake: what it is baked beside is evaluated where it varies", "[bake]")
{
	const LoadedLevel loaded = loadLevel("builtin:heightfield:20000", {}, {});
	const Tracer tracer(loaded.level, {});
	const Bounds box = boundsOf(loaded.level);
	BakeSettings settings = within(0.2 * glm::length(box.most - box.least));
	const VertexBake plain = bakeVertices(tracer, settings, {});
	std::size_t asked = 0;
	const double middle = 0.5 * (box.least.x + box.most.x);
	settings.base = [&](std::span<const ReferencePoint> points)
	{
		asked += points.size();
		return mapped(points, [&](const ReferencePoint& point) { return point.position.x < middle ? 0.25 : 0.75; });
	};
	const VertexBake difference = bakeVertices(tracer, settings, {});
	CHECK(2 * asked < difference.points);
	for (std::size_t v = 0; v < plain.visibility.size(); ++v)
	{
		const double from_step = std::fabs(loaded.level.positions[v].x - middle);
		const float base = loaded.level.positions[v].x < middle ? 0.25F : 0.75F;
		CHECK((from_step < 0.15 * settings.radius_m || std::fabs(plain.visibility[v] - (base + difference.visibility[v])) < 0.15F));
	}
}

// Baked values in files and in pictures of a view.

TEST_CASE("bake: values come back from the file, as an attribute and as a colour", "[bake][emit]")
{
	Level level = emptyLevel();
	addQuad(level, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0});
	const std::vector<float> values{0.0F, 0.25F, 0.5F, 1.0F};
	const std::string bytes = bakedGlb(level, "nook test", {values, true, {}, {}, {}, {}, {}});
	uint32_t text = 0;
	std::memcpy(&text, bytes.data() + 12, sizeof text);
	const nlohmann::json root = parseJson(bytes.substr(20, text), "a.glb");
	const nlohmann::json& attributes = root["meshes"][0]["primitives"][0]["attributes"];
	const auto at = [&](const char* name)
	{
		const nlohmann::json& accessor = root["accessors"][attributes[name].get<std::size_t>()];
		CHECK(accessor["count"] == 4);
		const nlohmann::json& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
		return bytes.data() + 20 + text + 8 + view["byteOffset"].get<std::size_t>() + accessor["byteOffset"].get<std::size_t>();
	};
	// In order of first use: 0 1 2 3.
	CHECK(std::memcmp(at("_VISIBILITY"), values.data(), 16) == 0);
	const unsigned char grey[] = {0, 0, 0, 255, 64, 64, 64, 255, 128, 128, 128, 255, 255, 255, 255, 255};
	CHECK(std::memcmp(at("COLOR_0"), grey, sizeof grey) == 0);
	CHECK(levelGlb(level, "nook test").find("_VISIBILITY") == std::string::npos);
}

TEST_CASE("bake: a sheet with two sides has a value for each", "[bake][emit]")
{
	Level level = emptyLevel();
	addFloor(level, {-3.0, 0.0, -3.0}, 6.0, 12);
	const auto sheet = static_cast<uint32_t>(level.positions.size());
	addFloor(level, {-0.5, 0.01, -0.5}, 1.0, 2); // just above the other: its lower side is closed
	Material two_sided = level.material_list[0];
	two_sided.two_sided = true;
	level.material_list.push_back(two_sided);
	for (std::size_t t = 288; t < level.triangles.size(); ++t)
	{
		level.materials[t] = 1;
	}
	const Tracer tracer(level, {});
	BakeSettings settings = within(0.05); // lets about 0.04 of the light in below
	settings.bent = true;
	const VertexBake bake = bakeVertices(tracer, settings, {});
	REQUIRE(bake.back.size() == level.positions.size());
	const uint32_t middle = sheet + 4;
	CHECK(bake.visibility[middle] > 0.99F);
	CHECK(bake.back[middle] < 0.2F);
	CHECK(bake.bent[middle].y > 0.99F);
	CHECK(bake.bent_back[middle].y < 0.0F);
	CHECK(bake.back[0] == bake.visibility[0]);
	const double separate = checkBake(tracer, level, bake, settings, 1000, {}).rmse;
	settings.sides = BakeSides::mean;
	const VertexBake mean = bakeVertices(tracer, settings, {});
	CHECK(mean.back.empty());
	CHECK(std::fabs(mean.visibility[middle] - 0.52F) < 0.05F);
	CHECK(separate < 0.5 * checkBake(tracer, level, mean, settings, 1000, {}).rmse);

	const std::string bytes = bakedGlb(level, "nook test", {bake.visibility, true, {}, {}, bake.back, bake.bent, bake.bent_back});
	uint32_t text = 0;
	std::memcpy(&text, bytes.data() + 12, sizeof text);
	const nlohmann::json root = parseJson(bytes.substr(20, text), "a.glb");
	const nlohmann::json& primitives = root["meshes"][0]["primitives"];
	CHECK_FALSE(primitives[0]["attributes"].contains("_VISIBILITY_BACK"));
	CHECK(primitives[0]["attributes"].contains("_BENT_NORMAL"));
	CHECK(primitives[1]["attributes"].contains("_VISIBILITY_BACK"));
	CHECK(primitives[1]["attributes"].contains("_BENT_NORMAL_BACK"));
	CHECK(root["accessors"][primitives[1]["attributes"]["_BENT_NORMAL_BACK"].get<std::size_t>()]["type"] == "VEC3");
}

TEST_CASE("bake: values are read again and drawn where the view shows what was baked", "[bake]")
{
	TemporaryFolder folder;
	Level level = emptyLevel();
	addFloor(level, {-2.0, 0.0, -2.0}, 4.0, 8);
	const std::vector<float> values =
		mapped(level.positions, [](const glm::dvec3 position) { return static_cast<float>(0.5 + 0.2 * position.x); });
	const std::string path = folder / "a.glb";
	writeFile(path, bakedGlb(level, "nook test", {values, false, {}, {}, {}, {}, {}}));
	const LoadedLevel loaded = loadLevel(path, {}, {});
	const BakedValues baked = loadBakedValues(path, loaded.level, {});
	CHECK(baked.kind == BakedKind::visibility);
	REQUIRE(baked.front.size() == loaded.level.positions.size());
	CHECK(baked.back == baked.front);

	Level more = level;
	addBox(more, {0.5, 0.0, -0.5}, {1.0, 0.5, 0.5});
	LevelCamera camera;
	camera.world_from_camera = worldFromCamera({0.0, 3.0, 3.0}, {0.0, 0.0, 0.0});
	const View view = viewOf(camera, 32, 24);
	const Tracer tracer(loaded.level, {});
	const Tracer with(more, {});
	const GBuffer gbuffer = castGBuffer(with, view, 32, 24, NormalKind::geometric, {});
	const BakedPicture picture = bakedPicture(tracer, baked, gbuffer, {2, {}});
	const GBuffer fixed = castGBuffer(tracer, view, 32, 24, NormalKind::geometric, {});
	CHECK(picture.fixed.depth == fixed.depth);
	const Projector projector(view.projection, 32, 24);
	const glm::dmat4 world_from_camera = glm::inverse(view.camera_from_world);
	std::size_t shown = 0;
	for (int i = 0; i < 32 * 24; ++i)
	{
		const auto pixel = static_cast<std::size_t>(i);
		const bool same = gbuffer.depth[pixel] == fixed.depth[pixel] && std::isfinite(gbuffer.depth[pixel]);
		CHECK(picture.is_baked[pixel] == (same ? 1 : 0));
		if (same)
		{
			const glm::dvec3 at(world_from_camera * glm::dvec4(positionOf(gbuffer, projector, i % 32, i / 32), 1.0));
			CHECK(std::fabs(static_cast<double>(picture.values[pixel]) - (0.5 + 0.2 * at.x)) < 1e-4);
			shown += 1;
		}
	}
	CHECK(shown > 100);
	CHECK(shown < 32 * 24 - 20);
	CHECK_THROWS_AS(loadBakedValues("builtin:cornell", loaded.level, {}), Error);
}

// Probes compared with closed forms and with rays.

TEST_CASE("bake: probes over a plane read the half of the sphere that is open, as the normal turns", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-50.0, 0.0, -50.0}, 100.0, 2);
	addQuad(level, {-0.1, 2.0, 0.0}, {0.1, 0.0, 0.0}, {0.0, 0.1, 0.0}); // makes the grid extend above
	const Tracer tracer(level, {});
	BakeSettings settings = within(std::numeric_limits<double>::infinity());
	settings.rays = 1536;
	const ProbeGrid grid = bakeProbes(tracer, 1.0, settings, {});
	// Occlusion of a plane from above, by the normal's angle to it: (1 − cos)/2.
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {0.0, 1.0, 0.0}) - 1.0) < 0.02);
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {1.0, 0.0, 0.0}) - 0.5) < 0.02);
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {0.6, -0.8, 0.0}) - 0.1) < 0.02);
	CHECK(std::fabs(visibilityAt(grid, {0.3, 1.2, 0.1}, {0.0, -1.0, 0.0})) < 0.02);
}

TEST_CASE("bake: probes agree with rays in the open, and those inside matter do not count", "[bake]")
{
	Level level = emptyLevel();
	addBox(level, {-3.0, -1.0, -3.0}, {3.0, 0.0, 3.0});
	addBox(level, {-1.0, 0.0, -1.0}, {1.0, 2.0, 1.0});
	const Tracer tracer(level, {});
	BakeSettings settings = within(1.0);
	settings.rays = 600;
	const ProbeGrid grid = bakeProbes(tracer, 0.5, settings, {1, {}});
	CHECK(grid.count == glm::ivec3(12, 6, 12));
	CHECK(grid.buried == 12 * 2 * 12 + 4 * 4 * 4);
	const BakeCheck check = checkProbes(tracer, grid, settings, 1000, {});
	CAPTURE(check.rmse, check.bias);
	CHECK(check.rmse < 0.1);
	CHECK(std::fabs(check.bias) < 0.03);
	CHECK(bakeProbes(tracer, 0.5, settings, {2, {}}).texels == grid.texels);
	// Next to the box, where half of the surrounding probes are inside it.
	CHECK(std::fabs(visibilityAt(grid, {1.05, 1.0, 0.0}, {1.0, 0.0, 0.0}) - 1.0) < 0.15);
	// In the middle of matter nothing is known.
	CHECK(visibilityAt(grid, {0.0, 1.0, 0.0}, {0.0, 1.0, 0.0}) == 1.0);
	CHECK_THROWS_AS(bakeProbes(tracer, 0.001, settings, {}), Error);
	CHECK_THROWS_AS(bakeProbes(tracer, 0.01, settings, {}), Error);
	CHECK(bakeProbes(tracer, 1e6, settings, {}).texels.size() == 1);
}

// Triangles are split until the vertex bake meets the requested error.

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
