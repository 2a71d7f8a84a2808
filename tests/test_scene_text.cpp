// SPDX-License-Identifier: GPL-3.0-or-later
// Strict text formats: numbers and keywords are read; anything else is rejected with its line.
#include "level_files.h"
#include "testing.h"

#include "scene/mesh_text.h"
#include "scene/reference.h"

namespace
{

// The error message for a level, without its path.
std::string refusalOf(const std::string& path, const std::string& text)
{
	const std::string message = refusalBy([&] { loadText(path, text); });
	return message.empty() ? "nothing" : message.substr(path.size() + 2);
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

class Folder
{
public:
	Folder()
	{
		// Red and green differ from left to right, blue is in between.
		constexpr std::array<uint8_t, 6> kTexels{255, 0, 128, 0, 255, 128};
		const std::string png = pngBytes(2, 1, std::span<const uint8_t>(kTexels), {});
		writeFile(m_folder / "two.png", png);
		writeFile(m_folder / "my leaf.png", png);
		writeFile(m_folder / "rows.png", rowsPng());
	}

	// The cube with one material defined by these lines.
	LoadedLevel load(const std::string& lines, const LoadSettings& settings = {}) const
	{
		writeFile(m_folder / "a.mtl", "newmtl a\n" + lines + "\n");
		return loadText(m_folder / "a.obj", "mtllib a.mtl\nusemtl a\n" + cubeObj(), settings);
	}

	// The error message for such a level, without the file's name.
	std::string refusalOf(const std::string& lines, ExitCode code = ExitCode::invalid_input) const
	{
		const std::string message = refusalBy([&] { load(lines); }, code);
		return message.empty() ? "nothing" : message.substr((m_folder / "a.mtl: ").size());
	}

private:
	TemporaryFolder m_folder;
};

const Material& materialOf(const Level& level)
{
	return level.material_list.at(level.materials.at(0));
}

} // namespace

TEST_CASE("scene: words that are numbers, and words that are none", "[scene]")
{
	for (const char* const word :
		 {"0",   "1",   "-1",   "+1",  ".5",        "5.",      "-.5",     "+.5e3",     "1e5",      "1E+05",     "-1.25e-3",
		  "007", "nan", "-NaN", "inf", "-Infinity", "1.#QNAN", "-1.#IND", "1.#INF000", "nan(ind)", "-nan(snan)"})
	{
		INFO(word);
		CHECK(numberOf(word));
	}
	for (const char* const word : {"",     "-",   "+",  ".",   "-.",  "e5", ".e5", "1e",   "1e+", "0,5",  "1.5.2",
								   "0x10", "1d3", "1f", "--1", "+-1", "1 ", "one", "nano", "1.#", "1.#X", "#"})
	{
		INFO(word);
		CHECK_FALSE(numberOf(word));
	}
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
	CHECK(std::isinf(numberOf(std::string(400, '9')).value()));
	for (const char* const word : {"nan", "-NaN", "1.#QNAN", "-1.#IND", "nan(ind)"})
	{
		CHECK(std::isnan(numberOf(word).value()));
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
	const char* const word = GENERATE(as<const char*>{}, "nan", "-nan", "inf", "-inf", "1.#QNAN", "-1.#IND", "nan(ind)");
	INFO(word);
	const LoadedLevel loaded = loadText(folder / "a.obj", obj("v 0 0 " + std::string(word), "f 1 2 3\nf 2 3 4\n"));
	CHECK(findingsOf(loaded.diagnosis) == "non-finite-vertices 1 dropped");
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
	// Keywords of curves, of other programs, and unknown ones.
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
		CHECK(refusalBy([&] { loadLevel(folder / "a.obj", {}, {}); }).starts_with(folder / "a.mtl: line 2: found "));
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
	const char* const field = GENERATE(as<const char*>{}, "+", "+-1", "--1", "0x1", "1f");
	INFO(field);
	writeFile(folder / "a.csv", std::string(field) + ",0,0,0,1,0\n");
	CHECK_THROWS_AS(readPoints(folder / "a.csv"), Error);
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

// MTL files: combinations of d and Tr, and the options of map_d.

TEST_CASE("scene: d and Tr of MTL in any order, and Tr as opacity", "[scene]")
{
	const Folder folder;
	constexpr const char* kInverted = "inverted-transparency 1 repaired";
	struct Case
	{
		const char* lines;
		double opacity;
		const char* findings;
		TrMeaning tr = TrMeaning::automatic;
	};
	for (const Case& one : {
			 Case{"Tr 1.000000", 1.0, kInverted},
			 Case{"Tr 0.3", 0.7, ""},
			 Case{"tr 0.999", 0.001, ""},
			 Case{"Tr 0", 1.0, ""},
			 Case{"d 1\nTr 1", 1.0, kInverted},
			 Case{"Tr 1.0\nd 1.0", 1.0, kInverted},
			 Case{"d 1\nTr 0", 1.0, ""},
			 Case{"Tr 0\nd 1", 1.0, ""},
			 Case{"d 0.4\nTr 0.6", 0.4, ""},
			 Case{"Tr 0.667\nd 0.3333", 0.3333, ""},
			 Case{"d 0.4\nTr 0.4", 0.4, kInverted},
			 Case{"Tr 1\nd 0", 0.0, ""},
			 Case{"d 0", 0.0, ""},
			 Case{"Tr 1", 0.0, "", TrMeaning::transparency},
			 Case{"Tr 1", 1.0, "", TrMeaning::opacity},
			 Case{"Tr 0.3", 0.3, "", TrMeaning::opacity},
			 Case{"Tr 0", 0.0, "", TrMeaning::opacity},
			 Case{"d 0.4\nTr 0.4", 0.4, "", TrMeaning::opacity},
			 Case{"d 0.4", 0.4, "", TrMeaning::opacity},
			 Case{"Kd 1 1 1", 1.0, "", TrMeaning::opacity},
		 })
	{
		INFO(one.lines);
		LoadSettings settings;
		settings.tr = one.tr;
		const LoadedLevel loaded = folder.load(one.lines, settings);
		CHECK(materialOf(loaded.level).alpha == Approx(one.opacity).margin(1e-6));
		CHECK(materialOf(loaded.level).alpha_mode == (one.opacity < 1.0 ? AlphaMode::blend : AlphaMode::opaque));
		CHECK(findingsOf(loaded.diagnosis) == one.findings);
	}
	const LoadedLevel two = folder.load("Tr 1\nnewmtl b\nTr 1\nmap_d rows.png\nnewmtl c\nTr 0.5");
	REQUIRE(findingsOf(two.diagnosis) == "inverted-transparency 2 repaired");
	CHECK(two.diagnosis.findings[0].first == "material 'a'");
	CHECK(folder.refusalOf("Tr 2") == "line 2: found '2', expected 0 to 1 behind Tr");
	for (const char* const lines : {"Tr -1", "Tr nan", "Tr inf", "d 1.5", "d -0.1", "d nan", "Tr", "d 1\nTr 2"})
	{
		INFO(lines);
		CHECK(folder.refusalOf(lines).starts_with("line "));
	}
}

TEST_CASE("scene: the channel, base and gain that map_d asks for", "[scene]")
{
	const Folder folder;
	const auto alphas = [&](const std::string& options)
	{
		const LoadedLevel loaded = folder.load("map_d " + options + " two.png");
		CHECK(findingsOf(loaded.diagnosis).empty());
		const Mask& mask = loaded.level.masks.at(0);
		CHECK(mask.name == "two.png");
		return std::vector<int>(mask.alpha.begin(), mask.alpha.end());
	};
	using Alphas = std::vector<int>;
	CHECK(alphas("") == Alphas{255, 0});
	CHECK(alphas("-imfchan r") == Alphas{255, 0});
	CHECK(alphas("-imfchan g") == Alphas{0, 255});
	CHECK(alphas("-imfchan B") == Alphas{128, 128});
	CHECK(alphas("-imfchan m") == Alphas{255, 255}); // no alpha channel, so it is opaque
	CHECK(alphas("-imfchan l") == Alphas{63, 192});  // 0.2126 × 255 + 0.0722 × 128, 0.7152 × 255 + 0.0722 × 128
	CHECK(alphas("-mm 0.2 0.5") == Alphas{179, 51});
	CHECK(alphas("-mm 1 -1") == Alphas{0, 255});
	CHECK(alphas("-imfchan g -mm 0.5 1") == Alphas{128, 255});         // clamped to opaque
	const Level rows = folder.load("map_d -imfchan r rows.png").level; // its alpha channel is not selected
	CHECK(rows.masks.at(0).alpha.at(0) == rows.masks.at(0).alpha.back());
	CHECK(folder.load("map_d -imfchan m rows.png").level.masks.at(0).alpha.at(0) == 0);
	const Level both = folder
						   .load("map_d two.png\nnewmtl b\nmap_d -mm 1 -1 two.png\nnewmtl c\nmap_d -imfchan g two.png\n"
								 "newmtl d\nmap_d -s 2 2 two.png")
						   .level;
	REQUIRE(both.masks.size() == 3);
	CHECK(both.masks[0].alpha == std::vector<uint8_t>{255, 0});
	CHECK(both.masks[1].alpha == std::vector<uint8_t>{0, 255});
	CHECK(both.masks[2].alpha == std::vector<uint8_t>{0, 255});
}

TEST_CASE("scene: scale, offset and clamping of map_d, in any order", "[scene]")
{
	const Folder folder;
	const auto check = [&](const std::string& options, glm::dvec2 scale, glm::dvec2 offset, Wrap wrap)
	{
		INFO(options);
		const LoadedLevel loaded = folder.load("map_d " + options);
		CHECK(findingsOf(loaded.diagnosis).empty());
		const Level& level = loaded.level;
		CHECK(level.masks.at(0).wrap_u == wrap);
		CHECK(level.masks.at(0).wrap_v == wrap);
		for (std::size_t i = 0; i < level.positions.size(); ++i)
		{
			// The cube's coordinates are (x, y), v upward; a level's v grows downward.
			const glm::dvec3 p = level.positions[i];
			CHECK(static_cast<double>(level.uvs[i].x) == Approx(scale.x * p.x + offset.x).margin(1e-6));
			CHECK(1.0 - static_cast<double>(level.uvs[i].y) == Approx(scale.y * p.y + offset.y).margin(1e-6));
		}
	};
	check("two.png", {1.0, 1.0}, {0.0, 0.0}, Wrap::repeat);
	check("-s 0.1 1 1 two.png", {0.1, 1.0}, {0.0, 0.0}, Wrap::repeat);
	check("-s 2 two.png", {2.0, 1.0}, {0.0, 0.0}, Wrap::repeat);
	check("-o .25 -.5 two.png", {1.0, 1.0}, {0.25, -0.5}, Wrap::repeat);
	check("-s 2 -3 1 -o 0.25 0.5 0 -clamp on my leaf.png", {2.0, -3.0}, {0.25, 0.5}, Wrap::clamp);
	check("-O 0.25 0.5 -bm 1 -imfchan g -blendu on -t 0 0 0 -Clamp ON -mm 0 1 -s 2 3 -cc off my leaf.png  ", {2.0, 3.0},
		  {0.25, 0.5}, Wrap::clamp);
	check("-clamp off two.png", {1.0, 1.0}, {0.0, 0.0}, Wrap::repeat);
	CHECK(findingsOf(folder.load("map_Kd -s 2 2 2 -o 1 1 two.png").diagnosis).empty());
	CHECK(findingsOf(folder.load("map_Kd -s 0 0 0 -foo two.png\nmap_Kd").diagnosis).empty()); // its contents are not read
	CHECK(findingsOf(folder.load("map_Kd -clamp on absent one.png").diagnosis) == "missing-file 1 ignored");
}

TEST_CASE("scene: options of map_d that are not applied are found, broken ones refused", "[scene]")
{
	const Folder folder;
	for (const char* const options : {"-t 0.1 0 0", "-blendu off", "-blendv off", "-cc on", "-texres 256", "-type sphere", "-bm 2"})
	{
		INFO(options);
		const LoadedLevel loaded = folder.load("map_d -s 2 2 " + std::string(options) + " two.png");
		REQUIRE(findingsOf(loaded.diagnosis) == "not-applied 1 ignored");
		const std::string option = std::string(options).substr(0, std::string_view(options).find(' '));
		CHECK(loaded.diagnosis.findings[0].first == "material 'a', map_d " + option);
	}
	CHECK(folder.refusalOf("map_d -s 0 0 0 two.png") == "line 2: found a scale of 0, expected another number behind -s");
	CHECK(folder.refusalOf("map_d -s nan two.png") == "line 2: found 'nan', expected a number behind -s");
	CHECK(folder.refusalOf("map_d") == "line 2: found nothing, expected the name of a file behind map_d");
	for (const char* const options : {"-s 1 1 1", "-s two.png", "-s", "-s 1e99 two.png", "-o inf two.png", "-clamp maybe two.png",
									  "-clamp", "-imfchan x two.png", "-imfchan", "-mm 1 two.png", "-mm 1 a two.png",
									  "-foo two.png", "-s 1 0 two.png", "-texres two.png"})
	{
		INFO(options);
		CHECK(folder.refusalOf("map_d " + std::string(options)).starts_with("line 2: found "));
	}
	CHECK(folder.refusalOf("map_d -imfchan z two.png", ExitCode::unsupported).starts_with("line 2: found the channel z"));
}

TEST_CASE("scene: MTL names of any length, with blanks and signs", "[scene]")
{
	const TemporaryFolder folder;
	const std::string name = "a #b" + std::string(5000, 'c');
	writeFile(folder / "a.mtl", "newmtl glass\nd 0.5\nnewmtl " + name + "d\nd 0.5\nnewmtl " + name + "\nd 0.25\n");
	const Level level = loadText(folder / "a.obj", "mtllib a.mtl\nusemtl " + name + "\n" + cubeObj()).level;
	CHECK(materialOf(level).alpha == 0.25);
	CHECK(materialOf(level).name == name);
}

TEST_CASE("scene: OBJ objects, groups and materials are parts in the file's order", "[scene]")
{
	const TemporaryFolder folder;
	const LoadedLevel loaded = loadText(
		folder / "a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl a\nf 1 2 -1\no House two\nf 1 3 2\ng Floor\n"
						  "usemtl a\nl 1 2 3\nf 1 4 2\nusemtl b\nf 2 3 4\no House two\ng Roof\nf 2/9 4/-9 3//9\n");
	std::string parts;
	for (const Mesh& mesh : loaded.level.meshes)
	{
		const uint32_t material = loaded.level.materials.at(mesh.first_triangle);
		parts += mesh.name + ": " + loaded.level.material_list.at(material).name + ", ";
	}
	CHECK(parts == "defaultobject: DefaultMaterial, a: a, House two: a, Floor: a, b: b, Roof: b, ");
	CHECK(findingsOf(loaded.diagnosis).starts_with("points-or-lines 2 dropped, coincident-faces"));
	CHECK(refusalOf(folder / "a.obj", obj("v 0 0 0", "f 1 2 5\n")) == "line 5: found '5', expected one of 4 vertices");
	CHECK(refusalOf(folder / "a.obj", obj("v 0 0 0", "f 1 2 -5\n")) == "line 5: found '-5', expected one of 4 vertices");
	CHECK(refusalOf(folder / "a.obj", obj("v 0 0 0", "f 1 2 0\n")).starts_with("line 5: found '0'"));
}
