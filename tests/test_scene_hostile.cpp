// SPDX-License-Identifier: GPL-3.0-or-later
// Broken and hostile level files: a level with its diagnosis, or one error; never a crash, a hang, or gigabytes.
#include "level_files.h"
#include "testing.h"

#include <sys/stat.h>

namespace
{

// "" for a level, the code for an error; anything else fails the test.
std::string outcomeOf(const std::string& path)
{
	try
	{
		const LoadedLevel loaded = loadLevel(path, {}, {});
		for (const glm::uvec3& t : loaded.level.triangles)
		{
			for (int corner = 0; corner < 3; ++corner)
			{
				const glm::dvec3 p = loaded.level.positions.at(t[corner]);
				REQUIRE(std::isfinite(p.x + p.y + p.z));
			}
		}
		REQUIRE(loaded.level.triangles.size() == loaded.level.materials.size());
		REQUIRE_FALSE(loaded.level.triangles.empty());
		return std::to_string(loaded.level.triangles.size()) + " " + findingsOf(loaded.diagnosis);
	}
	catch (const Error& error)
	{
		INFO(error.what());
		REQUIRE(
			(error.code() == ExitCode::file || error.code() == ExitCode::invalid_input || error.code() == ExitCode::unsupported));
		REQUIRE(std::string(error.what()).find(path) == 0);
		REQUIRE(std::string(error.what()).find('\n') == std::string::npos);
		return "error " + std::to_string(static_cast<int>(error.code()));
	}
}

std::string sharedScenes()
{
	const char* const given = std::getenv("NOOK_SHARED");
	return given != nullptr ? std::string(given) + "/scenes" : std::string(NOOK_SOURCE_DIR) + "/../shared/scenes";
}

// The error message for a glTF.
std::string refusalOf(const TemporaryFolder& folder, const nlohmann::json& json, const std::string& buffer = cubeBuffer())
{
	try
	{
		loadText(folder / "a.gltf", gltfText(json, buffer));
	}
	catch (const Error& error)
	{
		CHECK((error.code() == ExitCode::invalid_input || error.code() == ExitCode::unsupported));
		return std::string(error.what()).substr((folder / "a.gltf").size() + 2);
	}
	return "nothing";
}

} // namespace

TEST_CASE("scene: every truncation of a file is a level or an error", "[scene]")
{
	const TemporaryFolder folder;
	const std::string glb = glbBytes(cubeGltf(), cubeBuffer());
	for (const auto& [name, whole] : {std::pair{"a.glb", glb}, {"a.obj", cubeObj()}, {"a.ply", cubePly()}})
	{
		std::size_t levels = 0;
		// Each part of an OBJ takes a process to read; its lines are similar.
		const std::size_t step = name == std::string("a.obj") ? 3 : 1;
		for (std::size_t size = 0; size < whole.size(); size += step)
		{
			std::string part = whole.substr(0, size);
			if (part.size() >= 12 && part.starts_with("glTF"))
			{
				// Corrects the length in the header, so that the contents are read.
				const auto length = static_cast<uint32_t>(size);
				std::memcpy(part.data() + 8, &length, sizeof length);
			}
			INFO(name << " of " << size << " bytes");
			writeFile(folder / name, part);
			levels += outcomeOf(folder / name).starts_with("error") ? 0U : 1U;
		}
		CHECK((name == std::string("a.obj") || levels <= 4)); // lines of an OBJ are independent
	}
}

TEST_CASE("scene: files with some bytes changed are a level or an error", "[scene]")
{
	const TemporaryFolder folder;
	Random random(1);
	const std::string glb = glbBytes(cubeGltf(), cubeBuffer());
	for (const auto& [name, whole] : {std::pair{"a.glb", glb},
									  {"a.obj", cubeObj()},
									  {"a.ply", cubePly()},
									  {"a.stl", cubeStl()},
									  {"a.fbx", cubeFbx(true, 1.0)},
									  {"a.gltf", gltfText(cubeGltf())}})
	{
		for (int round = 0; round < 60; ++round)
		{
			std::string changed = whole;
			for (int i = 0; i < 3; ++i)
			{
				changed[static_cast<std::size_t>(random.below(static_cast<uint32_t>(changed.size())))] =
					static_cast<char>(static_cast<unsigned char>(random.below(256)));
			}
			INFO(name << " round " << round);
			writeFile(folder / name, changed);
			outcomeOf(folder / name);
		}
	}
}

