// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_pictures.h"
#include "testing.h"

#include "scene/builtin.h"
#include "scene/camera_choice.h"
#include "scene/tracer.h"

#include <glm/matrix.hpp>

namespace
{

using namespace nook;

const std::array<std::string, 9> kLevels = {"cornell",       "courtyard", "suburb",     "foliage", "heightfield",
											"heightfield:2", "cave:1000", "cave:30000", "nulls"};

std::array<glm::dvec3, 3> cornersOf(const Level& level, std::size_t triangle)
{
	const glm::uvec3 t = level.triangles[triangle];
	return {level.positions[t.x], level.positions[t.y], level.positions[t.z]};
}

bool isOpaque(const Level& level, std::size_t triangle)
{
	return level.material_list[level.materials[triangle]].alpha_mode == AlphaMode::opaque;
}

template <class T> bool sameBytes(const std::vector<T>& a, const std::vector<T>& b)
{
	return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

} // namespace

TEST_CASE("scene: solids of built-in levels are closed, and their fronts are outside", "[scene]")
{
	for (const std::string& name : kLevels)
	{
		INFO(name);
		const Level level = builtinLevel(name);
		// By position, since faces do not share vertices across hard edges. Opaque surfaces are solids.
		using Edge = std::array<double, 6>;
		std::map<Edge, int> edges;
		double volume = 0.0;
		for (std::size_t i = 0; i < level.triangles.size(); ++i)
		{
			if (!isOpaque(level, i))
			{
				continue;
			}
			const std::array<glm::dvec3, 3> p = cornersOf(level, i);
			volume += glm::dot(p[0], glm::cross(p[1], p[2])) / 6.0;
			for (std::size_t k = 0; k < 3; ++k)
			{
				const glm::dvec3 a = p[k];
				const glm::dvec3 b = p[(k + 1) % 3];
				edges[{a.x, a.y, a.z, b.x, b.y, b.z}] += 1;
				edges[{b.x, b.y, b.z, a.x, a.y, a.z}] -= 1;
			}
		}
		std::size_t open = 0;
		for (const auto& [edge, balance] : edges)
		{
			open += balance != 0 ? 1U : 0U;
		}
		CHECK(open == 0);
		CHECK(volume > 0.0);
	}
}

TEST_CASE("scene: each mesh of a built-in level encloses a positive volume", "[scene]")
{
	for (const std::string& name : kLevels)
	{
		const Level level = builtinLevel(name);
		for (const Mesh& mesh : level.meshes)
		{
			INFO(name << ": " << mesh.name);
			REQUIRE(mesh.triangle_count > 0);
			if (!isOpaque(level, mesh.first_triangle))
			{
				continue;
			}
			double volume = 0.0;
			const glm::dvec3 origin = cornersOf(level, mesh.first_triangle)[0];
			for (std::size_t i = 0; i < mesh.triangle_count; ++i)
			{
				const std::array<glm::dvec3, 3> p = cornersOf(level, mesh.first_triangle + i);
				volume += glm::dot(p[0] - origin, glm::cross(p[1] - origin, p[2] - origin)) / 6.0;
			}
			CHECK(volume > 0.0);
		}
	}
}

TEST_CASE("scene: built-in levels have sound triangles, normals and texture coordinates", "[scene]")
{
	const std::string name = GENERATE(from_range(kLevels));
	INFO(name);
	const Level level = builtinLevel(name);
	CHECK(level.name == "builtin:" + name);
	REQUIRE(level.normals.size() == level.positions.size());
	REQUIRE(level.uvs.size() == level.positions.size());
	REQUIRE(level.materials.size() == level.triangles.size());
	std::size_t degenerate = 0;
	std::size_t turned = 0;
	std::size_t not_unit = 0;
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		const std::array<glm::dvec3, 3> p = cornersOf(level, i);
		const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
		const double longest = std::max({glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])});
		degenerate += glm::length(across) > 1e-6 * longest * longest ? 0U : 1U;
		for (int k = 0; k < 3; ++k)
		{
			const glm::dvec3 normal = level.normals[level.triangles[i][k]];
			turned += glm::dot(normal, across) > 0.0 ? 0U : 1U;
			not_unit += std::fabs(glm::length(normal) - 1.0) < 1e-6 ? 0U : 1U;
		}
	}
	CHECK(degenerate == 0);
	CHECK(turned == 0);
	CHECK(not_unit == 0);
	std::size_t covered = 0;
	for (const Mesh& mesh : level.meshes)
	{
		CHECK(mesh.first_triangle == covered);
		covered += mesh.triangle_count;
	}
	CHECK(covered == level.triangles.size());
}

TEST_CASE("scene: a built-in level is the same each time", "[scene]")
{
	const std::string name = GENERATE(from_range(kLevels));
	INFO(name);
	const Level a = builtinLevel(name);
	const Level b = builtinLevel(name);
	CHECK(sameBytes(a.positions, b.positions));
	CHECK(sameBytes(a.normals, b.normals));
	CHECK(sameBytes(a.uvs, b.uvs));
	CHECK(sameBytes(a.triangles, b.triangles));
	REQUIRE(a.masks.size() == b.masks.size());
	for (std::size_t i = 0; i < a.masks.size(); ++i)
	{
		CHECK(a.masks[i].alpha == b.masks[i].alpha);
	}
}

