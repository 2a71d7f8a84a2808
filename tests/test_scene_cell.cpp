// SPDX-License-Identifier: GPL-3.0-or-later
// A cell of a level gives the same results as the whole level inside it.
#include "small_levels.h"
#include "temporary_folder.h"

#include "bake/bake.h"
#include "core/file.h"
#include "core/random.h"
#include "scene/level.h"
#include "scene/level_glb.h"
#include "scene/load.h"
#include "volume/build.h"
#include "volume/evaluate.h"
#include "volume/occluders.h"

#include <catch2/catch.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <map>

using namespace nook;

namespace
{

Level again(const Level& level, const GlbBake& bake = {})
{
	const TemporaryFolder folder;
	writeFile(folder / "level.glb", levelGlb(level, "nook test", bake));
	return loadLevel(folder / "level.glb", {}, {}).level;
}

// The level from its own file, and a cell of it through another file.
struct Parts
{
	Level whole;
	CellSettings settings;
	Level cell;

	Parts(const char* name, const Bounds& box, double around_m)
		: whole(again(loadLevel(name, {}, {}).level)), settings{box, around_m}
	{
		cell = again(cutCell(whole, settings, closedTriangles(whole, {}), 1));
	}
};

struct Place
{
	glm::dvec3 position;
	glm::dvec3 normal;
};

// Random positions in the box with random normals.
std::vector<Place> placesIn(const Bounds& box, std::size_t count)
{
	Random random(7);
	std::vector<Place> places;
	while (places.size() < count)
	{
		const glm::dvec3 share(random.uniform(), random.uniform(), random.uniform());
		const glm::dvec3 normal = 2.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0;
		if (glm::dot(normal, normal) > 1e-4)
		{
			places.push_back({box.least + share * (box.most - box.least), glm::normalize(normal)});
		}
	}
	return places;
}

std::size_t ownOf(const Level& cell)
{
	std::size_t count = 0;
	for (const Mesh& mesh : cell.meshes)
	{
		count += mesh.around ? 0 : mesh.triangle_count;
	}
	return count;
}

double greatestDifference(const Parts& parts, const VolumeSettings& settings)
{
	const BuiltVolumes whole = buildVolumes(parts.whole, settings, {});
	const BuiltVolumes cell = buildVolumes(parts.cell, settings, {});
	CHECK(cell.set.occluders.polygons.size() < whole.set.occluders.polygons.size());
	const VolumeEvaluator all(whole.set, {});
	const VolumeEvaluator part(cell.set, {});
	double greatest = 0.0;
	double sum = 0.0;
	for (const Place& place : placesIn(parts.settings.box, 3000))
	{
		const double expected = all.occlusion(place.position, place.normal);
		sum += expected;
		greatest = std::max(greatest, std::fabs(part.occlusion(place.position, place.normal) - expected));
	}
	CHECK(sum > 30.0);
	return greatest;
}

} // namespace

TEST_CASE("scene: each triangle is in one cell of a grid, and comes back from its file", "[scene]")
{
	const Level level = loadLevel("builtin:suburb", {}, {}).level;
	const std::vector<uint8_t> closed = closedTriangles(level, {});
	const std::vector<Bounds> boxes = gridOf(level, {3, 1, 2});
	REQUIRE(boxes.size() == 6);
	std::size_t own = 0;
	std::size_t cameras = 0;
	for (const Bounds& box : boxes)
	{
		const Level cell = cutCell(level, {box, 0.5}, closed, 1);
		own += ownOf(cell);
		cameras += cell.cameras.size();
		if (cell.triangles.empty())
		{
			continue;
		}
		const Level read = again(cell);
		CHECK(read.triangles.size() == cell.triangles.size());
		CHECK(ownOf(read) == ownOf(cell));
		CHECK(std::count_if(read.meshes.begin(), read.meshes.end(), [](const Mesh& mesh) { return mesh.closed; }) > 0);
		CHECK(read.masks.size() <= level.masks.size());
	}
	CHECK(own == level.triangles.size());
	CHECK(cameras <= level.cameras.size());
	CHECK(cutCell(level, {{glm::dvec3(1e4), glm::dvec3(2e4)}, 1.0}, closed, 1).triangles.empty());
}

