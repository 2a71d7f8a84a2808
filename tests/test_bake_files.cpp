// SPDX-License-Identifier: GPL-3.0-or-later
// Baked values in files and in pictures of a view.
#include "bake_levels.h"
#include "temporary_folder.h"

#include "bake/bake.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_reader.h"
#include "scene/gbuffer.h"
#include "scene/level_glb.h"
#include "scene/load.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

using namespace nook;
using namespace nook::test;

TEST_CASE("bake: values come back from the file, as an attribute and as a colour", "[bake][emit]")
{
	Level level = emptyLevel();
	addQuad(level, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -1.0});
	const std::vector<float> values{0.0F, 0.25F, 0.5F, 1.0F};
	const std::string bytes = levelGlb(level, "nook test", {values, true, {}, {}, {}, {}, {}});
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

	const std::string bytes = levelGlb(level, "nook test", {bake.visibility, true, {}, {}, bake.back, bake.bent, bake.bent_back});
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
	std::vector<float> values;
	for (const glm::dvec3 position : level.positions)
	{
		values.push_back(static_cast<float>(0.5 + 0.2 * position.x));
	}
	const std::string path = folder / "a.glb";
	writeFile(path, levelGlb(level, "nook test", {values, false, {}, {}, {}, {}, {}}));
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
