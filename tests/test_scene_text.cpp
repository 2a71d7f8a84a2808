// SPDX-License-Identifier: GPL-3.0-or-later
// Strict text formats: numbers and keywords are read; anything else is rejected with its line.
#include "core/error.h"
#include "core/json_reader.h"
#include "core/json_text.h"
#include "scene/mesh_text.h"
#include "scene/reference.h"

#include "level_files.h"
#include "temporary_folder.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <vector>

using namespace nook;

namespace
{

// The error message for a level, without its path.
std::string refusalOf(const std::string& path, const std::string& text)
{
	try
	{
		loadText(path, text);
	}
	catch (const Error& error)
	{
		CHECK(error.code() == ExitCode::invalid_input);
		return std::string(error.what()).substr(path.size() + 2);
	}
	return "nothing";
}

// A triangle with the given first corner; the others are (1, 0, 0) and (0, 1, 0), and an unused fourth.
std::string obj(const std::string& first_vertex, const std::string& rest = "f 1 2 3\n")
{
	return first_vertex + "\nv 1 0 0\nv 0 1 0\nv 7 7 7\n" + rest;
}

std::string ply(const std::string& first_vertex, const std::string& face = "3 0 1 2",
				const std::string& format = "format ascii 1.0\n")
{
	return "ply\n" + format +
		   "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
		   "property list uchar int vertex_indices\nend_header\n" +
		   first_vertex + "\n1 0 0\n0 1 0\n" + face + "\n";
}

std::string stl(const std::string& first_vertex, const std::string& normal = "0 0 1", const std::string& more = "")
{
	return "solid a\nfacet normal " + normal + "\nouter loop\nvertex " + first_vertex + "\nvertex 1 0 0\nvertex 0 1 0\n" + more +
		   "endloop\nendfacet\nendsolid a\n";
}

glm::dvec3 firstCorner(const Level& level)
{
	return level.positions.at(level.triangles.at(0).x);
}

} // namespace

TEST_CASE("scene: words that are numbers, and words that are none", "[scene]")
{
	for (const char* const word :
		 {"0",   "1",   "-1",   "+1",  ".5",        "5.",      "-.5",     "+.5e3",     "1e5",      "1E+05",     "-1.25e-3",
		  "007", "nan", "-NaN", "inf", "-Infinity", "1.#QNAN", "-1.#IND", "1.#INF000", "nan(ind)", "-nan(snan)"})
	{
		INFO(word);
		CHECK(isNumberText(word));
		CHECK(isNumberText(plainNumber(word)));
	}
	for (const char* const word : {"",     "-",   "+",  ".",   "-.",  "e5", ".e5", "1e",   "1e+", "0,5",  "1.5.2",
								   "0x10", "1d3", "1f", "--1", "+-1", "1 ", "one", "nano", "1.#", "1.#X", "#"})
	{
		INFO(word);
		CHECK_FALSE(isNumberText(word));
	}
	CHECK(plainNumber("-.5") == "-0.5");
	CHECK(plainNumber("-1.#IND") == "-nan");
	CHECK(plainNumber("+1.") == "+1.");
	for (const auto& [word, value] : {std::pair{"-.5", -0.5},
									  {"+1.", 1.0},
									  {"1E+05", 1e5},
									  {"4649776.1234567890123", 4649776.1234567890123},
									  {"-1e999", -std::numeric_limits<double>::infinity()},
									  {"1e-999", 0.0},
									  {"1.#INF000", std::numeric_limits<double>::infinity()},
									  {"-Infinity", -std::numeric_limits<double>::infinity()}})
	{
		INFO(word);
		CHECK(numberOf(word) == value);
	}
	CHECK(numberOf("0." + std::string(400, '0') + "1") == 0.0);
	CHECK(std::isinf(numberOf(std::string(400, '9'))));
	for (const char* const word : {"nan", "-NaN", "1.#QNAN", "-1.#IND", "nan(ind)"})
	{
		CHECK(std::isnan(numberOf(word)));
	}
	CHECK(wholeOf("-12") == -12);
	CHECK(wholeOf("+012") == 12);
	for (const char* const word : {"", "+", "+-1", "1.", "4294967296", "1x"})
	{
		CHECK_FALSE(wholeOf(word));
	}
}

