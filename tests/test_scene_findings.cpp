// SPDX-License-Identifier: GPL-3.0-or-later
// Every finding of a level's diagnosis, provoked deliberately.
#include "level_files.h"
#include "small_levels.h"
#include "testing.h"

namespace
{

// Separate triangles with three vertices each, in one mesh.
Level soup(const std::vector<glm::dvec3>& corners)
{
	Level level;
	level.positions = corners;
	level.normals.resize(corners.size());
	level.uvs.resize(corners.size());
	for (uint32_t i = 0; i + 2 < corners.size(); i += 3)
	{
		level.triangles.emplace_back(i, i + 1, i + 2);
	}
	level.materials.resize(level.triangles.size(), 0);
	level.meshes = {{"soup", 0, level.triangles.size()}};
	level.material_list.resize(1);
	return level;
}

std::string cleaned(Level& level, int threads = 1)
{
	const std::size_t before = level.triangles.size();
	const Diagnosis diagnosis = cleanLevel(level, {threads, {}});
	CHECK(level.triangles.size() <= before);
	CHECK(level.materials.size() == level.triangles.size());
	std::size_t next = 0;
	for (const Mesh& mesh : level.meshes)
	{
		CHECK(mesh.first_triangle == next);
		CHECK(mesh.triangle_count > 0);
		next += mesh.triangle_count;
	}
	CHECK(next == level.triangles.size());
	for (const glm::uvec3& t : level.triangles)
	{
		CHECK(std::max({t.x, t.y, t.z}) < level.positions.size());
	}
	return findingsOf(diagnosis);
}

const glm::dvec3 kA(0, 0, 0);
const glm::dvec3 kB(1, 0, 0);
const glm::dvec3 kC(0, 1, 0);
const glm::dvec3 kD(1, 1, 0);
const glm::dvec3 kE(0, 0, 1);

} // namespace

TEST_CASE("scene: a clean level has no finding and stays as it is", "[scene]")
{
	Level level = soup({kA, kB, kC, kB, kD, kC});
	CHECK(cleaned(level).empty());
	CHECK(level.triangles.size() == 2);
	CHECK(level.positions.size() == 6);
}

TEST_CASE("scene: triangles that no ray can hit are dropped", "[scene]")
{
	const double nan = std::numeric_limits<double>::quiet_NaN();
	const double inf = std::numeric_limits<double>::infinity();
	Level level = soup({kA, kB, kC, {nan, 0, 0}, kB, kC, kB, kD, kC, kA, {0, -inf, 0}, kB, kA, kB, {0, 1e16, 0}});
	CHECK(cleaned(level) == "non-finite-vertices 3 dropped");
	CHECK(level.triangles.size() == 2);
	CHECK(level.positions.size() == 6); // the others' vertices are removed

	level =
		soup({kA, kB, kC, kA, kA, kB, kA, kB, 0.5 * (kA + kB), {1e6, 1e6, 0.1}, {1e6 + 1, 1e6 + 1, 0.1}, {1e6 + 3, 1e6 + 3, 0.1}});
	CHECK(cleaned(level) == "degenerate-triangles 3 dropped");

	level = soup({kA, kB, kC, kB, kD, kC});
	level.triangles[0].y = 6;
	level.triangles.emplace_back(UINT32_MAX);
	level.materials.push_back(0);
	level.meshes[0].triangle_count = 3;
	CHECK(cleaned(level) == "index-out-of-range 2 dropped");
	CHECK(level.triangles.size() == 1);
}

TEST_CASE("scene: the first place is named by mesh and triangle", "[scene]")
{
	Level level = soup({kA, kB, kC, kB, kD, kC, kA, kA, kA, kE, kE, kE});
	level.meshes = {{"one", 0, 2}, {"none", 2, 0}, {"two", 2, 2}};
	const Diagnosis diagnosis = cleanLevel(level, {});
	REQUIRE(findingsOf(diagnosis) == "degenerate-triangles 2 dropped, empty-meshes 2 dropped");
	CHECK(diagnosis.findings[0].first == "mesh 'two', triangle 0");
	CHECK(diagnosis.findings[1].first == "mesh 'none'");
	REQUIRE(level.meshes.size() == 1);
	CHECK(level.meshes[0].name == "one");
}

