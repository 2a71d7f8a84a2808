// SPDX-License-Identifier: GPL-3.0-or-later
// Level files of every format, generated here, and what must be read from them.
#include "bake_levels.h"
#include "level_files.h"
#include "testing.h"

#include "scene/describe.h"
#include "scene/level_glb.h"
#include "scene/mesh_text.h"
#include "volume/build.h"
#include "volume/evaluate.h"
#include "volume/occluders.h"

namespace
{

// Twelve triangles of area 6, wound outward, in one mesh.
void checkCube(const LoadedLevel& loaded, glm::dvec3 least, double edge = 1.0)
{
	CHECK(findingsOf(loaded.diagnosis).empty());
	CHECK(loaded.level.triangles.size() == 12);
	CHECK(loaded.level.meshes.size() == 1);
	checkBox(loaded.level, least, least + edge);
	CHECK(areaOf(loaded.level) == Approx(6.0 * edge * edge));
	const LoadedLevel& l = loaded;
	double volume = 0.0;
	for (const glm::uvec3& t : l.level.triangles)
	{
		volume +=
			glm::dot(l.level.positions[t.x] - least, glm::cross(l.level.positions[t.y] - least, l.level.positions[t.z] - least)) /
			6.0;
	}
	CHECK(volume == Approx(edge * edge * edge));
}

std::string messageOf(const std::string& path, const LoadSettings& settings = {}, ExitCode code = ExitCode::invalid_input)
{
	const std::string message = refusalBy([&] { loadLevel(path, settings, {}); }, code);
	return message.empty() ? "no error" : message;
}

// A masked material on the cube, with its picture in the file `uri`.
nlohmann::json maskedGltf(const std::string& uri)
{
	nlohmann::json json = cubeGltf();
	json["materials"] = {{{"name", "net"},
						  {"alphaMode", "MASK"},
						  {"alphaCutoff", 0.25},
						  {"doubleSided", true},
						  {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}, {"baseColorTexture", {{"index", 0}}}}}}};
	json["textures"] = {{{"source", 0}, {"sampler", 0}}};
	json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
	json["images"] = {{{"uri", uri}}};
	json["meshes"][0]["primitives"][0]["material"] = 0;
	return json;
}

void checkMask(const LoadedLevel& loaded)
{
	CHECK(findingsOf(loaded.diagnosis).empty());
	REQUIRE(loaded.level.masks.size() == 1);
	const Mask& mask = loaded.level.masks[0];
	CHECK(mask.width_px == 8);
	CHECK(mask.height_px == 8);
	CHECK(mask.wrap_u == Wrap::clamp);
	CHECK(mask.wrap_v == Wrap::mirror);
	const Material& material = loaded.level.material_list[loaded.level.materials[0]];
	CHECK(material.name == "net");
	CHECK(material.alpha_mode == AlphaMode::mask);
	CHECK(material.cutoff == 0.25);
	CHECK(material.alpha == 0.5);
	CHECK(material.two_sided);
	CHECK(material.mean_alpha == Approx(0.375));
	CHECK(material.coverage == Approx(0.75));
	// v grows downward: the picture's upper quarter is open; glTF's own coordinates are the level's.
	CHECK_FALSE(isSolidAt(loaded.level, material, {0.5, 0.125}));
	CHECK(isSolidAt(loaded.level, material, {0.5, 0.5}));
	for (std::size_t i = 0; i < loaded.level.positions.size(); ++i)
	{
		CHECK(static_cast<double>(loaded.level.uvs[i].x) == loaded.level.positions[i].x);
		CHECK(static_cast<double>(loaded.level.uvs[i].y) == loaded.level.positions[i].y);
	}
}

