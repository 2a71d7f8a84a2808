// SPDX-License-Identifier: GPL-3.0-or-later
// Skins and morph targets of glTF in the file's pose.
#include "cube_gltf.h"

#include <catch2/catch.hpp>

using namespace nook;

namespace
{

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