TEST_CASE("scene: slivers are kept", "[scene]")
{
	Level level = soup({kA, {1, 0, 0}, {0.5, 1e-5, 0}, {5, 0, 0}, {6, 0, 0}, {5.5, 1e-3, 0}});
	CHECK(cleaned(level) == "sliver-triangles 1 kept");
	CHECK(level.triangles.size() == 2);
}

TEST_CASE("scene: faces at the same place", "[scene]")
{
	Level level = soup({kA, kB, kC, kB, kC, kA, kC, kA, kB});
	CHECK(cleaned(level) == "duplicate-faces 2 dropped");
	CHECK(level.triangles.size() == 1);

	level = soup({kA, kB, kC, kA, kC, kB, kC, kB, kA});
	CHECK(cleaned(level) == "duplicate-faces 1 dropped, coincident-faces 1 kept");
	CHECK(level.triangles.size() == 2);

	level = soup({{-0.0, 0, 0}, kB, kC, kA, kB, kC}); // −0 equals 0
	CHECK(cleaned(level) == "duplicate-faces 1 dropped");
}

TEST_CASE("scene: of faces with masks only true copies are dropped", "[scene]")
{
	const auto masked = [](uint32_t first, uint32_t second)
	{
		Level level = soup({kA, kB, kC, kB, kC, kA});
		level.material_list.resize(3);
		level.material_list[1].alpha_mode = AlphaMode::mask;
		level.material_list[2].alpha_mode = AlphaMode::mask;
		level.materials = {first, second};
		level.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {0, 1}, {0, 0}};
		return level;
	};
	Level level = masked(1, 1);
	CHECK(cleaned(level) == "duplicate-faces 1 dropped");
	level = masked(1, 2);
	CHECK(cleaned(level) == "coincident-faces 1 kept");
	level = masked(0, 1); // hidden behind an opaque one
	CHECK(cleaned(level) == "duplicate-faces 1 dropped");
	level = masked(1, 0);
	CHECK(cleaned(level) == "coincident-faces 1 kept");
	level = masked(1, 1);
	level.uvs[5] = {0.5F, 0.5F}; // shows another part of the picture
	CHECK(cleaned(level) == "coincident-faces 1 kept");
}

TEST_CASE("scene: edges of many triangles and of turned ones", "[scene]")
{
	Level level = soup({kA, kB, kC, kB, kA, kE, kA, kB, {0, -1, 0}});
	CHECK(cleaned(level) == "non-manifold-edges 1 kept");
	level = soup({kA, kB, kC, kB, kC, kD}); // B to C twice
	CHECK(cleaned(level) == "inconsistent-winding 1 kept");
	// Two boxes that touch along an edge are two intact surfaces.
	level = soup({kA, kB, kC, kB, kA, kE, kA, kB, {0, -1, 0}, kB, kA, {0, 0, -1}});
	level.meshes = {{"one", 0, 2}, {"two", 2, 2}};
	CHECK(cleaned(level).empty());
}