Level again(const Level& level, const GlbBake& bake = {})
{
	const TemporaryFolder folder;
	writeFile(folder / "level.glb", bakedGlb(level, "nook test", bake));
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
	const std::size_t count = sumOver(cell.meshes, [](const Mesh& mesh) { return mesh.around ? 0 : mesh.triangle_count; });
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

TEST_CASE("scene: a cube is the same from every format", "[scene]")
{
	const TemporaryFolder folder;
	checkCube(loadText(folder / "a.gltf", gltfText(cubeGltf())), glm::dvec3(0.0));
	checkCube(loadText(folder / "a.glb", glbBytes(cubeGltf(), cubeBuffer())), glm::dvec3(0.0));
	checkCube(loadText(folder / "a.obj", cubeObj()), glm::dvec3(0.0));
	checkCube(loadText(folder / "a.ply", cubePly()), glm::dvec3(0.0));
	checkCube(loadText(folder / "a.STL", cubeStl()), glm::dvec3(0.0));
}

TEST_CASE("scene: FBX files say their unit and their axes", "[scene]")
{
	const TemporaryFolder folder;
	// Centimetres, y up.
	checkCube(loadText(folder / "a.fbx", cubeFbx(false, 1.0)), {0.01, 0.02, 0.03}, 0.01);
	// Metres, z up: (x, y, z) becomes (x, z, -y).
	checkCube(loadText(folder / "b.fbx", cubeFbx(true, 100.0)), {1.0, 3.0, -3.0});
	// Options take precedence.
	checkCube(loadText(folder / "c.fbx", cubeFbx(true, 100.0), {{0.5, UpAxis::y, false}, {}}), {0.5, 1.0, 1.5}, 0.5);
}

TEST_CASE("scene: unit and up-axis of files that do not say them", "[scene]")
{
	const TemporaryFolder folder;
	std::string text = cubeObj();
	text.insert(text.find("f "), "v 0 0 9\nv 1 0 9\nv 0 1 9\nf 9 10 11\n");
	const Level z_up = loadText(folder / "a.obj", text, {{0.1, UpAxis::z, false}, {}}).level;
	checkBox(z_up, {0.0, 0.0, -0.1}, {0.1, 0.9, 0.0});
	const Level x_up = loadText(folder / "a.obj", text, {{1.0, UpAxis::x, false}, {}}).level;
	checkBox(x_up, {-1.0, 0.0, 0.0}, {0.0, 1.0, 9.0});
	for (const UpAxis up : {UpAxis::x, UpAxis::y, UpAxis::z})
	{
		CHECK(volumeOf(loadText(folder / "b.obj", cubeObj(), {{1.0, up, false}, {}}).level) == Approx(1.0));
	}
}

TEST_CASE("scene: nodes place, repeat and mirror meshes", "[scene]")
{
	const TemporaryFolder folder;
	nlohmann::json json = cubeGltf();
	json["scenes"][0]["nodes"] = {0, 1};
	json["nodes"] = parseJson(R"([
		{"name": "far", "mesh": 0, "translation": [148376, 1234, -223423]},
		{"name": "parent", "translation": [0, 5, 0], "children": [2]},
		{"name": "mirrored", "mesh": 0, "rotation": [0, 0, 0.7071067811865476, 0.7071067811865476], "scale": [-2, 1, 1]}])",
							  "a.gltf");
	const LoadedLevel loaded = loadText(folder / "a.gltf", gltfText(json));
	const Level& level = loaded.level;
	CHECK(findingsOf(loaded.diagnosis) == "large-coordinates 8 kept");
	REQUIRE(level.meshes.size() == 2);
	CHECK(level.meshes[0].name == "far/cube");
	CHECK(level.meshes[1].name == "mirrored/cube");
	CHECK(level.triangles.size() == 24);
	checkBox(level, {-1.0, 3.0, -223423.0}, {148377.0, 1235.0, 1.0});
	CHECK(level.positions[0] == glm::dvec3(148376.0, 1234.0, -223423.0)); // exactly
	Level mirrored = level;
	mirrored.triangles.erase(mirrored.triangles.begin(), mirrored.triangles.begin() + 12);
	checkBox(mirrored, {-1.0, 3.0, 0.0}, {0.0, 5.0, 1.0});
	CHECK(areaOf(mirrored) == Approx(10.0));
	CHECK(volumeOf(mirrored) == Approx(2.0)); // outward winding, although mirrored
}

