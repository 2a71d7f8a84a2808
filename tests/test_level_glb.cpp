// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_files.h"
#include "small_levels.h"
#include "testing.h"

#include "scene/builtin.h"
#include "scene/level_glb.h"

namespace
{

LoadedLevel readAgain(const Level& level)
{
	const TemporaryFolder folder;
	const std::string path = folder / "level.glb";
	writeFile(path, levelGlb(level, "nook test"));
	return loadLevel(path, {}, {});
}

// Positions of corners are rounded to 32 bits; normals are normalised again, which may round them once more.
std::size_t differentCorners(const Level& a, const Level& b)
{
	std::size_t different = 0;
	for (std::size_t t = 0; t < a.triangles.size(); ++t)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			const std::size_t i = a.triangles[t][corner];
			const std::size_t j = b.triangles[t][corner];
			const bool uv_counts = a.material_list[a.materials[t]].mask >= 0;
			const bool same = glm::vec3(a.positions[i]) == glm::vec3(b.positions[j]) &&
							  glm::distance(a.normals[i], b.normals[j]) < 2e-7F && (!uv_counts || a.uvs[i] == b.uvs[j]);
			different += same ? 0 : 1;
		}
	}
	return different;
}

} // namespace

TEST_CASE("emit: built-in levels come back from binary glTF as they went", "[emit][level]")
{
	const std::string_view name = GENERATE(from_range(builtinNames()));
	INFO(name);
	const LoadedLevel loaded = loadLevel(std::string(kBuiltinPrefix) + std::string(name), {}, {});
	const Level& level = loaded.level;
	const LoadedLevel again = readAgain(level);
	CHECK(again.diagnosis.findings.size() == loaded.diagnosis.findings.size());
	REQUIRE(again.level.triangles.size() == level.triangles.size());
	CHECK(differentCorners(level, again.level) == 0);
	REQUIRE(again.level.meshes.size() == level.meshes.size());
	for (std::size_t i = 0; i < level.meshes.size(); ++i)
	{
		CHECK(again.level.meshes[i].name == level.meshes[i].name);
		CHECK(again.level.meshes[i].first_triangle == level.meshes[i].first_triangle);
	}
	for (std::size_t t = 0; t < level.triangles.size(); t += 7)
	{
		const Material& a = level.material_list[level.materials[t]];
		const Material& b = again.level.material_list[again.level.materials[t]];
		const bool same = a.name == b.name && a.alpha_mode == b.alpha_mode && a.two_sided == b.two_sided &&
						  a.mean_alpha == b.mean_alpha && a.coverage == b.coverage;
		REQUIRE(same);
		if (a.mask >= 0)
		{
			REQUIRE(level.masks[static_cast<std::size_t>(a.mask)].alpha ==
					again.level.masks[static_cast<std::size_t>(b.mask)].alpha);
		}
	}
	REQUIRE(again.level.cameras.size() == level.cameras.size());
	for (std::size_t i = 0; i < level.cameras.size(); ++i)
	{
		const LevelCamera& a = level.cameras[i];
		const LevelCamera& b = again.level.cameras[i];
		CHECK(a.name == b.name);
		for (int k = 0; k < 4; ++k)
		{
			CHECK(glm::distance(a.world_from_camera[k], b.world_from_camera[k]) < 1e-12);
		}
		CHECK(a.lens.orthographic == b.lens.orthographic);
		CHECK(a.lens.near_m == b.lens.near_m);
		CHECK(a.lens.far_m == b.lens.far_m);
		CHECK((a.lens.orthographic ? a.lens.half_height_m == b.lens.half_height_m : a.lens.fov_y_rad == b.lens.fov_y_rad));
	}
}

TEST_CASE("emit: a level far away keeps its shape in binary glTF", "[emit][level]")
{
	const glm::dvec3 away(4.0e6, 0.0, -2.0e6);
	Level level = test::emptyLevel();
	test::addBox(level, away, away + glm::dvec3(0.001, 0.002, 0.003));
	const Level again = readAgain(level).level;
	REQUIRE(again.triangles.size() == 12);
	const Bounds bounds = boundsOf(again);
	CHECK(glm::distance(bounds.least, away) < 1e-9);
	CHECK(glm::distance(bounds.most, away + glm::dvec3(0.001, 0.002, 0.003)) < 2e-9);
	REQUIRE(again.normals.front() == glm::vec3(0.0F)); // none were invented
}

TEST_CASE("emit: materials of one mesh become primitives; parallel cameras; what no triangle uses is left out", "[emit][level]")
{
	Level level = test::emptyLevel();
	level.material_list.resize(3);
	level.material_list[1].name = "glass";
	level.material_list[1].alpha_mode = AlphaMode::blend;
	level.material_list[1].alpha = 0.25;
	level.material_list[2].name = "unused";
	test::addQuad(level, {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0);
	test::addQuad(level, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 1);
	test::addQuad(level, {0.0, 0.0, 2.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, 0);
	test::addVertex(level, {100.0, 0.0, 0.0});
	LevelCamera& camera = level.cameras.emplace_back();
	camera.name = "a \"quoted\" name";
	camera.lens.orthographic = true;
	camera.lens.half_height_m = 3.0;
	camera.lens.far_m = 20.0;
	const Level again = readAgain(level).level;
	REQUIRE(again.meshes.size() == 2);
	CHECK(again.meshes[0].triangle_count == 4);
	CHECK(again.meshes[1].triangle_count == 2);
	CHECK(boundsOf(again).most == glm::dvec3(1.0, 1.0, 2.0));
	const Material& glass = again.material_list[again.materials[4]];
	CHECK(glass.name == "glass");
	CHECK(glass.alpha == 0.25);
	CHECK(glass.alpha_mode == AlphaMode::blend);
	REQUIRE(again.cameras.size() == 1);
	CHECK(again.cameras[0].name == camera.name);
	CHECK(again.cameras[0].lens.half_height_m == 3.0);
	CHECK(again.cameras[0].lens.far_m == 20.0);
	CHECK(again.positions.size() == 12);
}