TEST_CASE("scene: closed parts that are wound inside out are reported with their volume", "[scene]")
{
	using test::addBox;
	using test::addQuad;
	const auto turnOver = [](Level& level, std::size_t from)
	{
		for (std::size_t t = from; t < level.triangles.size(); ++t)
		{
			std::swap(level.triangles[t].y, level.triangles[t].z);
		}
	};
	const auto addTurnedBox = [&](Level& level, glm::dvec3 least, glm::dvec3 most)
	{
		const std::size_t from = level.triangles.size();
		addBox(level, least, most);
		turnOver(level, from);
	};
	const auto firstOf = [](Level level, int threads = 1)
	{
		const Diagnosis diagnosis = cleanLevel(level, {threads, {}});
		CHECK(findingsOf(diagnosis).starts_with(diagnosis.findings.empty() ? "" : "inside-out-parts "));
		return diagnosis.findings.empty() ? std::string()
										  : std::to_string(diagnosis.findings[0].count) + " " + diagnosis.findings[0].first;
	};
	const glm::dvec3 far(1e5, -2e5, 3e5);
	Level level = test::emptyLevel();
	addQuad(level, {-9, 0, 9}, {18, 0, 0}, {0, 0, -18}); // it stands on a floor
	addTurnedBox(level, {-1, 0, -1}, {1, 2, 1});
	addBox(level, {3, 0, 3}, {4, 1, 4});
	CHECK(firstOf(level) == "1 mesh 'all', volume -8 m3");
	CHECK(firstOf(level, 7) == "1 mesh 'all', volume -8 m3");
	addTurnedBox(level, {5, 0, 5}, {5.5, 0.5, 5.5});
	CHECK(firstOf(level) == "2 mesh 'all', volume -8 m3");
	for (glm::dvec3& position : level.positions)
	{
		position = far + 1e-3 * position; // where the volume about the origin is a sum of 1e13 m³
	}
	CHECK(firstOf(level) == "2 mesh 'all', volume -8e-09 m3");

	// A room with contents or a camera correctly faces inward.
	level = test::emptyLevel();
	addTurnedBox(level, {-5, 0, -5}, {5, 3, 5});
	CHECK(firstOf(level) == "1 mesh 'all', volume -300 m3");
	level.cameras.emplace_back().world_from_camera[3] = {4, 1, 4, 1};
	CHECK(firstOf(level).empty());
	level.cameras[0].world_from_camera[3] = {4, 3.5, 4, 1};
	CHECK(firstOf(level) == "1 mesh 'all', volume -300 m3");
	addBox(level, {-5, 0, -5}, {-4, 1, -4}); // in its corner
	CHECK(firstOf(level).empty());
	addTurnedBox(level, {1, 0, 1}, {2, 1, 2}); // an inverted crate in the room
	CHECK(firstOf(level) == "1 mesh 'all', volume -1 m3");

	// A point in the bounding box of a part need not be inside it: an L-shaped part with a post in its notch.
	level = test::emptyLevel();
	const std::array<glm::dvec2, 6> outline{{{0, 0}, {0, 4}, {1, 4}, {1, 1}, {4, 1}, {4, 0}}};
	for (std::size_t i = 0; i < 6; ++i)
	{
		const glm::dvec2 a = outline[i];
		const glm::dvec2 along = outline[(i + 1) % 6] - a;
		addQuad(level, {a.x, 0, a.y}, {along.x, 0, along.y}, {0, 2, 0});
	}
	for (const double y : {0.0, 2.0})
	{
		std::array<uint32_t, 6> v{};
		for (std::size_t i = 0; i < 6; ++i)
		{
			v[i] = test::addVertex(level, {outline[i].x, y, outline[i].y});
		}
		for (const auto& t : {std::array{0, 1, 3}, {1, 2, 3}, {0, 3, 5}, {3, 4, 5}})
		{
			const auto at = [&](int corner)
			{
				return v[static_cast<std::size_t>(t[static_cast<std::size_t>(corner)])];
			};
			test::addTriangle(level, at(0), at(y > 0.0 ? 1 : 2), at(y > 0.0 ? 2 : 1));
		}
	}
	CHECK(firstOf(level).empty());
	turnOver(level, 0);
	addBox(level, {2.5, 0.5, 2.5}, {3, 1.5, 3});
	CHECK(firstOf(level) == "1 mesh 'all', volume -14 m3");
	addBox(level, {0.2, 0.5, 2.5}, {0.4, 1.5, 3}); // in one arm of it
	CHECK(firstOf(level).empty());

	// A hollow in a solid, which faces its contents.
	level = test::emptyLevel();
	test::addSphere(level, {0, 0, 0}, 2.0, 12, 24);
	const std::size_t outer = level.triangles.size();
	test::addSphere(level, {0, 0, 0}, 1.0, 12, 24);
	turnOver(level, outer);
	CHECK(firstOf(level).empty());
	level.triangles.erase(level.triangles.begin(), level.triangles.begin() + static_cast<std::ptrdiff_t>(outer));
	level.materials.resize(level.triangles.size());
	level.meshes[0].triangle_count = level.triangles.size();
	CHECK(firstOf(level).starts_with("1 mesh 'all', volume -4.0"));

	// With a hole, without volume, two-sided, or with its other side at the same place: nothing to report.
	level = test::emptyLevel();
	addTurnedBox(level, {0, 0, 0}, {1, 1, 1});
	Level holed = level;
	holed.triangles.pop_back();
	holed.materials.pop_back();
	holed.meshes[0].triangle_count -= 1;
	CHECK(firstOf(holed).empty());
	Level two_sided = level;
	two_sided.material_list[0].two_sided = true;
	CHECK(firstOf(two_sided).empty());
	Level flat = level;
	for (glm::dvec3& position : flat.positions)
	{
		position = {position.x, 1e-8 * position.y, position.z};
	}
	for (glm::dvec3& position : flat.positions)
	{
		position += glm::dvec3(100.0, 100.0, 100.0);
	}
	CHECK(findingsOf(cleanLevel(flat, {})).find("inside-out") == std::string::npos);
	addBox(level, {0, 0, 0}, {1, 1, 1});
	CHECK(findingsOf(cleanLevel(level, {})) == "coincident-faces 12 kept");

	// Parts that touch at a corner, and meshes that touch along an edge, are separate; faces of several meshes can form one part.
	level = test::emptyLevel();
	addBox(level, {0, 0, 0}, {1, 1, 1});
	addTurnedBox(level, {1, 1, 1}, {3, 2, 2});
	CHECK(firstOf(level) == "1 mesh 'all', volume -2 m3");
	level.meshes.push_back({"other", level.triangles.size(), 0});
	addTurnedBox(level, {1, 0, 1}, {2, 1, 4});
	CHECK(firstOf(level) == "2 mesh 'all', volume -2 m3");
	level = test::emptyLevel();
	addTurnedBox(level, {0, 0, 0}, {1, 1, 3});
	level.meshes = {{"sides", 0, 4}, {"rest", 4, 8}};
	CHECK(firstOf(level) == "1 mesh 'sides', volume -3 m3");
}

