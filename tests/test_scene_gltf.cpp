// SPDX-License-Identifier: GPL-3.0-or-later
// Alternative encodings in glTF, and files that are easily misread.
#include "cube_gltf.h"
#include "testing.h"

#include "scene/load_parts.h"

#include <glm/common.hpp>

namespace
{

void checkCube(const LoadedLevel& loaded)
{
	CHECK(findingsOf(loaded.diagnosis).empty());
	CHECK(loaded.level.triangles.size() == 12);
	CHECK(areaOf(loaded.level) == Approx(6.0));
	CHECK(volumeOf(loaded.level) == Approx(1.0));
}

// Corner i of the cube as integers up to `one`, with `each` components.
template <class T> std::string wholeCorners(T one, std::size_t each)
{
	std::vector<T> values;
	for (unsigned i = 0; i < 8; ++i)
	{
		for (std::size_t k = 0; k < each; ++k)
		{
			values.push_back(k < 3 && ((i >> k) & 1U) != 0 ? one : T{0});
		}
	}
	return packed(values);
}

// The cube with a material of that alpha mode and COLOR_0 alphas per corner: floats, or bytes if `bytes`.
Cube paintedCube(const std::string& mode, const std::vector<float>& alphas, bool bytes = false)
{
	Cube cube;
	std::string values;
	for (const float alpha : alphas)
	{
		for (int i = 0; i < 4; ++i)
		{
			bytes ? append(values, static_cast<uint8_t>(i < 3 ? 7 : std::lround(255.0F * alpha)))
				  : append(values, i < 3 ? 0.5F : alpha);
		}
	}
	cube.primitive()["attributes"]["COLOR_0"] = cube.accessor(cube.view(values), bytes ? 5121 : 5126, alphas.size(), "VEC4");
	if (bytes)
	{
		cube.json["accessors"].back()["normalized"] = true;
	}
	cube.json["materials"] = {{{"name", "net"}, {"alphaMode", mode}}};
	cube.primitive()["material"] = 0;
	return cube;
}

// Adds an embedded picture, and a texture of it with a sampler.
void addRows(Cube& cube, int filter)
{
	cube.json["images"] = {{{"uri", "data:image/png;base64," + base64(rowsPng())}}};
	cube.json["samplers"] = {{{"magFilter", filter}, {"minFilter", filter}}};
	cube.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
}

const Material& materialOf(const Level& level, std::size_t triangle)
{
	return level.material_list[level.materials[triangle]];
}

LoadedLevel loadedIn(const Cube& cube, Pose pose)
{
	const TemporaryFolder folder;
	LoadSettings settings;
	settings.pose = pose;
	return loadText(folder / "a.gltf", gltfText(cube.json, cube.buffer), settings);
}

// Column-major.
std::string matrixBytes(glm::dvec3 diagonal, glm::dvec3 translation)
{
	std::vector<float> values(16, 0.0F);
	for (int i = 0; i < 3; ++i)
	{
		values[static_cast<std::size_t>(5 * i)] = static_cast<float>(diagonal[i]);
		values[static_cast<std::size_t>(12 + i)] = static_cast<float>(translation[i]);
	}
	values[15] = 1.0F;
	return packed(values);
}

// The cube with two joints: its lower half (y = 0) follows node 1 at (0, 0, 0), its upper half node 2 at (0, 3, 0), which is scaled
// by two. In bind pose the upper joint is at y = 1. The mesh's own node is far away, which a skin ignores.
Cube skinnedCube()
{
	Cube cube;
	std::vector<uint8_t> joints;
	std::vector<uint8_t> weights;
	for (unsigned i = 0; i < 8; ++i)
	{
		joints.insert(joints.end(), {static_cast<uint8_t>((i >> 1U) & 1U), 0, 0, 0});
		weights.insert(weights.end(), {255, 0, 0, 0});
	}
	nlohmann::json& attributes = cube.primitive()["attributes"];
	attributes["JOINTS_0"] = cube.accessor(cube.view(packed(joints)), 5121, 8, "VEC4");
	attributes["WEIGHTS_0"] = cube.accessor(cube.view(packed(weights)), 5121, 8, "VEC4");
	cube.json["accessors"].back()["normalized"] = true;
	const std::string bind = matrixBytes(glm::dvec3(1.0), {}) + matrixBytes(glm::dvec3(1.0), {0.0, -1.0, 0.0});
	cube.json["skins"] = {{{"joints", {1, 2}}, {"inverseBindMatrices", cube.accessor(cube.view(bind), 5126, 2, "MAT4")}}};
	cube.json["nodes"][0]["skin"] = 0;
	cube.json["nodes"][0]["translation"] = {500, 0, 0};
	cube.json["nodes"].push_back({{"name", "hip"}, {"children", {2}}});
	cube.json["nodes"].push_back({{"name", "head"}, {"translation", {0, 3, 0}}, {"scale", {2, 2, 2}}});
	cube.json["scenes"][0]["nodes"] = {0, 1};
	return cube;
}

} // namespace