TEST_CASE("scene: the structure of glTF is checked before anything relies on it", "[scene]")
{
	const TemporaryFolder folder;
	const auto with = [](const std::string& pointer, const nlohmann::json& value)
	{
		nlohmann::json json = cubeGltf();
		json[nlohmann::json::json_pointer(pointer)] = value;
		return json;
	};
	const auto starts = [&](const nlohmann::json& json, const std::string& expected)
	{
		const std::string found = refusalOf(folder, json);
		INFO("found '" << found << "', expected '" << expected << "'");
		CHECK(found.starts_with(expected));
	};
	starts(with("/nodes/0/children", {0}), "nodes[0].children: found a circle of nodes");
	starts(with("/nodes", {{{"children", {1, 1}}}, {{"mesh", 0}}}), "nodes[0].children: found node 1");
	starts(with("/nodes/0/mesh", 1), "nodes[0].mesh: found 1, expected a whole number from 0 to 0");
	starts(with("/nodes/0/mesh", -1), "nodes[0].mesh: found -1");
	starts(with("/nodes/0/mesh", "cube"), "nodes[0].mesh: found \"cube\"");
	starts(with("/nodes/0/matrix", {1, 2, 3}), "nodes[0].matrix: found an array of 3");
	starts(with("/scene", 3), "scene: found 3");
	starts(with("/asset/version", "1.0"), "asset.version: found \"1.0\"");
	starts(with("/accessors/0/count", 9), "accessors[0].bufferView: found a view of 96 bytes, 12 apart, expected 108 bytes");
	starts(with("/accessors/0/count", 4e9), "accessors[0].count: found");
	starts(with("/accessors/0/count", 4000000000U), "accessors[0].count: found 4000000000");
	starts(with("/accessors/0/type", "VEC5"), "accessors[0].type: found \"VEC5\"");
	starts(with("/accessors/2/type", "VEC3"), "accessors[2].bufferView: found a view of 72 bytes");
	starts(with("/bufferViews/2/byteLength", 73), "bufferViews[2].byteLength: found bytes 160 to 233, expected an end by byte 232");
	starts(with("/bufferViews/2/byteOffset", 1000000000000000000), "bufferViews[2].byteOffset: found");
	starts(with("/meshes/0/primitives/0/mode", 9), "meshes[0].primitives[0].mode: found 9");
	starts(with("/meshes/0/primitives/0/attributes/TEXCOORD_0", 0),
		   "meshes[0].primitives[0].attributes.TEXCOORD_0: found an accessor");
	starts(with("/extensionsRequired", {"KHR_meshopt_compression"}), "extensionsRequired: found \"KHR_meshopt_compression\"");
	nlohmann::json json = cubeGltf();
	json["accessors"][0].erase("bufferView");
	json["accessors"][0]["count"] = 100000000;
	starts(json, "accessors: found 1200000000 bytes that no buffer holds");
	json = cubeGltf();
	for (int i = 0; i < 2000; ++i)
	{
		json["nodes"].push_back({{"children", {i + 2}}});
	}
	json["nodes"].push_back({{"mesh", 0}});
	starts(json, "nodes[514]: found more than 512 nodes above it");
	CHECK(refusalOf(folder, cubeGltf(), cubeBuffer()) == "nothing");
}

TEST_CASE("scene: instances do not multiply without end", "[scene]")
{
	const TemporaryFolder folder;
	nlohmann::json json = cubeGltf();
	// Shares 36 indices in 1000 primitives, the mesh in 10000 nodes: 120 million triangles from half a megabyte.
	json["nodes"] = nlohmann::json::array();
	json["scenes"][0]["nodes"] = nlohmann::json::array();
	for (int i = 0; i < 10000; ++i)
	{
		json["nodes"].push_back({{"mesh", 0}});
		json["scenes"][0]["nodes"].push_back(i);
	}
	for (int i = 1; i < 1000; ++i)
	{
		json["meshes"][0]["primitives"].push_back(json["meshes"][0]["primitives"][0]);
	}
	const std::string found = refusalOf(folder, json);
	INFO(found);
	CHECK(found.starts_with("found 120000000 triangles"));
}