TEST_CASE("scene: cameras of built-in levels stand in the open and see something", "[scene][camera]")
{
	const std::string name = GENERATE(from_range(kLevels));
	const Level level = builtinLevel(name);
	const Tracer tracer(level, {});
	REQUIRE_FALSE(level.cameras.empty());
	CHECK(level.cameras.front().name == "main");
	for (const LevelCamera& camera : level.cameras)
	{
		INFO(name << ": " << camera.name);
		CHECK_NOTHROW(checkOutside(tracer, glm::dvec3(camera.world_from_camera[3]), camera.name));
		// The overview of the nulls shows separate squares, and two grids of two triangles are mostly sky.
		const bool sparse = (name == "nulls" && camera.name == "main") || name == "heightfield:2";
		CHECK(hitsPerCent(tracer, camera) >= (sparse ? 20 : 55));
	}
}

TEST_CASE("scene: built-in levels have the detail they promise", "[scene]")
{
	CHECK(builtinLevel("courtyard").triangles.size() > 100'000);
	// Long sight lines: from the camera at the entrance to the hall behind the temple front.
	const Level courtyard = builtinLevel("courtyard");
	const Tracer tracer(courtyard, {});
	const RayHit far = tracer.nearest({0.0, 2.6, 0.0}, {0.0, 0.0, -1.0}, 1e3);
	REQUIRE(far.hit);
	CHECK(far.distance > 60.0);

	const Level foliage = builtinLevel("foliage");
	std::size_t cards = 0;
	for (std::size_t i = 0; i < foliage.triangles.size(); ++i)
	{
		cards += isOpaque(foliage, i) ? 0U : 1U;
	}
	CHECK(cards / 2 >= 2000);

	const Level suburb = builtinLevel("suburb");
	for (const Mesh& mesh : suburb.meshes)
	{
		if (mesh.name == "fence netting")
		{
			CHECK(mesh.triangle_count == 2);
			const Material& netting = suburb.material_list[suburb.materials[mesh.first_triangle]];
			// Two families of wires, 3 mm thick and 70 mm / √2 apart, in independent directions.
			const double wire = 0.003 / 0.07 * std::sqrt(2.0);
			CHECK(netting.mean_alpha == Approx(1.0 - (1.0 - wire) * (1.0 - wire)).margin(0.004));
			CHECK(netting.mask >= 0);
		}
	}
}

TEST_CASE("scene: a height field has as many triangles as asked for, and few more", "[scene]")
{
	for (const std::size_t count : {std::size_t{2}, std::size_t{3}, std::size_t{1000}, std::size_t{300'000}})
	{
		const Level level = builtinLevel("heightfield:" + std::to_string(count));
		CHECK(level.triangles.size() >= count);
		const auto side = std::sqrt(static_cast<double>(count)) + 2.0;
		CHECK(static_cast<double>(level.triangles.size()) <= side * side + 12.0 * side);
	}
	for (const std::size_t count : {std::size_t{1000}, std::size_t{1001}, std::size_t{100'000}})
	{
		const std::size_t made = builtinLevel("cave:" + std::to_string(count)).triangles.size();
		CHECK(made >= count);
		CHECK(static_cast<double>(made) <= 1.1 * static_cast<double>(count) + 400.0);
	}
	CHECK(builtinLevel("cave").triangles.size() >= 600'000);
	for (const char* const bad : {"heightfield:", "heightfield:1", "heightfield:-5", "heightfield:1e6", "heightfield:20000001",
								  "heightfield:5 ", "cave:", "cave:999", "cave:20000001", "cavern", "nope", "", "Cornell"})
	{
		INFO(bad);
		CHECK_THROWS_AS(builtinLevel(bad), Error);
	}
	const std::string refusal = refusalBy([] { builtinLevel("nope"); }, ExitCode::usage);
	for (const std::string_view name : builtinNames())
	{
		CHECK(refusal.find(name) != std::string::npos);
	}
}

TEST_CASE("scene: the nulls stand where their table says", "[scene]")
{
	const Level level = builtinLevel("nulls");
	const Tracer tracer(level, {});
	const double endless = std::numeric_limits<double>::infinity();
	const auto down = [&](double x, double z)
	{
		return 200.0 - tracer.nearest({x, 200.0, z}, {0.0, -1.0, 0.0}, endless).distance;
	};
	CHECK(down(0.3, 0.2) == Approx(0.0).margin(1e-9));
	CHECK(down(150.0, 1.0) == Approx(0.0).margin(1e-9));
	CHECK(down(150.0, -0.5) == Approx(50.0));
	CHECK(tracer.nearest({150.0, 3.0, 10.0}, {0.0, 0.0, -1.0}, endless).distance == Approx(10.0));
	CHECK(down(300.0, 0.1) == Approx(0.0).margin(1e-9));
	CHECK(down(300.0, -0.1) == Approx(0.5));
	CHECK(down(0.0, -150.0) == Approx(2.0));
	CHECK(down(2.0, -150.0) == Approx(0.0).margin(1e-9));
	CHECK(tracer.nearest({150.2, 0.25, -150.1}, {0.0, 1.0, 0.0}, endless).distance == Approx(0.75));
	CHECK(down(300.0, -150.0) == Approx(0.0).margin(1e-9));
	CHECK(down(300.0, -151.0) == Approx(1.0 / std::sqrt(3.0)));
	CHECK(level.cameras.size() >= 7);
	for (const char* const name : {"main", "floor", "wall", "step", "sphere", "disk", "slope"})
	{
		CHECK_NOTHROW(cameraNamed(level, name));
	}
	CHECK_THROWS_AS(cameraNamed(level, "nowhere"), Error);
}