TEST_CASE("scene: rays within a cell find what they find in the level", "[scene]")
{
	const Parts parts("builtin:suburb", {{-6.0, 0.0, -6.0}, {6.0, 4.0, 6.0}}, 1.5);
	REQUIRE(parts.cell.triangles.size() < parts.whole.triangles.size());
	const Tracer whole(parts.whole, {});
	const Tracer cell(parts.cell, {});
	const std::vector<Place> places = placesIn(parts.settings.box, 2000);
	std::vector<float> x;
	std::vector<float> y;
	std::vector<float> z;
	for (std::size_t i = 0; i < 64; ++i)
	{
		x.push_back(static_cast<float>(places[i].normal.x));
		y.push_back(static_cast<float>(places[i].normal.y));
		z.push_back(static_cast<float>(places[i].normal.z));
	}
	std::vector<float> expected(x.size());
	std::vector<float> found(x.size());
	std::size_t different = 0;
	std::size_t hits = 0;
	for (const Place& place : places)
	{
		whole.distances(place.position, {x, y, z}, 1.5F, expected);
		cell.distances(place.position, {x, y, z}, 1.5F, found);
		different += expected == found ? 0U : 1U;
		hits += static_cast<std::size_t>(std::count_if(found.begin(), found.end(), [](float t) { return std::isfinite(t); }));
	}
	CHECK(different == 0);
	CHECK(hits > 1000);
}

TEST_CASE("volume: volumes of a cell are those of the level there, closed surfaces that are cut included", "[volume]")
{
	VolumeSettings settings;
	settings.distance_m = 1.0;
	settings.drop.no_receiver = false;
	settings.drop.sides = false;
	settings.drop.inside = false;
	// Corners of volumes extend by twice the distance. Polygons are cut at the command's own length, not one chosen for the level.
	const Parts suburb("builtin:suburb", {{-6.0, 0.0, -6.0}, {6.0, 4.0, 6.0}}, 2.0);
	settings.occluders.extent_always = true;
	CHECK(greatestDifference(suburb, settings) < 1e-4);
	settings.occluders.merge = false;
	CHECK(greatestDifference(suburb, settings) < 1e-6);
	settings.occluders.merge = true;
	const Parts cave("builtin:cave:20000", {{-8.0, -20.0, -8.0}, {8.0, 20.0, 8.0}}, 1.0);
	CHECK(greatestDifference(cave, settings) < 1e-4);
	Level open = cave.cell;
	for (Mesh& mesh : open.meshes)
	{
		mesh.closed = false;
	}
	Parts unmarked = cave;
	unmarked.cell = open;
	CHECK(greatestDifference(unmarked, settings) > 0.1); // its backs darken too
}

TEST_CASE("bake: a cell's own vertices get the level's values, and they alone are written", "[bake]")
{
	const Parts parts("builtin:cave:5000", {{-10.0, -20.0, -10.0}, {10.0, 20.0, 10.0}}, 2.0);
	BakeSettings settings;
	settings.radius_m = 2.0;
	const Tracer whole(parts.whole, {});
	const Tracer cell(parts.cell, {});
	const VertexBake all = bakeVertices(whole, settings, {});
	const VertexBake part = bakeVertices(cell, settings, {});
	std::map<std::array<double, 3>, float> expected;
	for (std::size_t i = 0; i < parts.whole.positions.size(); ++i)
	{
		const glm::dvec3 p = parts.whole.positions[i];
		expected[{p.x, p.y, p.z}] = all.visibility[i];
	}
	double squares = 0.0;
	std::size_t own = 0;
	for (const Mesh& mesh : parts.cell.meshes)
	{
		for (std::size_t t = mesh.first_triangle; !mesh.around && t < mesh.first_triangle + mesh.triangle_count; ++t)
		{
			const uint32_t v = parts.cell.triangles[t].x;
			const glm::dvec3 p = parts.cell.positions[v];
			const double difference = static_cast<double>(part.visibility[v] - expected.at({p.x, p.y, p.z}));
			squares += difference * difference;
			own += 1;
		}
	}
	REQUIRE(own > 300);
	CHECK(std::sqrt(squares / static_cast<double>(own)) < 2.0 * (all.standard_error + part.standard_error));
	CHECK(again(parts.cell, {part.visibility, false}).triangles.size() == own);
}