TEST_CASE("scene: normals turn by the inverse transpose", "[scene]")
{
	const TemporaryFolder folder;
	nlohmann::json json = cubeGltf();
	std::string buffer = cubeBuffer();
	for (unsigned i = 0; i < 8; ++i)
	{
		append(buffer, glm::normalize(glm::vec3(1.0F, 1.0F, 0.0F)));
	}
	json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 232}, {"byteLength", 96}});
	json["accessors"].push_back({{"bufferView", 3}, {"componentType", 5126}, {"count", 8}, {"type", "VEC3"}});
	json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = 3;
	for (const double mirror : {1.0, -1.0})
	{
		json["nodes"][0]["scale"] = {2.0 * mirror, 1.0, 1.0};
		const LoadedLevel loaded = loadText(folder / "a.gltf", gltfText(json, buffer));
		CHECK(findingsOf(loaded.diagnosis).empty());
		checkNear(glm::dvec3(loaded.level.normals[0]), glm::normalize(glm::dvec3(0.5 * mirror, 1.0, 0.0)), 1e-6);
	}
}

TEST_CASE("scene: cameras stand and look as the file says", "[scene]")
{
	const TemporaryFolder folder;
	nlohmann::json json = cubeGltf();
	json["scenes"][0]["nodes"] = {0, 1, 3};
	json["cameras"] = parseJson(R"([
		{"type": "perspective", "perspective": {"yfov": 0.9, "znear": 0.05}},
		{"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0.5, "zfar": 20}}])",
								"a.gltf");
	// A quarter turn about y: from looking along -z to looking along -x. The parent scales and mirrors; a camera does neither.
	json["nodes"] = parseJson(R"([{"mesh": 0},
		{"translation": [10, 0, 0], "scale": [3, 3, 3], "children": [2]},
		{"name": "eye", "camera": 0, "translation": [1, 2, 3], "rotation": [0, 0.7071067811865476, 0, 0.7071067811865476]},
		{"camera": 1}])",
							  "a.gltf");
	const Level level = loadText(folder / "a.gltf", gltfText(json)).level;
	REQUIRE(level.cameras.size() == 2);
	const LevelCamera& eye = level.cameras[0];
	CHECK(eye.name == "eye");
	checkNear(glm::dvec3(eye.world_from_camera[3]), {13.0, 6.0, 9.0});
	checkNear(-glm::dvec3(eye.world_from_camera[2]), {-1.0, 0.0, 0.0});
	checkNear(glm::dvec3(eye.world_from_camera[1]), {0.0, 1.0, 0.0});
	checkNear(glm::dvec3(eye.world_from_camera[0]), {0.0, 0.0, -1.0});
	CHECK(eye.lens.fov_y_rad == 0.9);
	CHECK(eye.lens.near_m == 0.05);
	CHECK(std::isinf(eye.lens.far_m));
	CHECK(level.cameras[1].name == "camera 1");
	CHECK(level.cameras[1].lens.orthographic);
	CHECK(level.cameras[1].lens.half_height_m == 2.0);
	const Level turned = loadText(folder / "a.gltf", gltfText(json), {{0.01, UpAxis::z, false}, {}}).level;
	checkNear(glm::dvec3(turned.cameras[0].world_from_camera[3]), {0.13, 0.09, -0.06});
	checkNear(glm::dvec3(turned.cameras[0].world_from_camera[1]), {0.0, 0.0, -1.0});
	CHECK(turned.cameras[1].lens.half_height_m == Approx(0.02));
}

TEST_CASE("scene: glTF masks from a file, from text and from the binary chunk", "[scene]")
{
	const TemporaryFolder folder;
	const std::string png = rowsPng();
	writeFile(folder / "net rows.png", png);
	writeFile(folder / "cube data.bin", cubeBuffer());
	nlohmann::json json = maskedGltf("net%20rows.png");
	json["buffers"][0]["uri"] = "cube%20data.bin";
	const LoadedLevel beside = loadText(folder / "a.gltf", jsonLine(json));
	checkMask(beside);
	CHECK(beside.level.files == std::vector<std::string>{folder / "a.gltf", folder / "cube data.bin", folder / "net rows.png"});

	checkMask(loadText(folder / "b.gltf", gltfText(maskedGltf("data:image/png;base64," + base64(png)))));

	json = maskedGltf("");
	json["images"] = {{{"bufferView", 3}, {"mimeType", "image/png"}}};
	json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", 232}, {"byteLength", png.size()}});
	json["buffers"][0]["byteLength"] = 232 + png.size();
	checkMask(loadText(folder / "c.glb", glbBytes(json, cubeBuffer() + png)));
}

