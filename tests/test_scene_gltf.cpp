// SPDX-License-Identifier: GPL-3.0-or-later
// What glTF says in more than one way, and what of it is another level than it seems.
#include "cube_gltf.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace nook;

namespace
{

void checkCube(const LoadedLevel& loaded)
{
	CHECK(findingsOf(loaded.diagnosis).empty());
	CHECK(loaded.level.triangles.size() == 12);
	CHECK(areaOf(loaded.level) == Approx(6.0));
	CHECK(volumeOf(loaded.level) == Approx(1.0));
}

// Corner i of the cube as whole numbers, up to `one`, in `each` numbers.
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
			append(bytes, cubeCorner(i).x); // the texture coordinates' place, and a gap
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
		// Corners 0 and 7 are moved to themselves and away; the rest stays.
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
		// Not normalised: the node's scale makes them metres.
		cube.primitive()["attributes"]["POSITION"] = cube.accessor(cube.view(wholeCorners<int16_t>(100, 4), 8), 5122, 8, "VEC3");
		cube.json["nodes"][0]["scale"] = {0.01, 0.01, 0.01};
		checkCube(cube.load());
	}
}

TEST_CASE("scene: glTF strips, fans and lists without indices", "[scene]")
{
	Cube cube;
	// A face of two triangles, and two without area that would lead to a next one.
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
	bare.primitive().erase("indices"); // corners 0 1 2, 3 4 5; two are left over
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

TEST_CASE("scene: skins and morph targets are not applied, and said so", "[scene]")
{
	Cube skin;
	skin.json["skins"] = {{{"joints", {0}}}};
	skin.json["nodes"][0]["skin"] = 0;
	CHECK(findingsOf(skin.load().diagnosis) == "not-applied 1 ignored");
	Cube morph;
	morph.primitive()["targets"] = {{{"POSITION", 0}}};
	CHECK(morph.load().diagnosis.findings.at(0).first == "box");
}

TEST_CASE("scene: glTF that asks for more than it holds is refused", "[scene]")
{
	Cube cube;
	cube.json["nodes"] = {{{"children", {1}}}, {{"mesh", 0}}};
	cube.json["scenes"][0]["nodes"] = {0, 1};
	CHECK(cube.refusal() == "3: scenes[0].nodes: found node 1, a child of node 0, expected nodes that have no parent");
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