TEST_CASE("scene: instances that are mirrored are wound rightly", "[scene]")
{
	nlohmann::json json = cubeGltf();
	json["nodes"][0]["scale"] = {-2.0, 1.0, 1.0};
	const TemporaryFolder folder;
	CHECK(loadText(folder / "a.gltf", gltfText(json)).diagnosis.findings.empty());
	std::string buffer = cubeBuffer();
	for (std::size_t triangle = 0; triangle < 12; ++triangle) // indices follow positions and coordinates
	{
		std::swap_ranges(buffer.begin() + 160 + static_cast<std::ptrdiff_t>(6 * triangle),
						 buffer.begin() + 162 + static_cast<std::ptrdiff_t>(6 * triangle),
						 buffer.begin() + 162 + static_cast<std::ptrdiff_t>(6 * triangle));
	}
	const LoadedLevel turned = loadText(folder / "b.gltf", gltfText(json, buffer));
	REQUIRE(findingsOf(turned.diagnosis) == "inside-out-parts 1 kept");
	CHECK(turned.diagnosis.findings[0].first == "mesh 'cube', volume -2 m3");
}

TEST_CASE("scene: normals become unit or none", "[scene]")
{
	Level level = soup({kA, kB, kC, kB, kD, kC});
	const float nan = std::numeric_limits<float>::quiet_NaN();
	level.normals = {{0, 0, 1}, {0, 0, 2}, {0, nan, 1}, {0, 0, 0}, {0, 0, 1.001F}, {0.6F, 0, 0.8F}};
	CHECK(cleaned(level) == "bad-normals 2 repaired");
	CHECK(level.normals[1] == glm::vec3(0, 0, 1));
	CHECK(level.normals[2] == glm::vec3(0));
	CHECK(level.normals[3] == glm::vec3(0));
	CHECK(level.normals[4] == glm::vec3(0, 0, 1));
}