TEST_CASE("scene: KHR_texture_transform moves, turns and scales", "[scene]")
{
	const TemporaryFolder folder;
	nlohmann::json json = maskedGltf("data:image/png;base64," + base64(rowsPng()));
	json["extensionsRequired"] = {"KHR_texture_transform"};
	json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
		{"offset", {0.25, 0.5}}, {"rotation", 0.5 * kPi}, {"scale", {2.0, 3.0}}};
	const Level level = loadText(folder / "a.gltf", gltfText(json)).level;
	for (std::size_t i = 0; i < level.positions.size(); ++i)
	{
		// Scaled, then rotated a quarter turn counter-clockwise with v downward: (u, v) becomes (v, -u); then translated.
		const glm::dvec3 p = level.positions[i];
		CHECK(static_cast<double>(level.uvs[i].x) == Approx(0.25 + 3.0 * p.y).margin(1e-6));
		CHECK(static_cast<double>(level.uvs[i].y) == Approx(0.5 - 2.0 * p.x).margin(1e-6));
	}
}

TEST_CASE("scene: OBJ materials, masks and opacity", "[scene]")
{
	const TemporaryFolder folder;
	writeFile(folder / "rows.png", rowsPng());
	writeFile(folder / "a.mtl",
			  "newmtl net\nmap_Kd absent.png\nmap_d rows.png\nnewmtl glass\nd 0.25\nnewmtl dim\nTr 0.4\nnewmtl wall\n");
	const std::string cube = cubeObj();
	const std::size_t faces = cube.find("\nf ") + 1;
	const auto with = [&](const std::string& material)
	{
		return "mtllib a.mtl\n" + cube.substr(0, faces) + "usemtl " + material + "\n" + cube.substr(faces);
	};
	const LoadedLevel loaded = loadText(folder / "a.obj", with("net"));
	const Level& level = loaded.level;
	CHECK(findingsOf(loaded.diagnosis) == "missing-file 1 ignored"); // colours are not needed here
	CHECK(loaded.diagnosis.findings[0].first == "absent.png");
	CHECK(level.files == std::vector<std::string>{folder / "a.obj", folder / "a.mtl", folder / "rows.png"});
	const Material& net = level.material_list[level.materials[0]];
	CHECK(net.name == "net");
	CHECK(net.alpha_mode == AlphaMode::mask);
	CHECK(net.mean_alpha == Approx(0.75));
	// OBJ's v grows upward: y = v = 1 is the picture's upper edge, which is open.
	for (std::size_t i = 0; i < level.positions.size(); ++i)
	{
		CHECK(static_cast<double>(level.uvs[i].y) == 1.0 - level.positions[i].y);
	}
	CHECK_FALSE(isSolidAt(level, net, {0.5, 0.125}));

	const Level glass = loadText(folder / "b.obj", with("glass")).level;
	CHECK(glass.material_list[glass.materials[0]].alpha_mode == AlphaMode::blend);
	CHECK(glass.material_list[glass.materials[0]].mean_alpha == Approx(0.25));
	const Level dim = loadText(folder / "c.obj", with("dim")).level;
	CHECK(dim.material_list[dim.materials[0]].alpha == Approx(0.6));
	const Level wall = loadText(folder / "d.obj", with("wall")).level;
	CHECK(wall.material_list[wall.materials[0]].alpha_mode == AlphaMode::opaque);
}

TEST_CASE("scene: missing masks and buffers are errors that name them", "[scene]")
{
	const TemporaryFolder folder;
	writeFile(folder / "mask.gltf", gltfText(maskedGltf("absent.png")));
	CHECK(messageOf(folder / "mask.gltf", {}, ExitCode::file).find("absent.png") != std::string::npos);
	writeFile(folder / "broken.png", "no picture");
	writeFile(folder / "broken.gltf", gltfText(maskedGltf("broken.png")));
	CHECK(messageOf(folder / "broken.gltf").find("broken.png") != std::string::npos);
	nlohmann::json json = cubeGltf();
	json["buffers"][0]["uri"] = "absent.bin";
	writeFile(folder / "buffer.gltf", jsonLine(json));
	CHECK(messageOf(folder / "buffer.gltf", {}, ExitCode::file).find("absent.bin") != std::string::npos);
	json["buffers"][0]["uri"] = "short.bin";
	writeFile(folder / "short.bin", "short");
	writeFile(folder / "buffer.gltf", jsonLine(json));
	CHECK(messageOf(folder / "buffer.gltf").find("found 5 bytes, expected 232") != std::string::npos);
	writeFile(folder / "a.mtl", "newmtl net\nmap_d absent.png\n");
	writeFile(folder / "a.obj", "mtllib a.mtl\nusemtl net\n" + cubeObj());
	CHECK(messageOf(folder / "a.obj", {}, ExitCode::file).find("absent.png") != std::string::npos);
	CHECK(messageOf(folder / "absent.obj", {}, ExitCode::file).find("absent.obj: cannot be read") != std::string::npos);
	CHECK(messageOf(folder / "a.off").find(".gltf") != std::string::npos);
}