TEST_CASE("scene: glTF materials keep their numbers, whatever is used first", "[scene]")
{
	Cube cube;
	cube.json["materials"] = {{{"name", "unused"}}, {{"name", "wall"}}, {{"name", "net"}, {"alphaMode", "BLEND"}}};
	cube.primitive()["material"] = 2;
	cube.json["nodes"].push_back({{"mesh", 1}, {"translation", {5, 0, 0}}});
	cube.json["nodes"].push_back({{"mesh", 2}, {"translation", {9, 0, 0}}});
	cube.json["scenes"][0]["nodes"] = {0, 1, 2};
	for (int i = 0; i < 2; ++i)
	{
		cube.json["meshes"].push_back(cube.json["meshes"][0]);
	}
	cube.json["meshes"][1]["primitives"][0]["material"] = 1;
	cube.json["meshes"][2]["primitives"][0].erase("material");
	const Level level = cube.load().level;
	REQUIRE(level.triangles.size() == 36);
	CHECK(level.material_list[level.materials[0]].name == "net");
	CHECK(level.material_list[level.materials[12]].name == "wall");
	CHECK(level.material_list[level.materials[24]].name == "default");
}

TEST_CASE("scene: glTF numbers of any type and place", "[scene]")
{
	SECTION("interleaved")
	{
		std::string bytes;
		for (unsigned i = 0; i < 8; ++i)
		{
			append(bytes, cubeCorner(i).x); // space of the texture coordinates, and a gap
			append(bytes, cubeCorner(i));
			append(bytes, 7.0F);
		}
		Cube cube;
		cube.json["accessors"][0]["bufferView"] = cube.view(bytes, 20);
		cube.json["accessors"][0]["byteOffset"] = 4;
		checkCube(cube.load());
	}
	SECTION("indices of 8 and 32 bits")
	{
		std::vector<uint8_t> small;
		std::vector<uint32_t> wide;
		for (const auto& triangle : cubeTriangles())
		{
			for (const unsigned corner : triangle)
			{
				small.push_back(static_cast<uint8_t>(corner));
				wide.push_back(corner);
			}
		}
		Cube cube;
		cube.primitive()["indices"] = cube.accessor(cube.view(packed(small)), 5121, 36, "SCALAR");
		checkCube(cube.load());
		cube.primitive()["indices"] = cube.accessor(cube.view(packed(wide)), 5125, 36, "SCALAR");
		checkCube(cube.load());
	}
	SECTION("sparse, over numbers and over zeros")
	{
		// Corners 0 and 7 are replaced, one by the same position; the rest stays.
		Cube cube;
		const nlohmann::json sparse = {
			{"count", 2},
			{"indices", {{"bufferView", cube.view(packed(std::vector<uint16_t>{0, 7}))}, {"componentType", 5123}}},
			{"values", {{"bufferView", cube.view(packed(std::vector<float>{0, 0, 0, 3, 3, 3}))}}}};
		cube.json["accessors"][0]["sparse"] = sparse;
		CHECK(boundsOf(cube.load().level).most == glm::dvec3(3.0));
		Cube zeros;
		std::vector<uint8_t> all{0, 1, 2, 3, 4, 5, 6, 7};
		zeros.json["accessors"][0].erase("bufferView");
		zeros.json["accessors"][0]["sparse"] = {{"count", 8},
												{"indices", {{"bufferView", zeros.view(packed(all))}, {"componentType", 5121}}},
												{"values", {{"bufferView", 0}}}};
		checkCube(zeros.load());
		std::swap(all[3], all[4]);
		zeros.json["accessors"][0]["sparse"]["indices"]["bufferView"] = zeros.view(packed(all));
		CHECK(zeros.refusal() == "3: accessors[0].sparse.indices: found 3 in place 4, expected ascending ones below 8");
	}
	SECTION("KHR_mesh_quantization")
	{
		Cube cube;
		cube.json["extensionsRequired"] = {"KHR_mesh_quantization"};
		cube.primitive()["attributes"]["POSITION"] = cube.accessor(cube.view(wholeCorners<uint16_t>(65535, 4), 8), 5123, 8, "VEC3");
		cube.json["accessors"].back()["normalized"] = true;
		std::vector<int8_t> normals;
		for (int i = 0; i < 8; ++i)
		{
			normals.insert(normals.end(), {0, -128, 0, 0});
		}
		cube.primitive()["attributes"]["NORMAL"] = cube.accessor(cube.view(packed(normals), 4), 5120, 8, "VEC3");
		cube.json["accessors"].back()["normalized"] = true;
		const LoadedLevel loaded = cube.load();
		checkCube(loaded);
		CHECK(loaded.level.normals[0] == glm::vec3(0.0F, -1.0F, 0.0F));
		// Not normalised: the node's scale converts them to metres.
		cube.primitive()["attributes"]["POSITION"] = cube.accessor(cube.view(wholeCorners<int16_t>(100, 4), 8), 5122, 8, "VEC3");
		cube.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
		checkCube(cube.load());
	}
}

