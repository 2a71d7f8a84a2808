// SPDX-License-Identifier: GPL-3.0-or-later
// Levels at map coordinates: text and 64-bit numbers keep their full precision throughout.
#include "level_files.h"
#include "testing.h"

#include "scene/level_glb.h"
#include "scene/reference.h"
#include "scene/tracer.h"

namespace
{

// Metres, eastings and northings; the cube is 0.3 m wide. Decimals with digits that 32 bits cannot hold.
constexpr std::array<std::array<const char*, 2>, 3> kSides{
	{{"447000.4", "447000.7"}, {"5411000.4", "5411000.7"}, {"120.2", "120.5"}}};

std::string decimalOfCorner(unsigned corner, int axis)
{
	return kSides[static_cast<std::size_t>(axis)][(corner >> static_cast<unsigned>(axis)) & 1U];
}

glm::dvec3 mapCorner(unsigned corner)
{
	return {std::stod(decimalOfCorner(corner, 0)), std::stod(decimalOfCorner(corner, 1)), std::stod(decimalOfCorner(corner, 2))};
}

std::string cornerText(unsigned corner)
{
	return decimalOfCorner(corner, 0) + " " + decimalOfCorner(corner, 1) + " " + decimalOfCorner(corner, 2);
}

std::string mapObj(const std::string& behind_vertices = "")
{
	std::string text;
	for (unsigned i = 0; i < 8; ++i)
	{
		text += "v " + cornerText(i) + behind_vertices + "\n";
	}
	for (const auto& q : kCubeQuads)
	{
		text += "f";
		for (const unsigned corner : q)
		{
			text += " " + std::to_string(static_cast<int>(corner) - 8);
		}
		text += "\n";
	}
	return text;
}

// `vertex`: one vertex; `before` and `behind`: the properties before and after x y z.
std::string mapPly(const std::string& format, const std::string& before, const std::string& behind,
				   const std::function<std::string(unsigned)>& vertex, const std::string& faces)
{
	std::string text = "ply\nformat " + format + " 1.0\nelement vertex 8\n" + before +
					   "property double x\nproperty double y\nproperty double z\n" + behind +
					   "element face 12\nproperty list uchar int vertex_indices\nend_header\n";
	for (unsigned i = 0; i < 8; ++i)
	{
		text += vertex(i);
	}
	return text + faces;
}

template <class T> void append(std::string& bytes, T value, bool big_endian)
{
	std::string raw;
	nook::append(raw, value);
	if (big_endian)
	{
		std::reverse(raw.begin(), raw.end());
	}
	bytes += raw;
}

std::string binaryPly(bool big_endian)
{
	std::string faces;
	for (const auto& triangle : cubeTriangles())
	{
		append(faces, uint8_t{3}, big_endian);
		for (const unsigned corner : triangle)
		{
			append(faces, static_cast<int32_t>(corner), big_endian);
		}
	}
	const auto vertex = [&](unsigned i)
	{
		std::string bytes;
		append(bytes, int16_t{-7}, big_endian);
		for (int axis = 0; axis < 3; ++axis)
		{
			append(bytes, mapCorner(i)[axis], big_endian);
		}
		append(bytes, uint8_t{2}, big_endian);
		append(bytes, 1.5F, big_endian);
		append(bytes, 2.5F, big_endian);
		return bytes;
	};
	return mapPly(big_endian ? "binary_big_endian" : "binary_little_endian", "property short weight\n",
				  "property list uchar float lengths\n", vertex, faces);
}

std::string asciiPly()
{
	std::string faces;
	for (const auto& t : cubeTriangles())
	{
		faces += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + "\n";
	}
	return mapPly(
		"ascii", "property list uchar int before\n", "property uchar red\n",
		[](unsigned i) { return "2 70000 70000 " + cornerText(i) + " 255\n"; }, faces);
}

std::string mapStl(const std::string& name)
{
	std::string text = "solid " + name + "\n";
	for (const auto& t : cubeTriangles())
	{
		text += "facet normal 0 0 0\nouter loop\n";
		for (const unsigned corner : t)
		{
			text += "vertex " + cornerText(corner) + "\n";
		}
		text += "endloop\nendfacet\n";
	}
	return text + "endsolid " + name + "\n";
}

void checkMapCube(const LoadedLevel& loaded, std::size_t cubes = 1)
{
	const Level& level = loaded.level;
	REQUIRE(level.triangles.size() == 12 * cubes);
	CHECK(areaOf(level) == Approx(0.54 * static_cast<double>(cubes)).epsilon(1e-7));
	for (const glm::dvec3& position : level.positions)
	{
		bool known = false;
		for (unsigned i = 0; i < 8; ++i)
		{
			known = known || position == mapCorner(i);
		}
		CHECK(known); // correctly rounded to 64 bits
	}
	for (const Finding& finding : loaded.diagnosis.findings)
	{
		CHECK(finding.id == "large-coordinates");
	}
}

double visibilityNextTo(const Level& level, glm::dvec3 corner)
{
	const Tracer tracer(level, {});
	const ReferencePoint point{corner + glm::dvec3(-0.05, 0.1, 0.1), {0.0, 0.0, 1.0}, 0.0};
	ReferenceSettings settings{.rays = 2048};
	return referenceAtPoints(tracer, std::span(&point, 1), settings, {})[0].visibility;
}

} // namespace

