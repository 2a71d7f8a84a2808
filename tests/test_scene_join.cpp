// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_files.h"
#include "small_levels.h"
#include "temporary_folder.h"

#include "scene/level_glb.h"
#include "scene/load_parts.h"

#include <catch2/catch.hpp>

using namespace nook;

TEST_CASE("scene: several levels are one, each where it is moved", "[scene]")
{
	const TemporaryFolder folder;
	writeFile(folder / "cube.obj", cubeObj());
	writeFile(folder / "cube.gltf", gltfText(cubeGltf()));
	const std::vector<PlacedLevel> places{{folder / "cube.obj", {}}, {folder / "cube.gltf", {3.0, 0.0, -1.0}}};
	const LoadedLevel loaded = loadLevels(places, {}, {});
	CHECK(loaded.level.name == "cube.obj and 1 more");
	CHECK(loaded.level.triangles.size() == 24);
	CHECK(loaded.level.meshes.size() == 2);
	CHECK(loaded.level.meshes[1].first_triangle == 12);
	CHECK(loaded.level.files == std::vector<std::string>{folder / "cube.obj", folder / "cube.gltf"});
	CHECK(volumeOf(loaded.level) == Approx(2.0));
	CHECK(boundsOf(loaded.level).least == glm::dvec3(0.0, 0.0, -1.0));
	CHECK(boundsOf(loaded.level).most == glm::dvec3(4.0, 1.0, 1.0));
	CHECK(loaded.diagnosis.findings.empty());

	// At the same place: the walls of the second level are duplicates.
	const std::vector<PlacedLevel> twice{{folder / "cube.obj", {1.0, 0.0, 0.0}}, {folder / "cube.obj", {1.0, 0.0, 0.0}}};
	const LoadedLevel once = loadLevels(twice, {}, {});
	CHECK(findingsOf(once.diagnosis) == "duplicate-faces 12 dropped, empty-meshes 1 dropped");
	CHECK(once.level.triangles.size() == 12);
	CHECK(once.level.files.size() == 1);
	CHECK(boundsOf(once.level).least.x == 1.0);
	LoadSettings strict;
	strict.strict = true;
	CHECK_THROWS_WITH(loadLevels(twice, strict, {}),
					  Catch::StartsWith("cube.obj and 1 more: mesh 'box', triangle 0: found duplicate-faces (12)"));
}

TEST_CASE("scene: levels that are joined keep masks, once each, and cameras with names of their own", "[scene]")
{
	const std::vector<PlacedLevel> alone{{"builtin:foliage", {}}};
	const std::vector<PlacedLevel> places{
		{"builtin:foliage", {}}, {"builtin:suburb", {50.0, 0.0, 0.0}}, {"builtin:foliage", {-60.0, 0.0, 0.0}}};
	const Level one = loadLevels(alone, {}, {}).level;
	const Level suburb = loadLevel("builtin:suburb", {}, {}).level;
	const Level all = loadLevels(places, {}, {}).level;
	REQUIRE(all.triangles.size() == 2 * one.triangles.size() + suburb.triangles.size());
	CHECK(all.masks.size() <= one.masks.size() + suburb.masks.size());
	CHECK(all.material_list.size() <= one.material_list.size() + suburb.material_list.size());
	CHECK(all.cameras.size() == 2 * one.cameras.size() + suburb.cameras.size());
	const std::size_t last = one.triangles.size() + suburb.triangles.size();
	std::size_t different = 0;
	for (std::size_t t = 0; t < one.triangles.size(); ++t)
	{
		const Material& a = one.material_list[one.materials[t]];
		const Material& b = all.material_list[all.materials[last + t]];
		const bool same_mask =
			(a.mask < 0) == (b.mask < 0) &&
			(a.mask < 0 || one.masks[static_cast<std::size_t>(a.mask)].alpha == all.masks[static_cast<std::size_t>(b.mask)].alpha);
		const glm::dvec3 moved = one.positions[one.triangles[t].x] + glm::dvec3(-60.0, 0.0, 0.0);
		different += a.name == b.name && same_mask && moved == all.positions[all.triangles[last + t].x] ? 0U : 1U;
	}
	CHECK(different == 0);
	const LevelCamera& camera = all.cameras.back();
	CHECK(camera.name == one.cameras.back().name + " 2");
	CHECK(camera.world_from_camera[3].x == one.cameras.back().world_from_camera[3].x - 60.0);
}