TEST_CASE("scene: glTF strips, fans and lists without indices", "[scene]")
{
	Cube cube;
	// A face of two triangles, and two degenerate ones that would lead to the next face.
	const std::vector<uint16_t> strip{0, 2, 1, 3, 3, 7};
	cube.primitive()["indices"] = cube.accessor(cube.view(packed(strip)), 5123, strip.size(), "SCALAR");
	cube.primitive()["mode"] = 5;
	LoadedLevel loaded = cube.load();
	CHECK(loaded.level.triangles.size() == 2);
	CHECK(areaOf(loaded.level) == Approx(1.0));
	for (const glm::uvec3& t : loaded.level.triangles)
	{
		const glm::dvec3 a = loaded.level.positions[t.x];
		CHECK(glm::cross(loaded.level.positions[t.y] - a, loaded.level.positions[t.z] - a) == glm::dvec3(0.0, 0.0, -1.0));
	}
	const std::vector<uint16_t> fan{0, 2, 3, 1};
	cube.primitive()["indices"] = cube.accessor(cube.view(packed(fan)), 5123, fan.size(), "SCALAR");
	cube.primitive()["mode"] = 6;
	loaded = cube.load();
	CHECK(loaded.level.triangles.size() == 2);
	CHECK(areaOf(loaded.level) == Approx(1.0));
	CHECK(findingsOf(loaded.diagnosis).empty());
	Cube bare;
	bare.primitive().erase("indices"); // corners 0 1 2, 3 4 5; two remain
	loaded = bare.load();
	CHECK(loaded.level.triangles.size() == 2);
	CHECK(loaded.level.positions.size() == 6);
}

TEST_CASE("scene: parts of a glTF without triangles are findings", "[scene]")
{
	Cube cube;
	nlohmann::json points = cube.primitive();
	points["mode"] = 0;
	nlohmann::json two = cube.primitive();
	two["indices"] = cube.accessor(2, 5123, 2, "SCALAR");
	cube.json["meshes"][0]["primitives"].push_back(points);
	cube.json["meshes"][0]["primitives"].push_back(two);
	cube.json["meshes"][0]["primitives"].push_back({{"attributes", nlohmann::json::object()}});
	const LoadedLevel loaded = cube.load();
	CHECK(findingsOf(loaded.diagnosis) == "points-or-lines 36 dropped, empty-meshes 3 dropped");
	CHECK(loaded.diagnosis.findings[1].first == "mesh 'cube-1'");
	CHECK(loaded.level.triangles.size() == 12);
}

TEST_CASE("scene: the alpha of COLOR_0 multiplies the base colour", "[scene]")
{
	for (const char* const mode : {"MASK", "BLEND"})
	{
		const Level clear = paintedCube(mode, std::vector<float>(8, 0.0F), true).load().level;
		CHECK_FALSE(isSolidAt(clear, materialOf(clear, 0), {}));
		CHECK(materialOf(clear, 0).coverage == 0.0);
		const Level solid = paintedCube(mode, std::vector<float>(8, 1.0F)).load().level;
		CHECK(materialOf(solid, 0).mask == -1);
		CHECK(isSolidAt(solid, materialOf(solid, 0), {}));
	}
	const Level opaque = paintedCube("OPAQUE", std::vector<float>(8, 0.0F)).load().level;
	CHECK(isSolidAt(opaque, materialOf(opaque, 0), {}));
	Cube factor = paintedCube("MASK", std::vector<float>(8, 0.75F));
	factor.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 0.5}}};
	CHECK(materialOf(factor.load().level, 0).alpha == Approx(0.375));
}