TEST_CASE("scene: polygons of any shape keep their area", "[scene]")
{
	using Polygon = std::vector<glm::dvec3>;
	const auto areaOfTriangles = [](const Polygon& polygon, bool simple)
	{
		std::vector<glm::uvec3> triangles;
		CHECK(triangulate(polygon, triangles) == simple);
		glm::dvec3 sum(0.0);
		double absolute = 0.0;
		for (const glm::uvec3& t : triangles)
		{
			const glm::dvec3 twice = glm::cross(polygon[t.y] - polygon[t.x], polygon[t.z] - polygon[t.x]);
			sum += twice;
			absolute += 0.5 * glm::length(twice);
		}
		CHECK(0.5 * glm::length(sum) == Approx(absolute)); // none has reversed winding
		return absolute;
	};
	CHECK(areaOfTriangles({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1.5, 0.5, 0}}, true) == Approx(1.0)); // an arrow's head
	CHECK(areaOfTriangles({{0, 0, 5}, {3, 0, 5}, {3, 3, 5}, {2, 3, 5}, {2, 1, 5}, {1, 1, 5}, {1, 3, 5}, {0, 3, 5}}, true) ==
		  Approx(7.0));                                                                                              // a U
	CHECK(areaOfTriangles({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {3, 1, 0}, {0, 1, 0}}, true) == Approx(3.0)); // collinear
	// A square with a square hole, joined by a bridge that is traversed twice.
	CHECK(areaOfTriangles(
			  {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}},
			  true) == Approx(12.0));
	Polygon comb; // rotated and far away
	for (int i = 0; i < 50; ++i)
	{
		const double height = i % 2 == 0 ? 1.0 : 10.0;
		comb.push_back({1e5 + 0.6 * i, 1e5 + height, -1e5 + 0.8 * i});
	}
	comb.push_back({1e5 + 0.6 * 49, 1e5, -1e5 + 0.8 * 49});
	comb.push_back({1e5, 1e5, -1e5});
	CHECK(areaOfTriangles(comb, true) == Approx(49 * 5.5));
	std::vector<glm::uvec3> triangles;
	CHECK_FALSE(triangulate(Polygon{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}, triangles)); // self-intersecting
	CHECK_FALSE(triangulate(Polygon{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 0, 0}}, triangles)); // no area
}

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

// Advice of nook info on levels with known parts.

TEST_CASE("advice: closed and open components, shared places and patches are counted", "[scene]")
{
	Level level = emptyLevel();
	addBox(level, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}); // faces with their own vertices: still closed
	addBox(level, {5.0, 0.0, 0.0}, {6.0, 1.0, 1.0});
	addQuad(level, {0.0, -1.0, 9.0}, {9.0, 0.0, 0.0}, {0.0, 0.0, -9.0}); // a sheet
	const int threads = GENERATE(1, 2);
	const LevelFacts facts = levelFacts(level, threads);
	CHECK(facts.components == 3);
	CHECK(facts.closed == 2);
	CHECK(facts.open_triangles == 2);
	CHECK(facts.places == 8 + 8 + 4);
	CHECK(facts.sharing == level.positions.size() - 20);
	CHECK(facts.patches == 6 + 6 + 1);
	CHECK(std::fabs(facts.median_edge_m - std::sqrt(40.5)) < 1e-9);
	CHECK(facts.coarse_share == 1.0);
}