TEST_CASE("scene: a small cube at map coordinates keeps its digits in OBJ, PLY and STL", "[scene]")
{
	const TemporaryFolder folder;
	checkMapCube(loadText(folder / "a.obj", mapObj()));
	checkMapCube(loadText(folder / "a.obj", mapObj(" 0.5 0.25 1"))); // a colour
	checkMapCube(loadText(folder / "a.obj", mapObj(" 1")));          // a weight
	checkMapCube(loadText(folder / "a.ply", asciiPly()));
	checkMapCube(loadText(folder / "a.ply", binaryPly(false)));
	checkMapCube(loadText(folder / "a.ply", binaryPly(true)));
	checkMapCube(loadText(folder / "a.stl", mapStl("a")));
}

TEST_CASE("scene: numbers of many digits and with exponents at map coordinates", "[scene]")
{
	const TemporaryFolder folder;
	const Level level = loadText(folder / "a.obj", "v 4649776.1234567890123 5.00000125e5 -4649776.125\n"
												   "v +4649777.1234567890123 500000.125 -.46497760e7 # behind it\n"
												   "v 9299552.24 1000000 0 2\nf -3 -2 -1\n")
							.level;
	REQUIRE(level.triangles.size() == 1);
	CHECK(level.positions[level.triangles[0].x] == glm::dvec3(4649776.1234567890123, 500000.125, -4649776.125));
	CHECK(level.positions[level.triangles[0].y] == glm::dvec3(4649777.1234567890123, 500000.125, -4649776.0));
	CHECK(level.positions[level.triangles[0].z] == glm::dvec3(4649776.12, 500000.0, 0.0)); // divided by its weight
}

TEST_CASE("scene: polygons and materials at map coordinates", "[scene]")
{
	// A floor of 10 km with the cube at its far corner: 32-bit differences from any origin would lose a millimetre.
	const TemporaryFolder folder;
	writeFile(folder / "a.mtl", "newmtl a b\nd 0.25\n");
	const std::string text =
		"mtllib a.mtl\nv 437000 5401000 120.2\nv 447000 5401000 120.2\nv 447000 5411000 120.2\nv 437000 5411000 "
		"120.2\nf 1 2 3 4\nusemtl a b\n" +
		mapObj();
	const Level level = loadText(folder / "a.obj", text, {{0.0, UpAxis::z}, {}}).level;
	REQUIRE(level.triangles.size() == 14);
	CHECK(areaOf(level) - 1e8 == Approx(0.54).epsilon(1e-6));
	CHECK(level.material_list[level.materials.back()].alpha == 0.25);
	const Bounds bounds = boundsOf(level);
	CHECK(bounds.most == glm::dvec3(447000.7, 120.5, -5401000.0));
	CHECK(bounds.least == glm::dvec3(437000.0, 120.2, -5411000.7));
}

TEST_CASE("scene: files of small coordinates keep their digits, too", "[scene]")
{
	const TemporaryFolder folder;
	const Level level = loadText(folder / "a.obj", "v 0.1 8191.9 0\nv 1 0 0\nv 0 1 0\nv inf 1 1e99\nf 1 2 3\n").level;
	CHECK(level.positions.at(level.triangles.at(0).x) == glm::dvec3(0.1, 8191.9, 0.0));
}

TEST_CASE("scene: rays and files of a level at map coordinates are those at the origin", "[scene]")
{
	const TemporaryFolder folder;
	const LoadedLevel far = loadText(folder / "far.obj", mapObj());
	Level near = far.level;
	for (glm::dvec3& position : near.positions)
	{
		position -= mapCorner(0);
	}
	const double expected = visibilityNextTo(near, glm::dvec3(0.0));
	CHECK(expected > 0.5);
	CHECK(expected < 0.9);
	CHECK(visibilityNextTo(far.level, mapCorner(0)) == Approx(expected).margin(1e-6));
	writeFile(folder / "again.glb", levelGlb(far.level, "test"));
	const LoadedLevel again = loadLevel(folder / "again.glb", {}, {});
	REQUIRE(again.level.triangles.size() == 12);
	CHECK(areaOf(again.level) == Approx(0.54).epsilon(1e-6));
	CHECK(visibilityNextTo(again.level, mapCorner(0)) == Approx(expected).margin(1e-6));
	CHECK(glbOrigin(boundsOf(far.level)) == glm::dvec3(447000.0, 5411000.0, 120.0));
	CHECK(glbOrigin(boundsOf(near)) == glm::dvec3(0.0));
}