TEST_CASE("scene: alphas that differ from vertex to vertex are a mask", "[scene]")
{
	// From 0 at the bottom to 1 at the top: the upper half is present.
	const Level level = paintedCube("MASK", {0, 0, 1, 1, 0, 0, 1, 1}).load().level;
	const Material& material = materialOf(level, 0);
	REQUIRE(material.mask >= 0);
	for (const glm::uvec3& t : level.triangles)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			const double y = level.positions[t[corner]].y;
			CHECK(alphaAt(level.masks[static_cast<std::size_t>(material.mask)], level.uvs[t[corner]]) == Approx(y).margin(1e-6));
		}
		const glm::dvec2 middle = glm::mix(glm::dvec2(level.uvs[t.x]), glm::dvec2(level.uvs[t.y]), 0.7);
		const double y = glm::mix(level.positions[t.x].y, level.positions[t.y].y, 0.7);
		CHECK(isSolidAt(level, material, middle) == (y >= 0.5));
	}
	CHECK(material.mean_alpha == Approx(0.5));
	// With a texture, each triangle has the mean alpha of its corners.
	Cube both = paintedCube("MASK", {0, 0, 1, 1, 0, 0, 1, 1});
	addRows(both, 9729);
	both.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}}};
	const Level textured = both.load().level;
	for (std::size_t i = 0; i < textured.triangles.size(); ++i)
	{
		const glm::uvec3& t = textured.triangles[i];
		const double mean = (textured.positions[t.x].y + textured.positions[t.y].y + textured.positions[t.z].y) / 3.0;
		CHECK(materialOf(textured, i).alpha == Approx(mean).margin(1.0 / 500.0));
		CHECK(materialOf(textured, i).mask >= 0);
	}
	// Three components have no alpha.
	Cube three = paintedCube("MASK", std::vector<float>(8, 0.0F));
	three.json["accessors"].back()["type"] = "VEC3";
	CHECK(materialOf(three.load().level, 0).mask == -1);
	CHECK(materialOf(three.load().level, 0).alpha == 1.0);
}

TEST_CASE("scene: alpha of specular-glossiness materials", "[scene]")
{
	const bool required = GENERATE(false, true);
	Cube cube;
	addRows(cube, 9729);
	nlohmann::json glossy = {{"diffuseFactor", {1, 1, 1, 0.25}}};
	cube.json["materials"] = {{{"alphaMode", "BLEND"}}};
	cube.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = glossy;
	cube.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 1}}};
	cube.primitive()["material"] = 0;
	if (required)
	{
		cube.json["extensionsRequired"] = {"KHR_materials_pbrSpecularGlossiness"};
	}
	Level level = cube.load().level;
	CHECK(materialOf(level, 0).alpha == 0.25);
	CHECK_FALSE(isSolidAt(level, materialOf(level, 0), {}));
	glossy = {{"diffuseTexture", {{"index", 0}}}};
	cube.json["materials"][0]["extensions"]["KHR_materials_pbrSpecularGlossiness"] = glossy;
	level = cube.load().level;
	REQUIRE(materialOf(level, 0).mask == 0);
	CHECK_FALSE(isSolidAt(level, materialOf(level, 0), {0.5, 0.1}));
	CHECK(isSolidAt(level, materialOf(level, 0), {0.5, 0.5}));
}