TEST_CASE("advice: coarse architecture takes volumes, dense meshes a bake", "[scene]")
{
	const auto adviceOf = [](const char* name)
	{
		const LoadedLevel loaded = loadLevel(name, {}, {});
		const LevelFacts facts = levelFacts(loaded.level, 2);
		return adviceFor(facts, masksEstimate(loaded.level, facts, {2, {}, nullptr})).bake;
	};
	CHECK_FALSE(adviceOf("builtin:cornell"));
	CHECK_FALSE(adviceOf("builtin:suburb"));
	CHECK(adviceOf("builtin:cave:20000"));
	CHECK(adviceOf("builtin:heightfield:200000"));
}

TEST_CASE("advice: masks take about the expected bytes, the same for any number of threads", "[scene]")
{
	const char* const name =
		GENERATE(as<const char*>{}, "builtin:cornell", "builtin:suburb", "builtin:cave:20000", "builtin:heightfield:20000");
	const LoadedLevel loaded = loadLevel(name, {}, {});
	const LevelFacts facts = levelFacts(loaded.level, 1);
	const AssetEstimate expected = masksEstimate(loaded.level, facts, {1, {}, nullptr});
	const AssetEstimate again = masksEstimate(loaded.level, levelFacts(loaded.level, 2), {2, {}, nullptr});
	CHECK(expected.bytes == again.bytes);
	CHECK(expected.seconds == again.seconds);
	CHECK(expected.memory_bytes == again.memory_bytes);
	VolumeSettings settings;
	settings.masks = true;
	settings.distance_m = facts.radius_m;
	settings.occluders.distance_m = facts.radius_m;
	VolumeSet set = buildVolumes(loaded.level, settings, {2, {}, nullptr}).set;
	clusterVolumes(set, kMaskClusters, {2, {}, nullptr});
	const auto bytes = static_cast<double>(volumeGlb(set, {}, name, "", {2, {}, nullptr}).bytes.size());
	INFO(name << ": " << expected.bytes << " expected, " << bytes);
	CHECK(expected.bytes < 1.3 * bytes);
	CHECK(bytes < 1.3 * expected.bytes);
}

TEST_CASE("advice: a bake takes four bytes per vertex, and again for the backs of sheets", "[scene]")
{
	Level level = emptyLevel();
	addBox(level, {0.0, 0.0, 0.0}, {1.0, 1.0, 1.0});
	const std::size_t box = level.triangles.size();
	addQuad(level, {0.0, -1.0, 9.0}, {9.0, 0.0, 0.0}, {0.0, 0.0, -9.0});
	level.material_list.push_back(level.material_list.front());
	level.material_list.back().two_sided = true;
	std::fill(level.materials.begin() + static_cast<std::ptrdiff_t>(box), level.materials.end(), uint32_t{1});
	const AssetEstimate bake = bakeEstimate(level, levelFacts(level, 1));
	CHECK(bake.bytes == 4.0 * static_cast<double>(level.positions.size() + 4));
}

TEST_CASE("advice: a bake of a level with large triangles is split", "[scene]")
{
	LevelFacts facts;
	const AssetEstimate many{20e6, 1.0, 1e9};
	const AssetEstimate few{1e6, 1.0, 1e9};
	for (const auto& [share, split] : {std::pair{0.0, false}, {0.2, false}, {0.4, true}})
	{
		facts.coarse_share = share;
		for (const AssetEstimate& volumes : {many, few})
		{
			const Advice advice = adviceFor(facts, volumes);
			CHECK(advice.bake);
			CHECK(advice.split == split);
		}
	}
}

TEST_CASE("advice: a level in millimetres or of many kilometres is doubted", "[scene]")
{
	for (const auto& [size_m, text] : {std::pair{0.3, "less than a metre"}, {30.0, "plausible"}, {30000.0, "more than 5 km"}})
	{
		Level level = emptyLevel();
		addBox(level, {0.0, 0.0, 0.0}, {size_m, size_m, size_m});
		const LevelFacts facts = levelFacts(level, 1);
		CHECK(scaleText(facts).starts_with(text));
		CHECK(facts.radius_m > 0.0);
		CHECK(facts.radius_m <= 1.5);
	}
}

// A cell of a level gives the same results as the whole level inside it.

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
	BakeSettings settings{.radius_m = 2.0};
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