TEST_CASE("scene: OBJ numbers in all their spellings", "[scene]")
{
	const TemporaryFolder folder;
	const auto cornerOf = [&](const std::string& vertex)
	{
		INFO(vertex);
		return firstCorner(loadText(folder / "a.obj", obj(vertex)).level);
	};
	CHECK(cornerOf("v .5 -.25 0") == glm::dvec3(0.5, -0.25, 0.0));
	CHECK(cornerOf("v 5. +1 -.5e3") == glm::dvec3(5.0, 1.0, -500.0));
	CHECK(cornerOf("v .5 .5 .5 .5 .5 .5") == glm::dvec3(0.5)); // a colour after it
	CHECK(cornerOf("v 2 3 4 0.1 0.2 0.3 1") == glm::dvec3(2.0, 3.0, 4.0));
	CHECK(cornerOf("v 2 4 6 2") == glm::dvec3(1.0, 2.0, 3.0)); // a weight
	CHECK(cornerOf("v 2 3 4 # 5 6 7") == glm::dvec3(2.0, 3.0, 4.0));
	CHECK(cornerOf(" \tv 2 3 4") == glm::dvec3(2.0, 3.0, 4.0));
	CHECK(cornerOf("v 2 \\\n 3 \\\r\n .5") == glm::dvec3(2.0, 3.0, 0.5));
	const auto refused = [&](const std::string& vertex)
	{
		return refusalOf(folder / "a.obj", "# a comment\n" + obj(vertex));
	};
	CHECK(refused("v 0,5 0 0") == "line 2: found '0,5', expected a number");
	for (const char* const word : {"0x10", "1.0D+01", "1f", "abc", "1.2.3", "--1", "1_0", "#"})
	{
		INFO(word);
		CHECK(refused("v 0 0 " + std::string(word)).starts_with("line 2: found"));
	}
	CHECK(refused("v 0 0") == "line 2: found 2 numbers, expected x y z, a weight behind them or a colour");
	CHECK(refused("v 0 0 0 1 1").starts_with("line 2: found 5 numbers"));
	CHECK(refused("v 0 0 0\nvt 0,5 0").starts_with("line 3: found '0,5'"));
	CHECK(refused("v 0 0 0\nvn 0 0 1x").starts_with("line 3: found '1x'"));
	CHECK(refused("v 0 \\\n0 \\\n0\nvn 0 0").starts_with("line 5: found 2 numbers"));
}

TEST_CASE("scene: OBJ values that are not finite are found, however they are spelled", "[scene]")
{
	const TemporaryFolder folder;
	for (const char* const word : {"nan", "-nan", "inf", "-inf", "1.#QNAN", "-1.#IND", "nan(ind)"})
	{
		INFO(word);
		const LoadedLevel loaded = loadText(folder / "a.obj", obj("v 0 0 " + std::string(word), "f 1 2 3\nf 2 3 4\n"));
		CHECK(findingsOf(loaded.diagnosis) == "non-finite-vertices 1 dropped");
	}
}

TEST_CASE("scene: OBJ corners, texture coordinates and lines of other kinds", "[scene]")
{
	const TemporaryFolder folder;
	const std::string vt = "vt .5 .25\nvt 1\nvt 0 1 0\nvn 0 0 1\n";
	for (const char* const face : {"f 1 2 3", "f +1 02 3", "f -4 -3 -2", "f 1/1 2/2 3/3", "f 1/1/1 2/2/1 3/3/1", "f 1//1 2//1 3//1",
								   "f 1/ 2/ 3//", "f 1/01/+1 2/2/1 3/3/1", "f 1 2 3 # 4", "f 1 2 \\\n3", "\tf 1 2 3"})
	{
		INFO(face);
		const LoadedLevel loaded = loadText(folder / "a.obj", obj("v .5 0 0", vt + face + "\n"));
		CHECK(loaded.level.triangles.size() == 1);
		CHECK(firstCorner(loaded.level).x == 0.5);
		CHECK(findingsOf(loaded.diagnosis).empty());
	}
	const Level textured = loadText(folder / "a.obj", obj("v 0 0 0", vt + "f 1/1 2/2 3/3\n")).level;
	CHECK(textured.uvs.at(textured.triangles[0].x) == glm::vec2(0.5F, 0.75F));
	CHECK(textured.uvs.at(textured.triangles[0].y) == glm::vec2(1.0F, 1.0F));
	for (const char* const corner : {"1.0", "1,2", "a", "1/2/3/4", "/1", "1/x", "99999999999"})
	{
		INFO(corner);
		const std::string found = refusalOf(folder / "a.obj", obj("v 0 0 0", vt + "f " + corner + " 2 3\n"));
		CHECK(found == "line 9: found '" + std::string(corner) + "', expected an index, or two or three with / between them");
	}
	// Keywords of curves, of other programs, and unknown ones; Assimp only reads the first letter.
	for (const char* const line : {"lod 5", "parm u 0 1", "fo 1 2 3", "vx 9 9 9", "vnx 0 0 1", "vp 1 2", "cstype bspline",
								   "V 9 9 9", "l", "usemap off", "shadow_obj x.obj", "# c:\\x\\"})
	{
		INFO(line);
		const std::string text = obj("v .5 0 0\n" + std::string(line) + (line[0] == '#' ? "\n" : ""));
		const LoadedLevel loaded = loadText(folder / "a.obj", text);
		CHECK(loaded.level.triangles.size() == 1);
		CHECK(firstCorner(loaded.level).x == 0.5);
	}
}