TEST_CASE("scene: a mask is read as its sampler filters", "[scene]")
{
	const int filter = GENERATE(9728, 9729);
	Cube cube;
	addRows(cube, filter);
	cube.json["materials"] = {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
	cube.primitive()["material"] = 0;
	const Level level = cube.load().level;
	const Mask& mask = level.masks.at(0);
	CHECK(mask.nearest == (filter == 9728));
	// Rows 0 and 1 of 8 are clear: just above their end, a nearest texel is clear and an interpolated one is half clear.
	CHECK(alphaAt(mask, {0.3, 0.249}) == Approx(filter == 9728 ? 0.0 : 0.492).margin(1e-9));
	CHECK(alphaAt(mask, {0.3, 0.251}) == Approx(filter == 9728 ? 1.0 : 0.508).margin(1e-9));
	CHECK(alphaAt(mask, {-7.0, 1.01}) == Approx(filter == 9728 ? 0.0 : 0.0 + 0.42).margin(1e-9));
}

TEST_CASE("scene: hidden nodes and all below them are left out", "[scene]")
{
	const bool required = GENERATE(false, true);
	Cube cube;
	cube.json["nodes"] = {
		{{"mesh", 0}},
		{{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
		{{"name", "lamp"}, {"mesh", 0}, {"translation", {5, 0, 0}}},
		{{"mesh", 0}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}, {"translation", {9, 0, 0}}}};
	cube.json["scenes"][0]["nodes"] = {0, 1, 3};
	if (required)
	{
		cube.json["extensionsRequired"] = {"KHR_node_visibility"};
	}
	const LoadedLevel loaded = cube.load();
	CHECK(loaded.level.triangles.size() == 24);
	CHECK(findingsOf(loaded.diagnosis) == "hidden-nodes 1 dropped");
	CHECK(loaded.diagnosis.findings[0].first == "node 'lamp'");
	cube.json["nodes"][1]["extensions"]["KHR_node_visibility"]["visible"] = "no";
	CHECK(cube.refusal().starts_with("3: nodes[1].extensions.KHR_node_visibility.visible: found "));
}

TEST_CASE("scene: parts are chosen by name, path, material and extras", "[scene]")
{
	Cube cube;
	cube.json["materials"] = {{{"name", "wood"}}, {{"name", "glass"}}};
	cube.json["meshes"] = {cube.json["meshes"][0], cube.json["meshes"][0]};
	cube.json["meshes"][0]["primitives"][0]["material"] = 0;
	cube.json["meshes"][1] = {
		{"name", "pane"}, {"primitives", cube.json["meshes"][1]["primitives"]}, {"extras", {{"kind", "thin"}}}};
	cube.json["meshes"][1]["primitives"][0]["material"] = 1;
	cube.json["nodes"] = {{{"name", "Room"}, {"children", {1, 2}}, {"extras", {{"static", true}}}},
						  {{"name", "Table"}, {"mesh", 0}},
						  {{"name", "Window"}, {"children", {3}}},
						  {{"name", "UCX_Sash"}, {"mesh", 1}, {"translation", {5, 0, 0}}},
						  {{"name", "Sky.001"}, {"mesh", 0}, {"translation", {9, 0, 0}}}};
	cube.json["scenes"][0]["nodes"] = {0, 4};
	const LoadedLevel loaded = cube.load();
	REQUIRE(loaded.level.triangles.size() == 36);
	CHECK(findingsOf(loaded.diagnosis) == "collision-meshes 1 kept, skies 1 kept");
	CHECK(loaded.diagnosis.findings[0].first == "mesh 'pane', which --ignore 'UCX_Sash' leaves out");
	CHECK(pathOf(loaded.level, loaded.level.meshes[1]) == "/Room/Window/UCX_Sash/pane");
	// Which of the three cubes, as 0 or 1 each; "": refused.
	const auto chosenOf = [&](const std::vector<std::string>& patterns) -> std::string
	{
		try
		{
			const std::vector<uint8_t> chosen = chosenTriangles(loaded.level, patterns, "ignore");
			return {static_cast<char>('0' + chosen[0]), static_cast<char>('0' + chosen[12]), static_cast<char>('0' + chosen[24])};
		}
		catch (const Error& error)
		{
			CHECK(error.code() == ExitCode::usage);
			return "";
		}
	};
	const std::map<std::string, std::vector<std::string>> cases{
		{"100", {"Table", "T*e", "?????", "/*/Table"}},
		{"110", {"Room", "/Room", "/Room/*", "extras:static", "extras:static=true"}},
		{"010", {"pane", "Room/Window", "/**/pane", "/Room/**/pane", "material:gl*", "extras:kind=th*", "extras:k*"}},
		{"101", {"cube*", "material:wood"}},
		{"111", {"*", "**"}},
		{"", {"table", "Tab", "/Table", "/Room/*/pane", "material:", "extras:static=false", "wood", "/", "//", "["}}};
	for (const auto& [expected, patterns] : cases)
	{
		for (const std::string& pattern : patterns)
		{
			INFO(pattern);
			CHECK(chosenOf({pattern}) == expected);
		}
	}
	CHECK(chosenOf({"Table", "material:glass"}) == "110");
	CHECK(chosenOf({"Table", "none"}).empty());
	CHECK_THROWS_WITH(chosenTriangles(loaded.level, std::vector<std::string>{"Tabel"}, "ignore"),
					  "ignore: found 'Tabel', expected parts of a.gltf: '/Room/Table/cube', '/Room/Window/UCX_Sash/pane', "
					  "'/Sky.001/cube'");
	CHECK_THROWS_WITH(chosenTriangles(loaded.level, std::vector<std::string>{"extras:a"}, "ignore"),
					  "ignore: found 'extras:a', expected parts of a.gltf: 'extras:static=true', 'extras:kind=thin'");
}

TEST_CASE("scene: a level without ignored parts is that of a file without them", "[scene]")
{
	Cube cube;
	cube.json["nodes"] = {{{"name", "a"}, {"mesh", 0}}, {{"name", "b"}, {"mesh", 0}, {"translation", {1, 0, 0}}}};
	cube.json["scenes"][0]["nodes"] = {0, 1};
	const TemporaryFolder folder;
	const std::string path = folder / "a.gltf";
	writeFile(path, gltfText(cube.json, cube.buffer));
	LoadSettings settings;
	settings.ignore = {"b"};
	const LoadedLevel ignoring = loadLevel(path, settings, {});
	const std::vector<GltfPlace> places = loadPlaces(path, settings, ignoring.level, {}, {});
	const std::vector<GltfPlace> receiving = loadPlaces(path, {}, loadLevel(path, {}, {}).level, std::vector<std::string>{"b"}, {});
	settings.ignore = {"b", "a"};
	CHECK_THROWS_WITH(loadLevel(path, settings, {}), "a.gltf: ignore: found every part, expected one that is left");
	cube.json["scenes"][0]["nodes"] = {0};
	const LoadedLevel without = cube.load();
	CHECK(ignoring.level.positions == without.level.positions);
	CHECK(ignoring.level.triangles == without.level.triangles);
	REQUIRE(places.size() == 1);
	CHECK((places[0].node == 0 && places[0].vertices.size() == 8));
	REQUIRE(receiving.size() == 1);
	CHECK((receiving[0].node == 1 && receiving[0].vertices.size() == 8 && receiving[0].vertices[0].second >= 8));
}

TEST_CASE("scene: instances that have attributes of their own alone", "[scene]")
{
	Cube cube;
	const std::size_t ids = cube.accessor(cube.view(packed(std::vector<float>{1, 2, 3})), 5126, 3, "SCALAR");
	cube.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = {{"attributes", {{"_ID", ids}}}};
	const LoadedLevel loaded = cube.load();
	CHECK(loaded.level.triangles.size() == 12);
	CHECK(findingsOf(loaded.diagnosis) == "duplicate-faces 24 dropped, empty-meshes 2 dropped");
	cube.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = nlohmann::json::object();
	CHECK(cube.refusal().find("found no attribute, expected one at least, such as TRANSLATION") != std::string::npos);
	cube.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"_ID", 99}};
	CHECK(cube.refusal().starts_with("3: nodes[0].extensions.EXT_mesh_gpu_instancing.attributes._ID: found 99"));
}