TEST_CASE("scene: PLY properties of every type", "[scene]")
{
	const TemporaryFolder folder;
	const auto first = [&](const std::string& type, const auto& value, bool big_endian)
	{
		std::string text = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
						   "_endian 1.0\nelement vertex 3\nproperty uchar before\nproperty " + type +
						   " x\nproperty double y\nproperty float z\nelement face 1\nproperty list uchar uint "
						   "vertex_indices\nend_header\n";
		for (const double y : {1e6 + 0.1, 0.0, 1.0})
		{
			append(text, uint8_t{9}, big_endian);
			append(text, value, big_endian);
			append(text, y, big_endian);
			append(text, y == 0.0 ? 1.0F : 0.0F, big_endian);
		}
		append(text, uint8_t{3}, big_endian);
		for (const uint32_t corner : {0U, 1U, 2U})
		{
			append(text, corner, big_endian);
		}
		const Level level = loadText(folder / "a.ply", text).level;
		return level.positions.at(level.triangles.at(0).x);
	};
	for (const bool big_endian : {false, true})
	{
		CHECK(first("char", int8_t{-100}, big_endian) == glm::dvec3(-100.0, 1e6 + 0.1, 0.0));
		CHECK(first("uchar", uint8_t{200}, big_endian) == glm::dvec3(200.0, 1e6 + 0.1, 0.0));
		CHECK(first("short", int16_t{-30000}, big_endian).x == -30000.0);
		CHECK(first("ushort", uint16_t{60000}, big_endian).x == 60000.0);
		CHECK(first("int", int32_t{-2000000001}, big_endian).x == -2000000001.0);
		CHECK(first("uint", uint32_t{4000000001U}, big_endian).x == 4000000001.0);
		CHECK(first("float", 0.1F, big_endian).x == static_cast<double>(0.1F));
		CHECK(first("float64", 0.1, big_endian).x == 0.1);
	}
}

TEST_CASE("scene: every truncation of files at map coordinates ends with one line or a level", "[scene]")
{
	const TemporaryFolder folder;
	const std::array<std::pair<const char*, std::string>, 4> files{
		{{"a.obj", mapObj()}, {"a.ply", asciiPly()}, {"b.ply", binaryPly(true)}, {"a.stl", mapStl("a")}}};
	for (const auto& file : files)
	{
		for (std::size_t size = 0; size < file.second.size(); size += 13)
		{
			INFO(file.first << " " << size);
			refusalBy([&] { loadText(folder / file.first, file.second.substr(0, size)); });
		}
	}
}

TEST_CASE("scene: STL solids in any case, with names of several words", "[scene]")
{
	const TemporaryFolder folder;
	std::string upper = mapStl("a");
	std::transform(upper.begin(), upper.end(), upper.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
	checkMapCube(loadText(folder / "a.stl", upper));
	std::string small = cubeStl();
	std::transform(small.begin(), small.end(), small.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
	CHECK(volumeOf(loadText(folder / "a.stl", small).level) == Approx(1.0));
	std::string moved = cubeStl();
	for (std::size_t at = moved.find("vertex "); at != std::string::npos; at = moved.find("vertex ", at + 1))
	{
		moved.insert(at + 7, "1"); // 0 and 1 become 10 and 11
	}
	const std::string name = "fa\xC3\xA7"
							 "ade facet normal vertex 1 endsolid";
	moved.replace(moved.find("box"), 3, name);
	const Level level = loadText(folder / "a.stl", mapStl("x") + moved + cubeStl() + "solid\nendsolid\n").level;
	REQUIRE(level.triangles.size() == 36);
	REQUIRE(level.meshes.size() == 3); // a solid without triangles is no mesh
	CHECK(level.meshes[0].name == "x");
	CHECK(level.meshes[1].name == name);
	CHECK(level.meshes[2].name == "box");
	CHECK(level.meshes[0].triangle_count == 12);
	Level second = level;
	second.triangles.erase(second.triangles.begin() + 24, second.triangles.end());
	second.triangles.erase(second.triangles.begin(), second.triangles.begin() + 12);
	CHECK(boundsOf(second).least == glm::dvec3(10.0, 0.0, 0.0));
	CHECK(volumeOf(second) == Approx(1.0));
}

TEST_CASE("reference: points in a file at map coordinates are taken to their last digit", "[reference]")
{
	const TemporaryFolder folder;
	const LoadedLevel far = loadText(folder / "far.obj", mapObj());
	Level near = far.level;
	for (glm::dvec3& position : near.positions)
	{
		position -= mapCorner(0);
	}
	writeFile(folder / "far.csv", "447000.35,5411000.5,120.3,0,0,1\n447000.39,5411000.5,120.3,1,0,0.5\n");
	writeFile(folder / "near.csv", "-.05,0.1,0.1,0,0,1\n-.01,0.1,0.1,1,0,0.5\n");
	ReferenceSettings settings{.rays = 2048};
	const Tracer far_tracer(far.level, {});
	const Tracer near_tracer(near, {});
	const std::vector<ReferenceValue> there = referenceAtPoints(far_tracer, readPoints(folder / "far.csv"), settings, {});
	const std::vector<ReferenceValue> here = referenceAtPoints(near_tracer, readPoints(folder / "near.csv"), settings, {});
	for (std::size_t i = 0; i < here.size(); ++i)
	{
		CHECK(here[i].visibility < 0.9);
		CHECK(there[i].visibility == Approx(here[i].visibility).margin(1e-6));
	}
}