TEST_CASE("scene: MTL keywords of all kinds, and opacities that are none", "[scene]")
{
	const TemporaryFolder folder;
	writeFile(folder / "rows.png", rowsPng());
	const auto level = [&](const std::string& lines)
	{
		writeFile(folder / "a.mtl", "newmtl a\n" + lines + "\n");
		return loadText(folder / "a.obj", "mtllib a.mtl\nusemtl a\n" + cubeObj());
	};
	for (const char* const line : {"aniso 0.5",
								   "anisor 0.5",
								   "Pr .5",
								   "Pm 0.5",
								   "Ps 0.5",
								   "Pc 0.5",
								   "Pcr 0.5",
								   "Ke 0 0 0",
								   "norm n.png",
								   "map_Pr n.png",
								   "map_Pm n.png",
								   "map_Ps n.png",
								   "map_Ke n.png",
								   "map_Ks n.png",
								   "map_aat on",
								   "map_decal rows.png",
								   "map_disp rows.png",
								   "decal rows.png",
								   "disp rows.png",
								   "bump -bm 0.5 n.png",
								   "Tf spectral a.rfl 1",
								   "Kd spectral a.rfl 1",
								   "Kd xyz 1 1 1",
								   "Ka xyz 1",
								   "sharpness 60",
								   "Ni 1.5",
								   "illum 2",
								   "refl -type sphere a.png",
								   "adsk_mat 1",
								   "alpha_to_mask on"})
	{
		INFO(line);
		const LoadedLevel loaded = level(line);
		CHECK(findingsOf(loaded.diagnosis).empty());
		CHECK(loaded.level.material_list.at(loaded.level.materials[0]).name == "a");
		CHECK(loaded.level.material_list.at(loaded.level.materials[0]).alpha_mode == AlphaMode::opaque);
	}
	for (const char* const line : {"d .25", "d +0.25", "d 0.25 # a comment", "d -halo 0.25", "Tr .75", "\td 0.25"})
	{
		INFO(line);
		const Level found = level(line).level;
		CHECK(found.material_list.at(found.materials[0]).alpha == Approx(0.25));
	}
	CHECK(level("map_d rows.png").level.masks.size() == 1);
	for (const char* const line : {"d 0,5", "d", "d abc", "Tr 0.5x", "d -halo"})
	{
		INFO(line);
		writeFile(folder / "a.mtl", "newmtl a\n" + std::string(line) + "\n");
		writeFile(folder / "a.obj", "mtllib a.mtl\nusemtl a\n" + cubeObj());
		try
		{
			loadLevel(folder / "a.obj", {}, {});
			FAIL("no error");
		}
		catch (const Error& error)
		{
			CHECK(error.code() == ExitCode::invalid_input);
			CHECK(std::string(error.what()).starts_with(folder / "a.mtl: line 2: found "));
		}
	}
}