TEST_CASE("scene: materials with transmission count once each where they are used", "[scene]")
{
	Cube cube;
	const nlohmann::json glass = {{"name", "glass"},
								  {"extensions", {{"KHR_materials_transmission", {{"transmissionFactor", 0.9}}}}}};
	cube.json["materials"] = {glass, glass};
	cube.json["meshes"][0]["primitives"].push_back(cube.primitive());
	for (nlohmann::json& primitive : cube.json["meshes"][0]["primitives"])
	{
		primitive["material"] = 0;
	}
	const LoadedLevel loaded = cube.load();
	CHECK(loaded.diagnosis.findings.at(0).id == "transmission");
	CHECK(loaded.diagnosis.findings[0].count == 1);
	CHECK(loaded.diagnosis.findings[0].first == "material 'glass'");
	cube.json["materials"][0]["extensions"]["KHR_materials_transmission"]["transmissionFactor"] = 0;
	CHECK(cube.load().diagnosis.findings.at(0).id != "transmission");
}

TEST_CASE("scene: a scene may list nodes that it has through their parents", "[scene]")
{
	Cube cube;
	cube.json["nodes"] = {{{"children", {1}}, {"translation", {1, 0, 0}}}, {{"mesh", 0}, {"translation", {0, 2, 0}}}};
	cube.json["scenes"][0]["nodes"] = {1, 0};
	const LoadedLevel loaded = cube.load();
	checkCube(loaded);
	CHECK(boundsOf(loaded.level).least == glm::dvec3(1.0, 2.0, 0.0));
}

TEST_CASE("scene: glTF that asks for more than it holds is refused", "[scene]")
{
	Cube cube;
	cube.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}};
	cube.json["scenes"][0]["nodes"] = {1};
	CHECK(cube.refusal() ==
		  "3: scenes[0].nodes: found node 1, a child of node 0, expected nodes that have no parent, or one in the scene");
	Cube coordinates;
	coordinates.primitive()["attributes"]["TEXCOORD_7"] = coordinates.accessor(1, 5126, 2, "VEC2");
	CHECK(coordinates.refusal().starts_with("3: meshes[0].primitives[0].attributes.TEXCOORD_7: found 2 values"));
	const TemporaryFolder folder;
	const auto refused = [&](const std::string& name, const std::string& text)
	{
		try
		{
			loadText(folder / name, text);
		}
		catch (const Error& error)
		{
			const std::string line = error.what();
			return line.substr(line.find(name) + name.size());
		}
		return std::string("none");
	};
	std::string many = "[0";
	for (int i = 0; i < 4200000; ++i)
	{
		many += ",0";
	}
	CHECK(refused("b.gltf", many + "]").starts_with(": JSON: found 4200001 values"));
	CHECK(refused("b.gltf", glbBytes(cubeGltf(), cubeBuffer())).starts_with(": header: found a binary glTF"));
	CHECK(refused("b.glb", glbBytes(cubeGltf(), cubeBuffer())) == "none");
	CHECK(refused("b.gltf", R"({"asset": {"version": "2\u0000"}})") == ": JSON: found a character 0 at byte 24, expected text");
	CHECK(refused("b.gltf", "\xEF\xBB\xBF" + gltfText(cubeGltf())) == "none");
}