TEST_CASE("scene: coordinates that 32 bits hold to less than a millimetre", "[scene]")
{
	const glm::dvec3 near(8191.0, 0, 0);
	Level level = soup({near, near + kC, near + kE, near + kD, near + kC, near});
	CHECK(cleaned(level) == "large-coordinates 1 kept");
}

TEST_CASE("scene: what reading finds stands in the table's order", "[scene]")
{
	const TemporaryFolder folder;
	const LoadedLevel loaded = loadText(folder / "a.obj", "mtllib gone.mtl\n" + cubeObj() +
															  "v 5 5 5\nv nan 0 0\nv 9 9 9\nl 1 9\np 2\n"
															  "f 9 1 10\nf 1 2 2\nf 1 2 9 1\n");
	CHECK(findingsOf(loaded.diagnosis) == "missing-file 1 ignored, points-or-lines 2 dropped, non-finite-vertices 1 dropped, "
										  "degenerate-triangles 1 dropped, non-manifold-edges 1 kept");
	CHECK(loaded.diagnosis.findings[0].first == "gone.mtl");
	writeFile(folder / "rows.png", rowsPng());
	writeFile(folder / "b.mtl", "newmtl net\nmap_d rows.png\n");
	const LoadedLevel bare = loadText(folder / "b.obj", "mtllib b.mtl\nusemtl net\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n"
														"v 9 0 0\nv 9 0 0\nv 9 1 0\nv 9 1 0\nf 5 6 7 8\n");
	CHECK(findingsOf(bare.diagnosis) == "bad-polygons 1 kept, missing-uvs 1 kept, degenerate-triangles 2 dropped");
}

TEST_CASE("scene: meshes far from the rest", "[scene]")
{
	const TemporaryFolder folder;
	const auto findings = [&](const std::string& far)
	{
		return loadText(folder / "a.obj", "o cube\n" + cubeObj() + "o far\nv " + far + " 0 0\nv " + far + ".05 0 0\nv " + far +
											  " 0.05 0\nf -1 -2 -3\n")
			.diagnosis;
	};
	CHECK(findings("3").findings.empty()); // the whole is not twice as large as the cube
	const Diagnosis strays = findings("9");
	REQUIRE(findingsOf(strays) == "strays 1 kept");
	CHECK(strays.findings[0].first == "mesh 'far', 8 m from the rest, which --ignore '/far' leaves out");
}

TEST_CASE("scene: strict makes findings errors", "[scene]")
{
	const TemporaryFolder folder;
	const LoadSettings strict{{0.0, UpAxis::file, true}, {}};
	CHECK_NOTHROW(loadText(folder / "a.obj", cubeObj(), strict));
	const std::string message = refusalBy([&] { loadText(folder / "a.obj", cubeObj() + "f 1 2 2\nf 1 2 2\nl 1 2\n", strict); });
	CHECK(message.find("found points-or-lines") != std::string::npos);
	CHECK(message.find("1 more kind") != std::string::npos);
}

TEST_CASE("scene: the same level and findings on any number of threads", "[scene]")
{
	std::vector<glm::dvec3> corners;
	for (uint32_t i = 0; i < 90000; ++i)
	{
		// Small integers, so that every defect occurs often.
		corners.emplace_back(i * 7919 % 31, i * 104729 % 13, i * 1299709 % 17);
	}
	Level one = soup(corners);
	Level many = soup(corners);
	const Diagnosis first = cleanLevel(one, {1, {}});
	const Diagnosis second = cleanLevel(many, {7, {}});
	CHECK(findingsOf(first) == findingsOf(second));
	CHECK(first.findings.size() >= 4);
	for (std::size_t i = 0; i < first.findings.size(); ++i)
	{
		CHECK(first.findings[i].first == second.findings[i].first);
	}
	CHECK(one.positions == many.positions);
	CHECK(one.triangles == many.triangles);
}