TEST_CASE("scene: PLY formats, versions and numbers", "[scene]")
{
	const TemporaryFolder folder;
	CHECK(firstCorner(loadText(folder / "a.ply", ply(".5 -.5e1 +1.")).level) == glm::dvec3(0.5, -5.0, 1.0));
	CHECK(loadText(folder / "a.ply", ply("0 0 0", "3 +0 01 2")).level.triangles.size() == 1);
	CHECK(loadText(folder / "a.ply", ply("0 0 0", "3 0 1 2", "format ascii 1.0 \ncomment\n")).level.triangles.size() == 1);
	std::string blanks = ply("0 0 0");
	blanks.insert(blanks.find("end_header") + 10, " ");
	CHECK(loadText(folder / "a.ply", blanks).level.triangles.size() == 1);
	for (const char* const format :
		 {"format binary_middle_endian 1.0\n", "format binary 1.0\n", "format ascii 2.0\n", "format ascii 1\n", "format ascii\n",
		  "format ASCII 1.0\n", "format ascii 1.0 x\n", "format\n", "format ascii 1.0\nformat ascii 1.0\n"})
	{
		INFO(format);
		CHECK(refusalOf(folder / "a.ply", ply("0 0 0", "3 0 1 2", format)).starts_with("header, line "));
	}
	CHECK(refusalOf(folder / "a.ply", ply("0 0 0", "3 0 1 2", "")) ==
		  "header, line 8: found no format, expected the line that says it");
	CHECK(refusalOf(folder / "a.ply", ply("0,5 0 0")).find(": found '0,5', expected a number") != std::string::npos);
	for (const char* const word : {"0x1", "abc", "1.0D3", "1,"})
	{
		INFO(word);
		CHECK(refusalOf(folder / "a.ply", ply("0 0 " + std::string(word))).starts_with("byte "));
	}
	CHECK(refusalOf(folder / "a.ply", ply("0 0 0", "3 0 1.5 2")).find("found '1.5', expected a whole number") != std::string::npos);
	CHECK(refusalOf(folder / "a.ply", ply("0 0 0", "3 0 b 2")).find("found 'b', expected a whole number") != std::string::npos);
}

TEST_CASE("scene: points with signs", "[scene]")
{
	const TemporaryFolder folder;
	writeFile(folder / "a.csv", "+1,-2,.5,0,+1.,0\n");
	const std::vector<ReferencePoint> points = readPoints(folder / "a.csv");
	REQUIRE(points.size() == 1);
	CHECK(points[0].position == glm::dvec3(1.0, -2.0, 0.5));
	for (const char* const field : {"+", "+-1", "--1", "0x1", "1f"})
	{
		INFO(field);
		writeFile(folder / "a.csv", std::string(field) + ",0,0,0,1,0\n");
		CHECK_THROWS_AS(readPoints(folder / "a.csv"), Error);
	}
}

TEST_CASE("scene: base64 ends where it says", "[scene]")
{
	const TemporaryFolder folder;
	nlohmann::json json = parseJson(gltfText(cubeGltf()), "a.gltf");
	const std::string uri = json["buffers"][0]["uri"];
	REQUIRE(uri.ends_with("="));
	for (const char* const more : {"AAAA", "===", "=A", "\n"})
	{
		INFO(more);
		json["buffers"][0]["uri"] = uri + more;
		CHECK(refusalOf(folder / "a.gltf", jsonLine(json)).starts_with("buffers[0].uri: found"));
	}
	json["buffers"][0]["uri"] = uri.substr(0, uri.find_last_not_of('=') + 1); // some writers omit the padding
	CHECK(loadText(folder / "a.gltf", jsonLine(json)).level.triangles.size() == 12);
}

TEST_CASE("scene: STL numbers and corners", "[scene]")
{
	const TemporaryFolder folder;
	CHECK(firstCorner(loadText(folder / "a.stl", stl(".5 -.5e1 +1.")).level) == glm::dvec3(0.5, -5.0, 1.0));
	CHECK(findingsOf(loadText(folder / "a.stl", stl("0 0 0", "nan nan -nan")).diagnosis) == "bad-normals 3 repaired");
	CHECK(refusalOf(folder / "a.stl", stl("0,5 0 0")) == "line 4: found '0,5', expected a number");
	CHECK(refusalOf(folder / "a.stl", stl("0 0 0", "0 0 1,0")) == "line 2: found '1,0', expected a number");
	CHECK(refusalOf(folder / "a.stl", stl("0 0")) == "line 4: found 2 numbers, expected x y z");
	CHECK(refusalOf(folder / "a.stl", stl("0 0 0 0")) == "line 4: found 4 numbers, expected x y z");
	CHECK(refusalOf(folder / "a.stl", stl("0 0 0", "0 0 1", "vertex 1 1 0\n")) == "line 9: found 4 corners of a facet, expected 3");
}