// Skins and morph targets of glTF in the file's pose.

TEST_CASE("scene: a skin stands where its joints are", "[scene]")
{
	const Cube cube = skinnedCube();
	const LoadedLevel posed = loadedIn(cube, Pose::file);
	CHECK(findingsOf(posed.diagnosis) == "posed-meshes 1 applied");
	CHECK(posed.diagnosis.findings[0].first == "node 'box'");
	CHECK(boundsOf(posed.level).least == glm::dvec3(0.0));
	CHECK(boundsOf(posed.level).most == glm::dvec3(2.0, 3.0, 2.0));
	CHECK(volumeOf(posed.level) == Approx(3.0 * (1.0 + 4.0 + 2.0) / 3.0)); // a frustum of squares with sides 1 and 2
	const LoadedLevel rest = loadedIn(cube, Pose::rest);
	CHECK(findingsOf(rest.diagnosis) == "not-applied 1 ignored");
	CHECK(boundsOf(rest.level).least == glm::dvec3(500.0, 0.0, 0.0));
	CHECK(volumeOf(rest.level) == Approx(1.0));
}

TEST_CASE("scene: weights of a skin are a mean, whatever their sum", "[scene]")
{
	Cube cube = skinnedCube();
	std::vector<uint16_t> joints;
	std::vector<float> weights;
	for (unsigned i = 0; i < 8; ++i)
	{
		joints.insert(joints.end(), {0, 1, 0, 0});
		weights.insert(weights.end(), {1.0F, 3.0F, 0.0F, 0.0F});
	}
	nlohmann::json& attributes = cube.primitive()["attributes"];
	attributes["JOINTS_0"] = cube.accessor(cube.view(packed(joints)), 5123, 8, "VEC4");
	attributes["WEIGHTS_0"] = cube.accessor(cube.view(packed(weights)), 5126, 8, "VEC4");
	// A quarter of p and three quarters of 2p + (0, 1, 0).
	LoadedLevel loaded = loadedIn(cube, Pose::file);
	CHECK(boundsOf(loaded.level).least == glm::dvec3(0.0, 0.75, 0.0));
	CHECK(boundsOf(loaded.level).most == glm::dvec3(1.75, 2.5, 1.75));
	std::fill(weights.begin(), weights.end(), 0.0F); // all zero: the first joint
	attributes["WEIGHTS_0"] = cube.accessor(cube.view(packed(weights)), 5126, 8, "VEC4");
	loaded = loadedIn(cube, Pose::file);
	CHECK(boundsOf(loaded.level).most == glm::dvec3(1.0));
	// A second set of four joints has the remaining weights.
	std::fill(weights.begin(), weights.end(), 0.25F);
	for (const char* const set : {"_0", "_1"})
	{
		attributes[std::string("JOINTS") + set] = attributes["JOINTS_0"];
		attributes[std::string("WEIGHTS") + set] = cube.accessor(cube.view(packed(weights)), 5126, 8, "VEC4");
	}
	loaded = loadedIn(cube, Pose::file); // joint 0 six times, joint 1 twice
	CHECK(boundsOf(loaded.level).most == glm::dvec3(1.25, 1.5, 1.25));
}

TEST_CASE("scene: joints that mirror keep the front outside", "[scene]")
{
	Cube cube = skinnedCube();
	cube.json["nodes"][1]["scale"] = {-1, 1, 1};
	const LoadedLevel loaded = loadedIn(cube, Pose::file);
	CHECK(boundsOf(loaded.level).least.x == -2.0);
	CHECK(volumeOf(loaded.level) == Approx(7.0));
}