TEST_CASE("scene: many names, lists and pictures take no longer than their number", "[scene]")
{
	const TemporaryFolder folder;
	nlohmann::json json = cubeGltf();
	json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
	for (int i = 1; i <= 20000; ++i)
	{
		json["nodes"].push_back({{"name", "same"}, {"camera", 0}});
		json["scenes"][0]["nodes"].push_back(i);
	}
	const LoadedLevel loaded = loadText(folder / "a.gltf", gltfText(json));
	REQUIRE(loaded.level.cameras.size() == 20000);
	CHECK(loaded.level.cameras[0].name == "same");
	CHECK(loaded.level.cameras[19999].name == "same 20000");

	json = cubeGltf();
	const std::string picture = "data:image/png;base64," + base64(rowsPng());
	for (int i = 0; i < 500; ++i)
	{
		json["images"].push_back({{"uri", picture}});
		json["textures"].push_back({{"source", i}});
		json["materials"].push_back({{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", i}}}}}});
	}
	CHECK(loadText(folder / "a.gltf", gltfText(json)).level.material_list[499].coverage == 0.75);
	json["images"][499]["uri"] = "data:image/png;base64,AAAA";
	CHECK(refusalOf(folder, json).starts_with("image 499: found"));

	std::string header = "ply\nformat ascii 1.0\n";
	for (int i = 0; i < 1000; ++i)
	{
		header += "element nothing 200000000\n";
	}
	writeFile(folder / "a.ply", header + cubePly().substr(cubePly().find("element")));
	CHECK(outcomeOf(folder / "a.ply") == "error 3");
}

TEST_CASE("scene: large files and pipes are refused before they are read", "[scene]")
{
	const TemporaryFolder folder;
	for (const char* const name : {"a.obj", "a.glb", "a.ply", "a.stl", "a.fbx"})
	{
		INFO(name);
		writeFile(folder / name, cubeObj());
		std::filesystem::resize_file(folder / name, std::uintmax_t{3} << 30U); // a sparse file, which takes no space
		CHECK(outcomeOf(folder / name) == "error 2");
	}
	REQUIRE(::mkfifo((folder / "pipe.obj").c_str(), 0600) == 0);
	CHECK(outcomeOf(folder / "pipe.obj") == "error 2");
	REQUIRE(::mkfifo((folder / "pipe.mtl").c_str(), 0600) == 0);
	writeFile(folder / "b.obj", "mtllib pipe.mtl\n" + cubeObj());
	CHECK(outcomeOf(folder / "b.obj") == "12 missing-file 1 ignored");
}

TEST_CASE("scene: byte order marks, line ends in numbers, strips, and heads that mislead", "[scene]")
{
	const TemporaryFolder folder;
	CHECK(volumeOf(loadText(folder / "a.obj", "\xEF\xBB\xBF" + cubeObj().substr(cubeObj().find("v "))).level) == Approx(1.0));

	// A binary PLY whose first number starts with a byte that is also a line end.
	std::string ply =
		"ply\nformat binary_little_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
		"element face 12\nproperty list uchar int vertex_indices\nend_header\n";
	for (unsigned i = 0; i < 8; ++i)
	{
		append(ply, i == 0 ? glm::vec3(std::bit_cast<float>(uint32_t{10}), 0.0F, 0.0F) : cubeCorner(i));
	}
	for (const auto& t : cubeTriangles())
	{
		append(ply, uint8_t{3});
		append(ply, t);
	}
	CHECK(volumeOf(loadText(folder / "a.ply", ply).level) == Approx(1.0));
	std::string strips = cubePly();
	strips.replace(strips.find("element face 12"), 15, "element tristrips 1");
	strips.erase(strips.find("3 0 4 6"));
	strips += "30";
	for (const auto& q : kCubeQuads)
	{
		for (const unsigned corner : {q[3], q[0], q[2], q[1]})
		{
			strips += " " + std::to_string(corner);
		}
		strips += " -1";
	}
	CHECK(volumeOf(loadText(folder / "b.ply", strips + "\n").level) == Approx(1.0));

	// Binary STL: invalid normals, a header that looks like text, a wrong count.
	std::string stl = std::string("solid made by a program").append(57, ' ');
	append(stl, uint32_t{12});
	for (const auto& t : cubeTriangles())
	{
		append(stl, glm::vec3(0.0F));
		for (const unsigned corner : t)
		{
			append(stl, cubeCorner(corner));
		}
		append(stl, uint16_t{0});
	}
	writeFile(folder / "a.stl", stl);
	CHECK(outcomeOf(folder / "a.stl") == "12 ");
	for (const std::string& wrong : {stl + "more", stl.substr(0, stl.size() - 50)})
	{
		writeFile(folder / "b.stl", wrong);
		CHECK(outcomeOf(folder / "b.stl") == "error 3");
	}
}

TEST_CASE("scene: an index beyond the vertices drops its triangle", "[scene]")
{
	const TemporaryFolder folder;
	std::string buffer = cubeBuffer();
	buffer[160 + 6] = 100; // the first corner of the second triangle
	const LoadedLevel loaded = loadText(folder / "a.gltf", gltfText(cubeGltf(), buffer));
	CHECK(findingsOf(loaded.diagnosis) == "index-out-of-range 1 dropped");
	CHECK(loaded.diagnosis.findings[0].first == "meshes[0].primitives[0], triangle 1");
	CHECK(loaded.level.triangles.size() == 11);
	std::string ply = cubePly();
	ply.replace(ply.rfind("3 "), std::string::npos, "3 0 1 99\n");
	CHECK(findingsOf(loadText(folder / "a.ply", ply).diagnosis) == "index-out-of-range 1 dropped");
}

TEST_CASE("scene: the shared broken files", "[scene]")
{
	const std::string folder = sharedScenes() + "/nasty";
	if (!std::filesystem::is_directory(folder))
	{
		WARN("no " << folder);
		return;
	}
	struct Case
	{
		const char* file;
		const char* outcome; // triangles and findings, or the error
	};
	const std::vector<Case> cases{
		{"assimp_badnormals.glb", "12 bad-normals 8 repaired"},
		{"assimp_concave.obj", "64 missing-file 1 ignored"},
		{"assimp_crash.ply", "error 3"},
		{"assimp_empty.obj", "error 3"},
		{"assimp_issue623.ply", "error 3"}, // only vertices
		{"assimp_malformed.obj", "error 3"},
		{"assimp_missingbin.gltf", "error 2"},
		{"assimp_oom.off", "error 3"},
		{"assimp_recursive.gltf", "error 3"},
		{"assimp_utf16.obj", "error 3"},
		{"badUint/badUint.gltf", "error 3"},
		{"degenerated.obj", "24 coincident-faces 12 kept, non-manifold-edges 6 kept"},
		{"double_sided.obj", "4 coincident-faces 2 kept"},
		{"fan3.obj", "3 non-manifold-edges 1 kept"},
		{"IndexOutOfRange/IndexOutOfRange.gltf", "11 index-out-of-range 1 dropped"},
		{"moebius.obj", "448 inconsistent-winding 4 kept"},
		{"tiny_inconsistent_f.obj", "12 missing-file 1 ignored"},
		{"tiny_invalid_face.obj", "error 3"},
		{"tiny_invalid_relidx.obj", "error 3"},
		{"tiny_invalid_reltex.obj", "error 3"},
		{"tiny_lines.obj", "error 3"},
		{"tiny_nan.obj", "34 missing-file 1 ignored, non-finite-vertices 1 dropped"},
		{"tiny_points.obj", "error 3"},
		{"tiny_quads_torus.obj", "64 "},
		{"tiny_triang_fail.obj", "28 large-coordinates 56 kept"},
		{"tiny_zero_idx.obj", "error 3"},
		{"trimesh_emptyface.ply", "error 3"},
		{"trimesh_jacked.obj", "12 missing-file 1 ignored"},
		{"trimesh_mode5.gltf", "2786 sliver-triangles 1 kept"},
		{"trimesh_nancolor.obj", "12 "},
		{"trimesh_notenough.obj", "1 missing-file 1 ignored, points-or-lines 1 dropped"},
		{"trimesh_wallhole.obj", "66 missing-file 1 ignored"},
	};
	std::size_t files = 0;
	for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
	{
		const std::string ending = entry.path().extension().string();
		if (!entry.is_regular_file() || ending == ".tsv" || ending == ".bin")
		{
			continue;
		}
		files += 1;
		const std::string name = std::filesystem::relative(entry.path(), folder).string();
		INFO(name);
		const std::string outcome = outcomeOf(entry.path().string());
		const auto known = std::find_if(cases.begin(), cases.end(), [&](const Case& c) { return name == c.file; });
		if (known != cases.end())
		{
			CHECK(outcome == known->outcome);
		}
	}
	CHECK(files >= 30); // fails if the search finds nothing
	// Polygons: the sum of their areas, computed from the file by another program.
	const std::string start = folder + "/";
	CHECK(areaOf(loadLevel(start + "assimp_concave.obj", {}, {}).level) == Approx(0.2454966872).epsilon(1e-6));
	CHECK(areaOf(loadLevel(start + "trimesh_wallhole.obj", {}, {}).level) == Approx(721.4213562373).epsilon(1e-6));
	CHECK(areaOf(loadLevel(start + "tiny_triang_fail.obj", {}, {}).level) == Approx(14.0));
}