TEST_CASE("scene: morph targets by the file's default weights", "[scene]")
{
	Cube cube;
	std::vector<float> up;
	for (unsigned i = 0; i < 8; ++i)
	{
		up.insert(up.end(), {0.0F, 2.0F, 0.0F});
	}
	const std::size_t moved = cube.accessor(cube.view(packed(up)), 5126, 8, "VEC3");
	cube.primitive()["targets"] = {{{"POSITION", moved}}, {{"POSITION", moved}, {"NORMAL", moved}}};
	CHECK(findingsOf(loadedIn(cube, Pose::file).diagnosis).empty()); // all weights are 0
	cube.json["meshes"][0]["weights"] = {1.0, 0.25};
	LoadedLevel loaded = loadedIn(cube, Pose::file);
	CHECK(findingsOf(loaded.diagnosis) == "posed-meshes 1 applied");
	CHECK(boundsOf(loaded.level).least.y == 2.5);
	CHECK(volumeOf(loaded.level) == Approx(1.0));
	loaded = loadedIn(cube, Pose::rest);
	CHECK(findingsOf(loaded.diagnosis) == "not-applied 1 ignored");
	CHECK(boundsOf(loaded.level).least.y == 0.0);
	cube.json["nodes"][0]["weights"] = {-0.5,
										0.0}; // a node's weights replace the mesh's; negative ones are allowed and move backwards
	CHECK(boundsOf(loadedIn(cube, Pose::file).level).least.y == -1.0);
	// Then the skin: scaled by two around the joint.
	Cube both = skinnedCube();
	both.primitive()["targets"] = {{{"POSITION", both.accessor(both.view(packed(up)), 5126, 8, "VEC3")}}};
	both.json["meshes"][0]["weights"] = {0.5};
	CHECK(boundsOf(loadedIn(both, Pose::file).level).most.y == 5.0);
}

TEST_CASE("scene: broken skins and morph targets are refused by name", "[scene]")
{
	Cube none = skinnedCube();
	none.json["skins"][0]["joints"] = nlohmann::json::array();
	CHECK(none.refusal() == "3: skins[0].joints: found none, expected nodes that move the skin");
	Cube far = skinnedCube();
	far.json["skins"][0]["joints"] = {1};
	CHECK(far.refusal() == "3: meshes[0].primitives[0]: found joint 1 at vertex 6, expected one below 1");
	Cube unused = skinnedCube(); // a joint that does not exist, with weight 0
	for (std::size_t i = 0; i < 8; ++i)
	{
		unused.buffer[232 + 4 * i + 1] = 77;
	}
	CHECK(findingsOf(loadedIn(unused, Pose::file).diagnosis) == "posed-meshes 1 applied");
	Cube beyond = skinnedCube();
	beyond.json["skins"][0]["joints"] = {1, 9};
	CHECK(beyond.refusal().starts_with("3: skins[0].joints"));
	Cube few = skinnedCube();
	few.json["skins"][0]["joints"] = {1, 2, 0};
	CHECK(few.refusal().starts_with("3: skins[0].inverseBindMatrices: found 2 values of type MAT4, expected 3"));
	Cube floats = skinnedCube();
	const std::string eight(8 * 16, '\0');
	floats.primitive()["attributes"]["JOINTS_0"] = floats.accessor(floats.view(eight), 5126, 8, "VEC4");
	CHECK(floats.refusal() ==
		  "3: meshes[0].primitives[0].attributes.JOINTS_0: found an accessor of component type 5126, expected 5121 or 5123");
	Cube weightless = skinnedCube();
	weightless.primitive()["attributes"].erase("WEIGHTS_0");
	CHECK(weightless.refusal() == "3: meshes[0].primitives[0].attributes.WEIGHTS_0: found none, expected one for each of JOINTS_0");
	Cube morph;
	morph.primitive()["targets"] = {{{"POSITION", 0}}};
	morph.json["meshes"][0]["weights"] = {0.5, 0.5};
	CHECK(morph.refusal().starts_with("3: meshes[0].weights: found "));
	morph.json["meshes"][0]["weights"] = {0.5};
	morph.primitive()["targets"] = {{{"POSITION", 2}}};
	CHECK(morph.refusal() == "3: meshes[0].primitives[0].targets[0].POSITION: found 36 values, expected 8, as many as positions");
	morph.primitive()["targets"] = {{{"POSITION", 1}}};
	CHECK(morph.refusal() == "3: meshes[0].primitives[0].targets[0].POSITION: found an accessor of type VEC2, expected VEC3");
	// A skin on a mesh without joint attributes has no effect.
	Cube rigid;
	rigid.json["skins"] = {{{"joints", {0}}}};
	rigid.json["nodes"][0]["skin"] = 0;
	CHECK(findingsOf(rigid.load().diagnosis) == "not-applied 1 ignored");
}
