// SPDX-License-Identifier: GPL-3.0-or-later
// FBX files generated here, and what must be read from them.
#include "fbx_files.h"
#include "small_levels.h"
#include "testing.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <tuple>

namespace
{

using Numbers = std::vector<FbxTestValue>;

LoadedLevel loadScene(const TemporaryFolder& folder, const FbxTestScene& scene, const LoadSettings& settings = {})
{
	return loadText(folder / "a.fbx", scene.bytes(), settings);
}

Numbers numbers(std::initializer_list<double> values)
{
	return {values.begin(), values.end()};
}

std::string refusalOf(const TemporaryFolder& folder, const std::string& bytes, ExitCode code = ExitCode::invalid_input)
{
	const std::string what = refusalBy([&] { loadText(folder / "a.fbx", bytes); }, code);
	return what.empty() ? "none" : what.substr(what.find("a.fbx: ") + 7);
}

// A sheet from 0 to 1 in x and z at y = 0, seen from above; texture coordinates are x and −z.
FbxTestNode& addSheet(FbxTestScene& scene, int64_t id, int64_t node)
{
	FbxTestNode& mesh = scene.mesh(id, "sheet", {0, 0, 0, 0, 0, 1, 1, 0, 1, 1, 0, 0}, {0, 1, 2, -4}, node);
	FbxTestNode& uv = mesh.add("LayerElementUV", {int64_t{0}});
	uv.add("Name", {std::string("map1")});
	uv.add("MappingInformationType", {std::string("ByPolygonVertex")});
	uv.add("ReferenceInformationType", {std::string("IndexToDirect")});
	uv.add("UV", {std::vector<double>{0, 0, 1, 0, 1, 1, 0, 1}});
	uv.add("UVIndex", {std::vector<int32_t>{3, 0, 1, 2}});
	return mesh;
}

// Adds a material with a mask picture to the node.
FbxTestNode& addMask(FbxTestScene& scene, int64_t node, const std::string& property = "TransparentColor")
{
	scene.object("Material", 300, "net", "", node);
	FbxTestNode& texture = scene.object("Texture", 400, "mask", "");
	texture.add("RelativeFilename", {std::string("mask.png")});
	scene.connect(400, 300, property);
	return texture;
}

// Texture coordinates at a vertex position, v upward as in the file.
glm::dvec2 uvAt(const Level& level, glm::dvec3 position)
{
	for (std::size_t i = 0; i < level.positions.size(); ++i)
	{
		if (glm::distance(level.positions[i], position) < 1e-9)
		{
			return {level.uvs[i].x, 1.0F - level.uvs[i].y};
		}
	}
	FAIL("no vertex there");
	return {};
}

void checkUv(const Level& level, glm::dvec3 position, glm::dvec2 expected)
{
	const glm::dvec2 found = uvAt(level, position);
	INFO("found " << found.x << " " << found.y << ", expected " << expected.x << " " << expected.y);
	CHECK(glm::distance(found, expected) < 1e-6);
}

glm::dmat3 turnAbout(int axis, double degrees)
{
	const double s = std::sin(degrees * kPi / 180.0);
	const double c = std::cos(degrees * kPi / 180.0);
	return axis == 0   ? glm::dmat3(1, 0, 0, 0, c, s, 0, -s, c)
		   : axis == 1 ? glm::dmat3(c, 0, -s, 0, 1, 0, s, 0, c)
					   : glm::dmat3(c, s, 0, -s, c, 0, 0, 0, 1);
}

// One triangle, so that positions can be identified.
const std::vector<double> kPoints{1, 2, 3, 4, -5, 6, -7, 8, 10};
const std::vector<int32_t> kTriangle{0, 1, -3};

void checkPoints(const Level& level, const glm::dmat3& turn, glm::dvec3 move)
{
	REQUIRE(level.positions.size() == 3);
	for (std::size_t i = 0; i < 3; ++i)
	{
		checkNear(level.positions[i], turn * glm::dvec3(kPoints[3 * i], kPoints[3 * i + 1], kPoints[3 * i + 2]) + move, 1e-9);
	}
}

// A strip of three points along x at 0, 1, 2, and one at (0, 0, 1), with a bone "hand" at x = 2 rotated about z, with the given
// weights.
void addSkin(FbxTestScene& scene, const std::vector<double>& weights, const std::string& mode, glm::dvec3 hand_turn)
{
	scene.model(1, "body").set("Lcl Translation", numbers({0.0, 100.0, 0.0}));
	scene.mesh(10, "body", {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 0, 1}, {3, 1, -1, 3, 2, -2}, 1);
	scene.model(2, "arm", 0, "LimbNode");
	FbxTestNode& hand = scene.model(3, "hand", 2, "LimbNode");
	hand.set("Lcl Translation", numbers({2.0, 0.0, 0.0})).set("Lcl Rotation", numbers({hand_turn.x, hand_turn.y, hand_turn.z}));
	scene.object("Deformer", 60, "skin", "Skin", 10);
	FbxTestNode& cluster = scene.object("Deformer", 61, "cluster", "Cluster", 60);
	scene.connect(3, 61);
	if (!mode.empty())
	{
		cluster.add("Mode", {mode});
	}
	cluster.add("Indexes", {std::vector<int32_t>{0, 1, 2}});
	cluster.add("Weights", {weights});
	// The mesh was bound at the origin, where the node no longer is.
	cluster.add("Transform", {std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1}});
	cluster.add("TransformLink", {std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1}});
}

// Positions of the points that started along x.
std::vector<glm::dvec3> stripOf(const Level& level)
{
	// Corners 3 1 0, 3 2 1.
	return {level.positions.at(2), level.positions.at(1), level.positions.at(4), level.positions.at(0)};
}

} // namespace

TEST_CASE("scene: FBX reads the same from text and every binary form", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	scene.model(1, "Sheet").set("Lcl Translation", numbers({500000.125, 0.0, 4649776.2224721}));
	addSheet(scene, 10, 1);
	const Level expected = loadText(folder / "a.fbx", scene.text()).level;
	CHECK(expected.meshes.front().name == "sheet");
	CHECK(expected.positions.front() == glm::dvec3(500000.125, 0.0, 4649776.2224721)); // full precision
	CHECK(areaOf(expected) == Approx(1.0));
	checkUv(expected, {500000.125, 0.0, 4649777.2224721}, {0.0, 0.0});
	const uint32_t version = GENERATE(7100U, 7400U, 7500U, 7700U);
	const bool compressed = GENERATE(false, true);
	const bool big_endian = GENERATE(false, true);
	INFO(version << " " << compressed << " " << big_endian);
	const Level level = loadText(folder / "b.fbx", scene.bytes({version, compressed, big_endian})).level;
	CHECK(level.positions == expected.positions);
	CHECK(level.uvs == expected.uvs);
	CHECK(level.triangles == expected.triangles);
	CHECK(level.meshes.front().name == "sheet");
}

TEST_CASE("scene: a small FBX mesh at map coordinates keeps its shape", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	scene.model(1, "Box");
	std::vector<double> points;
	for (unsigned i = 0; i < 8; ++i)
	{
		const glm::dvec3 p = glm::dvec3(500000.0, 4649776.0, 100.0) + 0.3 * glm::dvec3(cubeCorner(i));
		points.insert(points.end(), {p.x, p.y, p.z});
	}
	std::vector<int32_t> corners;
	for (const auto& q : kCubeQuads)
	{
		for (std::size_t i = 0; i < 4; ++i)
		{
			corners.push_back(i < 3 ? static_cast<int32_t>(q[i]) : -1 - static_cast<int32_t>(q[i]));
		}
	}
	scene.mesh(10, "box", points, corners, 1);
	const LoadedLevel loaded = loadText(folder / "a.fbx", scene.text());
	CHECK(loaded.level.triangles.size() == 12);
	CHECK(areaOf(loaded.level) == Approx(0.54).epsilon(1e-7));
}

TEST_CASE("scene: hidden nodes of FBX are left out", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	FbxTestNode& parent = scene.model(1, "parent");
	FbxTestNode& child = scene.model(2, "child", 1);
	child.set("Lcl Translation", numbers({0.0, 5.0, 0.0})).set("Show", {1.0});
	scene.model(3, "other").set("Lcl Translation", numbers({0.0, 50.0, 0.0}));
	for (int64_t node = 1; node <= 3; ++node)
	{
		scene.box(10 + node, node);
	}
	CHECK(loadScene(folder, scene).level.triangles.size() == 36);
	const auto with = [&](FbxTestNode& node, const std::string& property, double value)
	{
		node.set(property, {value});
		const LoadedLevel loaded = loadScene(folder, scene);
		node.child("Properties70").children.pop_back();
		return std::to_string(loaded.level.triangles.size()) + " " + findingsOf(loaded.diagnosis);
	};
	CHECK(with(parent, "Visibility", 0.0) == "12 hidden-nodes 2 dropped");
	CHECK(with(parent, "Show", 0.0) == "24 hidden-nodes 1 dropped"); // not inherited by its children
	CHECK(with(child, "Visibility", 0.0) == "24 hidden-nodes 1 dropped");
	CHECK(with(child, "Visibility", 0.5) == "36 ");
	for (const char* const name : {"Visibility Inheritance", "VisibilityInheritance"})
	{
		child.child("Properties70").children.pop_back();
		child.set(name, {int64_t{0}});
		CHECK(with(parent, "Visibility", 0.0) == "24 hidden-nodes 1 dropped");
	}
	// A hidden layer hides its contents.
	FbxTestNode& layer = scene.object("CollectionExclusive", 50, "layer", "DisplayLayer");
	scene.connect(3, 50);
	CHECK(with(layer, "Show", 1.0) == "36 ");
	CHECK(with(layer, "Show", 0.0) == "24 hidden-nodes 1 dropped");
	// The type's template applies to nodes that state nothing.
	FbxTestNode& type = scene.root.child("Definitions").add("ObjectType", {std::string("Model")});
	type.add("PropertyTemplate", {std::string("FbxNode")}).set("Visibility", {0.0});
	child.set("Visibility", {1.0});
	const LoadedLevel loaded = loadScene(folder, scene);
	CHECK(findingsOf(loaded.diagnosis) == "hidden-nodes 2 dropped");
	CHECK(loaded.diagnosis.findings.front().first == "node 'parent'");
}

TEST_CASE("scene: of the levels of detail of FBX the first is read", "[scene]")
{
	const TemporaryFolder folder;
	const bool by_attribute = GENERATE(true, false);
	FbxTestScene scene;
	scene.model(1, "group", 0, by_attribute ? "Null" : "LodGroup");
	if (by_attribute)
	{
		scene.object("NodeAttribute", 20, "group", "LodGroup", 1);
	}
	for (int64_t level = 0; level < 3; ++level)
	{
		scene.model(2 + level, "lod" + std::to_string(level), 1);
		scene.box(10 + level, 2 + level, glm::dvec3(1.0 + static_cast<double>(level)));
	}
	scene.model(9, "below", 3);
	scene.box(19, 9);
	const LoadedLevel loaded = loadScene(folder, scene);
	checkBox(loaded.level, glm::dvec3(-1.0), glm::dvec3(1.0));
	CHECK(findingsOf(loaded.diagnosis) == "lower-lods 3 dropped");
	CHECK(loaded.diagnosis.findings.front().first == "node 'lod1'");
	// If the first one is hidden, the next one represents it.
	for (FbxTestNode& object : scene.root.child("Objects").children)
	{
		if (object.values[1] == FbxTestValue(std::string("Model::lod0")))
		{
			object.set("Visibility", {0.0});
		}
	}
	CHECK(findingsOf(loadScene(folder, scene).diagnosis) == "lower-lods 2 dropped");
}

TEST_CASE("scene: FBX nodes turn in every order, between their pivots", "[scene]")
{
	const TemporaryFolder folder;
	constexpr std::array<std::array<int, 3>, 6> kOrders{{{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}}};
	const glm::dvec3 euler(10.0, 20.0, 30.0);
	const auto turnOf = [&](glm::dvec3 degrees, std::size_t order)
	{
		glm::dmat3 turn(1.0);
		for (const int axis : kOrders[order])
		{
			turn = turnAbout(axis, degrees[axis]) * turn;
		}
		return turn;
	};
	for (std::size_t order = 0; order <= 6; ++order)
	{
		INFO("order " << order);
		FbxTestScene scene;
		FbxTestNode& node = scene.model(1, "node");
		scene.mesh(10, "one", kPoints, kTriangle, 1);
		node.set("Lcl Rotation", numbers({euler.x, euler.y, euler.z})).set("RotationOrder", {static_cast<int64_t>(order)});
		const glm::dmat3 turn = turnOf(euler, order % 6); // 6, spheric, turns as XYZ
		checkPoints(loadScene(folder, scene).level, turn, glm::dvec3(0.0));

		// The other rotations are XYZ in any order.
		node.set("PreRotation", numbers({5.0, 15.0, 25.0})).set("PostRotation", numbers({7.0, 17.0, 27.0}));
		node.set("GeometricRotation", numbers({20.0, 40.0, 60.0}));
		const glm::dmat3 whole = turnOf({5.0, 15.0, 25.0}, 0) * turn * glm::transpose(turnOf({7.0, 17.0, 27.0}, 0));
		checkPoints(loadScene(folder, scene).level, whole * turnOf({20.0, 40.0, 60.0}, 0), glm::dvec3(0.0));

		node.set("RotationActive", {int64_t{0}}); // no order, no pre- and post-rotation
		checkPoints(loadScene(folder, scene).level, turnOf(euler, 0) * turnOf({20.0, 40.0, 60.0}, 0), glm::dvec3(0.0));
	}

	// T · Roff · Rp · R · Rp⁻¹ · Soff · Sp · S · Sp⁻¹, by hand.
	FbxTestScene scene;
	FbxTestNode& node = scene.model(1, "node");
	scene.mesh(10, "one", kPoints, kTriangle, 1);
	node.set("Lcl Translation", numbers({100.0, 0.0, 0.0})).set("RotationOffset", numbers({0.0, 10.0, 0.0}));
	node.set("RotationPivot", numbers({1.0, 0.0, 0.0})).set("Lcl Rotation", numbers({0.0, 0.0, 90.0}));
	node.set("ScalingOffset", numbers({0.0, 0.0, 5.0})).set("ScalingPivot", numbers({0.0, 1.0, 0.0}));
	node.set("Lcl Scaling", numbers({1.0, 2.0, 1.0}));
	const glm::dmat3 scale(1, 0, 0, 0, 2, 0, 0, 0, 1);
	const glm::dmat3 turn(0, 1, 0, -1, 0, 0, 0, 0, 1); // exactly
	const glm::dvec3 inner = glm::dvec3(0.0, 1.0, 0.0) - scale * glm::dvec3(0.0, 1.0, 0.0) + glm::dvec3(0.0, 0.0, 5.0);
	checkPoints(loadScene(folder, scene).level, turn * scale,
				glm::dvec3(100.0, 10.0, 0.0) + glm::dvec3(1.0, 0.0, 0.0) + turn * (inner - glm::dvec3(1.0, 0.0, 0.0)));
	CHECK(loadScene(folder, scene).level.positions[0].x == std::round(loadScene(folder, scene).level.positions[0].x));
}

TEST_CASE("scene: FBX geometric transforms move the mesh, not the children", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	FbxTestNode& parent = scene.model(1, "parent");
	parent.set("GeometricTranslation", numbers({10.0, 0.0, 0.0})).set("GeometricScaling", numbers({2.0, 2.0, 2.0}));
	scene.model(2, "child", 1).set("Lcl Translation", numbers({0.0, 5.0, 0.0}));
	scene.box(10, 1);
	scene.box(11, 2);
	const Level level = loadScene(folder, scene).level;
	checkBox(level, {-1.0, -2.0, -2.0}, {12.0, 6.0, 2.0});
}

TEST_CASE("scene: FBX nodes inherit scale in three ways", "[scene]")
{
	const TemporaryFolder folder;
	// A bar of 8 along x, rotated to z below a parent stretched by 3 along z.
	for (const auto& [type, half] :
		 {std::pair{0, glm::dvec3(3.0, 1.0, 4.0)}, {1, glm::dvec3(1.0, 1.0, 12.0)}, {2, glm::dvec3(1.0, 1.0, 4.0)}})
	{
		INFO("type " << type);
		FbxTestScene scene;
		scene.model(1, "parent", 0, "Null").set("Lcl Scaling", numbers({1.0, 1.0, 3.0}));
		FbxTestNode& node = scene.model(2, "bar", 1);
		node.set("Lcl Rotation", numbers({0.0, 90.0, 0.0})).set("Lcl Translation", numbers({10.0, 0.0, 10.0}));
		node.set("InheritType", {static_cast<int64_t>(type)});
		scene.box(10, 2, {4.0, 1.0, 1.0});
		const glm::dvec3 at(10.0, 0.0, 30.0);
		checkBox(loadScene(folder, scene).level, at - half, at + half);
	}
	// Rrs ignores only the parent's own scale; the grandparent's remains.
	FbxTestScene scene;
	scene.model(1, "grandparent", 0, "Null").set("Lcl Scaling", numbers({2.0, 2.0, 2.0}));
	scene.model(2, "parent", 1, "Null").set("Lcl Scaling", numbers({5.0, 5.0, 5.0}));
	scene.model(3, "box", 2).set("InheritType", {int64_t{2}});
	scene.box(10, 3);
	checkBox(loadScene(folder, scene).level, glm::dvec3(-2.0), glm::dvec3(2.0));
}

TEST_CASE("scene: FBX opacity textures lie as the file says", "[scene]")
{
	const TemporaryFolder folder;
	writeFile(folder / "mask.png", rowsPng());
	const auto load = [&](const std::function<void(FbxTestNode&)>& change)
	{
		FbxTestScene scene;
		scene.model(1, "node");
		FbxTestNode& mesh = addSheet(scene, 10, 1);
		FbxTestNode& second = mesh.add("LayerElementUV", {int64_t{1}});
		second.add("Name", {std::string("second")});
		second.add("MappingInformationType", {std::string("ByVertice")});
		second.add("ReferenceInformationType", {std::string("Direct")});
		second.add("UV", {std::vector<double>{7, 7, 7, 8, 8, 8, 8, 7}});
		change(addMask(scene, 1));
		LoadedLevel loaded = loadScene(folder, scene);
		CHECK(findingsOf(loaded.diagnosis).empty());
		REQUIRE(loaded.level.masks.size() == 1);
		CHECK(loaded.level.material_list.front().alpha_mode == AlphaMode::mask);
		CHECK(loaded.level.material_list.front().coverage == 0.75);
		return loaded.level;
	};
	const glm::dvec3 u0v0(0.0, 0.0, 1.0);
	const glm::dvec3 u1v0(1.0, 0.0, 1.0);
	const glm::dvec3 u0v1(0.0, 0.0, 0.0);
	const glm::dvec3 u1v1(1.0, 0.0, 0.0);
	checkUv(load([](FbxTestNode&) {}), u1v1, {1.0, 1.0});

	const Level tiled = load(
		[](FbxTestNode& t) {
			t.set("Scaling", numbers({5.0, 3.0, 1.0})).set("Translation", numbers({0.25, 0.5, 0.0}));
		});
	checkUv(tiled, u0v0, {0.25, 0.5});
	checkUv(tiled, u1v1, {5.25, 3.5});
	const Level turned = load(
		[](FbxTestNode& t) {
			t.set("Rotation", numbers({0.0, 0.0, 90.0})).set("TextureRotationPivot", numbers({1.0, 0.0, 0.0}));
		});
	checkUv(turned, u0v0, {1.0, -1.0});
	checkUv(turned, u1v0, {1.0, 0.0});
	checkUv(turned, u1v1, {0.0, 0.0});
	const Level pivoted = load(
		[](FbxTestNode& t) {
			t.set("Scaling", numbers({2.0, 2.0, 1.0})).set("TextureScalingPivot", numbers({0.5, 0.5, 0.0}));
		});
	checkUv(pivoted, u0v0, {-0.5, -0.5});
	checkUv(load([](FbxTestNode& t) { t.set("UVSwap", {int64_t{1}}); }), u0v1, {1.0, 0.0});
	const Level old = load([](FbxTestNode& t) { t.add("ModelUVScaling", {4.0, 2.0}); });
	checkUv(old, u1v1, {4.0, 2.0});

	const Level second = load([](FbxTestNode& t) { t.set("UVSet", {std::string("second")}); });
	checkUv(second, u1v0, {8.0, 8.0});
	const Level unknown = load([](FbxTestNode& t) { t.set("UVSet", {std::string("none of them")}); });
	checkUv(unknown, u1v0, {1.0, 0.0});

	const Level wrapped = load([](FbxTestNode& t) { t.set("WrapModeU", {int64_t{1}}); });
	CHECK(wrapped.masks.front().wrap_u == Wrap::clamp);
	CHECK(wrapped.masks.front().wrap_v == Wrap::repeat);
}

TEST_CASE("scene: pictures inside FBX files are masks", "[scene]")
{
	const TemporaryFolder folder;
	const char* const property = GENERATE(as<const char*>{}, "TransparentColor", "TransparencyFactor", "3dsMax|main|opacity_map");
	FbxTestScene scene;
	scene.model(1, "node");
	addSheet(scene, 10, 1);
	addMask(scene, 1, property);
	FbxTestNode& content = scene.object("Video", 500, "picture", "Clip", 400).add("Content", {rowsPng()});
	CHECK(loadScene(folder, scene).level.material_list.front().coverage == 0.75);
	const std::string text = base64(rowsPng());
	for (const std::vector<FbxTestValue>& parts :
		 {std::vector<FbxTestValue>{base64(rowsPng().substr(0, 40)), base64(rowsPng().substr(40))}, // each padded separately
		  {text.substr(0, 37), text.substr(37)}})                                                   // split anywhere
	{
		content.values = parts;
		CHECK(loadText(folder / "b.fbx", scene.text()).level.material_list.front().coverage == 0.75);
	}
	content.values = {std::string("no base64!")};
	CHECK(refusalOf(folder, scene.text()) == "Texture 'mask': Content: found another text, expected base64");
}

TEST_CASE("scene: opacity of FBX materials", "[scene]")
{
	const TemporaryFolder folder;
	const auto alphaOf = [&](const std::vector<std::pair<std::string, Numbers>>& properties)
	{
		FbxTestScene scene;
		scene.model(1, "node");
		addSheet(scene, 10, 1);
		FbxTestNode& material = scene.object("Material", 300, "glass", "", 1);
		for (const auto& [name, values] : properties)
		{
			material.set(name, values);
		}
		const Material made = loadScene(folder, scene).level.material_list.front();
		CHECK(made.name == "glass");
		CHECK(made.alpha_mode == (made.alpha < 1.0 ? AlphaMode::blend : AlphaMode::opaque));
		return made.alpha;
	};
	CHECK(alphaOf({}) == 1.0);
	CHECK(alphaOf({{"Opacity", {0.25}}, {"TransparencyFactor", {1.0}}, {"TransparentColor", numbers({0, 0, 0})}}) == 0.25); // Maya
	CHECK(alphaOf({{"TransparencyFactor", {0.5}}, {"TransparentColor", numbers({0.5, 1.0, 0.0})}}) == 0.75); // colour × factor
	CHECK(alphaOf({{"TransparentColor", numbers({0.75, 0.75, 0.75})}}) == 0.25);
	CHECK(alphaOf({{"TransparencyFactor", {0.875}}}) == 0.125); // a factor alone
	CHECK(alphaOf({{"TransparencyFactor", {1.0}}}) == 1.0);     // the value that exporters write for opaque materials
	CHECK(alphaOf({{"TransparencyFactor", {0.0}}}) == 1.0);
}

TEST_CASE("scene: polygons of an FBX mesh have the node's materials", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	scene.model(1, "a");
	scene.model(2, "b").set("Lcl Translation", numbers({5.0, 0.0, 0.0}));
	FbxTestNode& box = scene.box(10, 1);
	scene.connect(10, 2); // the same mesh, with other materials
	FbxTestNode& layer = box.add("LayerElementMaterial", {int64_t{0}});
	layer.add("MappingInformationType", {std::string("ByPolygon")});
	layer.add("ReferenceInformationType", {std::string("IndexToDirect")});
	layer.add("Materials", {std::vector<int32_t>{1, 0, 0, 1, 7, -1}});
	for (int64_t id = 300; id < 303; ++id)
	{
		scene.object("Material", id, "m" + std::to_string(id), "");
	}
	scene.connect(300, 1);
	scene.connect(301, 1);
	scene.connect(302, 2);
	const Level level = loadScene(folder, scene).level;
	std::string found;
	for (const Mesh& mesh : level.meshes)
	{
		found += mesh.name + " " + std::to_string(mesh.triangle_count) + " " +
				 level.material_list[level.materials[mesh.first_triangle]].name + ", ";
	}
	// The second node has one material: faces of slots that do not exist, and faces without a slot, have no material.
	CHECK(found == "a/box 4 m301, a/box 4 m300, a/box 4 default, b/box 8 default, b/box 4 m302, ");
	CHECK(volumeOf(level) == Approx(16.0));
}

TEST_CASE("scene: layers of FBX lie at corners, points, polygons or all", "[scene]")
{
	const TemporaryFolder folder;
	const auto normalsOf =
		[&](const std::string& by, const std::string& reference, std::vector<double> values, std::vector<int32_t> indices)
	{
		FbxTestScene scene;
		scene.model(1, "node");
		FbxTestNode& layer = addSheet(scene, 10, 1).add("LayerElementNormal", {int64_t{0}});
		layer.add("MappingInformationType", {by});
		layer.add("ReferenceInformationType", {reference});
		layer.add("Normals", {std::move(values)});
		if (!indices.empty())
		{
			layer.add("NormalsIndex", {std::move(indices)});
		}
		const LoadedLevel loaded = loadScene(folder, scene);
		std::string found;
		for (const glm::vec3& n : loaded.level.normals)
		{
			found += n.x > 0.5F ? 'x' : n.y > 0.5F ? 'y' : n.z > 0.5F ? 'z' : '-';
		}
		return found + findingsOf(loaded.diagnosis);
	};
	const std::vector<double> xyz{1, 0, 0, 0, 1, 0, 0, 0, 1};
	const std::vector<double> four{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0};
	CHECK(normalsOf("ByPolygonVertex", "Direct", four, {}) == "xyzy");
	CHECK(normalsOf("ByPolygonVertex", "Direct", four, {3, 3, 3, 3}) == "xyzy"); // the index is unusable
	CHECK(normalsOf("ByPolygonVertex", "IndexToDirect", xyz, {2, 1, 0, 0}) == "zyxx");
	CHECK(normalsOf("ByVertice", "Direct", four, {}) == "xyzy");
	CHECK(normalsOf("ByVertex", "IndexToDirect", xyz, {2, 2, 1, 1}) == "zzyy");
	CHECK(normalsOf("ByPolygon", "Direct", xyz, {}) == "xxxx");
	CHECK(normalsOf("AllSame", "IndexToDirect", xyz, {2}) == "zzzz");
	CHECK(normalsOf("ByEdge", "Direct", four, {}) == "----");
	CHECK(normalsOf("ByPolygonVertex", "IndexToDirect", xyz, {0, -1, 9, 0}) == "x--xbad-normals 2 repaired");
}

TEST_CASE("scene: FBX nodes that mirror keep the front", "[scene]")
{
	const TemporaryFolder folder;
	const double mirror = GENERATE(1.0, -1.0);
	FbxTestScene scene;
	scene.model(1, "node").set("Lcl Scaling", numbers({2.0 * mirror, 1.0, 1.0}));
	scene.box(10, 1);
	CHECK(volumeOf(loadScene(folder, scene).level) == Approx(16.0));
}

TEST_CASE("scene: skins of FBX move points as their link mode says", "[scene]")
{
	const TemporaryFolder folder;
	const auto load = [&](const std::vector<double>& weights, const std::string& mode, Pose pose, const std::string& findings)
	{
		FbxTestScene scene;
		addSkin(scene, weights, mode, {0.0, 0.0, 90.0});
		LoadSettings settings;
		settings.pose = pose;
		const LoadedLevel loaded = loadScene(folder, scene, settings);
		CHECK(findingsOf(loaded.diagnosis) == findings);
		return stripOf(loaded.level);
	};
	// A quarter turn about (2, 0, 0): x becomes 2 - 0, y becomes x - 2. The last point has no weight and stays with its node.
	const auto turned = [](double x)
	{
		return glm::dvec3(2.0, x - 2.0, 0.0);
	};
	const auto rest = [](double x)
	{
		return glm::dvec3(x, 100.0, 0.0);
	};
	for (const char* const mode : {"", "Normalize", "Total1", "Additive"})
	{
		INFO(mode);
		const std::vector<glm::dvec3> whole = load({1.0, 1.0, 1.0}, mode, Pose::file, "posed-meshes 1 applied");
		for (std::size_t i = 0; i < 3; ++i)
		{
			checkNear(whole[i], turned(static_cast<double>(i)));
		}
		checkNear(whole[3], {0.0, 100.0, 1.0});
		const std::vector<glm::dvec3> half = load({0.5, 0.5, 0.25}, mode, Pose::file, "posed-meshes 1 applied");
		const double share = mode == std::string("") || mode == std::string("Normalize") ? 1.0 : 0.5;
		checkNear(half[0], share * turned(0.0) + (1.0 - share) * rest(0.0));
		checkNear(half[1], share * turned(1.0) + (1.0 - share) * rest(1.0));
		checkNear(half[2], share == 1.0 ? turned(2.0) : 0.25 * turned(2.0) + 0.75 * rest(2.0));
		const std::vector<glm::dvec3> still = load({1.0, 1.0, 1.0}, mode, Pose::rest, "not-applied 1 ignored");
		for (std::size_t i = 0; i < 3; ++i)
		{
			checkNear(still[i], rest(static_cast<double>(i)));
		}
	}
}

TEST_CASE("scene: a mesh of FBX that several bones hold", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	addSkin(scene, {0.0, 0.25, 0.5}, "", {0.0, 0.0, 0.0});
	scene.model(4, "other", 0, "LimbNode").set("Lcl Translation", numbers({0.0, 0.0, 40.0}));
	FbxTestNode& cluster = scene.object("Deformer", 62, "other", "Cluster", 60);
	scene.connect(4, 62);
	cluster.add("Indexes", {std::vector<int32_t>{1, 2}});
	cluster.add("Weights", {std::vector<double>{0.75, 0.5}});
	cluster.add("Transform", {std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}});
	const std::vector<glm::dvec3> strip = stripOf(loadScene(folder, scene).level);
	checkNear(strip[0], {0.0, 100.0, 0.0});
	checkNear(strip[1], {1.0, 0.0, 30.0});
	checkNear(strip[2], {2.0, 0.0, 20.0});
	// A cluster without a bone has no effect.
	scene.object("Deformer", 63, "none", "Cluster", 60).add("Indexes", {std::vector<int32_t>{0}});
	checkNear(stripOf(loadScene(folder, scene).level)[0], {0.0, 100.0, 0.0});
}

TEST_CASE("scene: skins of FBX by dual quaternions keep the distance from the bone", "[scene]")
{
	const TemporaryFolder folder;
	// Half of a bone at rest, half of one rotated by 90 degrees about x and scaled by two.
	for (const auto& [type, expected, share] :
		 {std::tuple{"Linear", glm::dvec3(0.0, 0.5, 1.0), 0.0},
		  {"DualQuaternion", glm::dvec3(0.0, std::sqrt(0.5), std::sqrt(0.5)) * 1.5, 0.0},
		  {"Blend", glm::dvec3(0.0, 0.25, 0.5) + glm::dvec3(0.0, std::sqrt(0.5), std::sqrt(0.5)) * 0.75, 0.5}})
	{
		INFO(type);
		FbxTestScene scene;
		scene.model(1, "body");
		scene.mesh(10, "body", {0, 1, 0, 7, 0, 0, 0, 0, 7}, kTriangle, 1);
		FbxTestNode& skin = scene.object("Deformer", 60, "skin", "Skin");
		skin.add("SkinningType", {std::string(type)});
		skin.add("Indexes", {std::vector<int32_t>{0}});
		skin.add("BlendWeights", {std::vector<double>{share}});
		scene.connect(60, 10);
		for (int64_t i = 0; i < 2; ++i)
		{
			const double bone = static_cast<double>(i);
			FbxTestNode& node = scene.model(2 + i, "bone", 0, "LimbNode");
			node.set("Lcl Rotation", numbers({90.0 * bone, 0.0, 0.0}));
			node.set("Lcl Scaling", numbers({1.0 + bone, 1.0 + bone, 1.0 + bone}));
			FbxTestNode& cluster = scene.object("Deformer", 61 + i, "cluster", "Cluster", 60);
			scene.connect(2 + i, 61 + i);
			cluster.add("Indexes", {std::vector<int32_t>{0}});
			cluster.add("Weights", {std::vector<double>{0.5}});
			cluster.add("Transform", {std::vector<double>{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}});
		}
		checkNear(loadScene(folder, scene).level.positions.at(0), expected);
	}
}

TEST_CASE("scene: blend shapes of FBX have the weights that the file gives", "[scene]")
{
	const TemporaryFolder folder;
	// One point that moves along y by 1 at 50 % and along z by 4 at 100 %.
	const auto moveOf = [&](double percent, Pose pose = Pose::file)
	{
		FbxTestScene scene;
		scene.model(1, "node");
		scene.mesh(10, "one", {0, 0, 0, 1, 0, 0, 0, 1, 0}, kTriangle, 1);
		scene.object("Deformer", 70, "shapes", "BlendShape", 10);
		FbxTestNode& channel = scene.object("Deformer", 71, "channel", "BlendShapeChannel", 70);
		channel.add("DeformPercent", {percent});
		channel.add("FullWeights", {std::vector<double>{50.0, 100.0}});
		for (int64_t i = 0; i < 2; ++i)
		{
			FbxTestNode& shape = scene.object("Geometry", 80 + i, "shape", "Shape");
			shape.add("Indexes", {std::vector<int32_t>{2}});
			shape.add("Vertices", {i == 0 ? std::vector<double>{0, 1, 0} : std::vector<double>{0, 0, 4}});
			scene.connect(80 + i, 71);
		}
		LoadSettings settings;
		settings.pose = pose;
		const LoadedLevel loaded = loadScene(folder, scene, settings);
		CHECK(findingsOf(loaded.diagnosis) == (percent == 0.0       ? ""
											   : pose == Pose::file ? "posed-meshes 1 applied"
																	: "not-applied 1 ignored"));
		return loaded.level.positions.at(2) - glm::dvec3(0.0, 1.0, 0.0);
	};
	checkNear(moveOf(0.0), {0.0, 0.0, 0.0});
	checkNear(moveOf(25.0), {0.0, 0.5, 0.0});
	checkNear(moveOf(50.0), {0.0, 1.0, 0.0});
	checkNear(moveOf(75.0), {0.0, 0.5, 2.0});
	checkNear(moveOf(100.0), {0.0, 0.0, 4.0});
	checkNear(moveOf(125.0), {0.0, -0.5, 6.0}); // extrapolated along the same line
	checkNear(moveOf(100.0, Pose::rest), {0.0, 0.0, 0.0});
}

TEST_CASE("scene: normals of posed FBX meshes turn with them", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	addSkin(scene, {1.0, 1.0, 1.0}, "", {90.0, 0.0, 0.0});
	for (FbxTestNode& object : scene.root.child("Objects").children)
	{
		if (object.name == "Geometry")
		{
			FbxTestNode& layer = object.add("LayerElementNormal", {int64_t{0}});
			layer.add("MappingInformationType", {std::string("AllSame")});
			layer.add("ReferenceInformationType", {std::string("Direct")});
			layer.add("Normals", {std::vector<double>{0, 1, 0}});
		}
	}
	const Level level = loadScene(folder, scene).level;
	checkNear(glm::dvec3(level.normals.at(1)), {0.0, 0.0, 1.0}, 1e-6);
	checkNear(glm::dvec3(level.normals.at(0)), {0.0, 1.0, 0.0}, 1e-6); // no weight
}

TEST_CASE("scene: FBX cameras stand and look as the file says", "[scene]")
{
	const TemporaryFolder folder;
	const auto lensOf = [&](const std::vector<std::pair<std::string, FbxTestValue>>& properties)
	{
		FbxTestScene scene;
		scene.model(1, "node");
		scene.box(10, 1);
		scene.model(2, "camera", 0, "Camera").set("Lcl Translation", numbers({1.0, 2.0, 3.0}));
		FbxTestNode& attribute = scene.object("NodeAttribute", 20, "camera", "Camera", 2);
		attribute.set("AspectWidth", {320.0}).set("AspectHeight", {160.0}).set("NearPlane", {0.5}).set("FarPlane", {50.0});
		for (const auto& [name, value] : properties)
		{
			attribute.set(name, {value});
		}
		const Level level = loadScene(folder, scene).level;
		REQUIRE(level.cameras.size() == 1);
		const LevelCamera& camera = level.cameras.front();
		CHECK(camera.name == "camera");
		checkNear(glm::dvec3(camera.world_from_camera[3]), {1.0, 2.0, 3.0});
		checkNear(-glm::dvec3(camera.world_from_camera[2]), {1.0, 0.0, 0.0}); // along x
		checkNear(glm::dvec3(camera.world_from_camera[1]), {0.0, 1.0, 0.0});
		CHECK(camera.lens.near_m == 0.5);
		CHECK(camera.lens.far_m == 50.0);
		return camera.lens.fov_y_rad;
	};
	const double half_of_right_angle = 2.0 * std::atan(0.5); // twice as wide as high
	CHECK(lensOf({{"FieldOfView", 90.0}}) == Approx(half_of_right_angle));
	CHECK(lensOf({{"FieldOfView", 90.0}, {"ApertureMode", int64_t{2}}}) == Approx(kPi / 2.0));
	CHECK(lensOf({{"FieldOfViewX", 90.0}, {"FieldOfViewY", 60.0}, {"ApertureMode", int64_t{0}}}) == Approx(kPi / 3.0));
	// The film is an inch wide.
	CHECK(lensOf({{"FilmWidth", 1.0}, {"FocalLength", 12.7}, {"FieldOfView", 1.0}, {"ApertureMode", int64_t{3}}}) ==
		  Approx(half_of_right_angle));
	CHECK(lensOf({{"FilmWidth", 1.0}, {"FocalLength", 12.7}}) == Approx(half_of_right_angle));
}

TEST_CASE("scene: every truncation of a binary FBX file is refused", "[scene]")
{
	const TemporaryFolder folder;
	FbxTestScene scene;
	addSkin(scene, {1.0, 1.0, 1.0}, "", {0.0, 0.0, 90.0});
	for (const FbxForm& form : {FbxForm{7400, false}, FbxForm{7500, true}})
	{
		const std::string whole = scene.bytes(form);
		for (std::size_t size = 0; size < whole.size(); size += 7)
		{
			INFO(size);
			CHECK(refusalOf(folder, whole.substr(0, size)).find(": found ") != std::string::npos);
		}
		CHECK(refusalOf(folder, whole.substr(0, whole.size() - 1)).find("expected ") != std::string::npos);
	}
}

TEST_CASE("scene: what an FBX file claims is checked", "[scene]")
{
	const TemporaryFolder folder;
	const auto bytesOf = [](const std::function<void(FbxTestScene&)>& change, const FbxForm& form = {})
	{
		FbxTestScene scene;
		scene.model(1, "node");
		change(scene);
		return scene.bytes(form);
	};
	const auto boxed = [](FbxTestScene& scene)
	{
		scene.box(10, 1);
	};
	const std::string box = bytesOf(boxed);
	// Older, newer and invalid versions.
	for (const uint32_t version : {6100U, 7099U, 8000U, 0xFFFFFFFFU})
	{
		CHECK(refusalOf(folder, bytesOf(boxed, {version}), ExitCode::unsupported).find("expected 7.1 to 7.7") != std::string::npos);
	}
	CHECK(refusalOf(folder, "; FBX 6.1.0 project file\nFBXHeaderExtension:  {\n\tFBXVersion: 6100\n}\n", ExitCode::unsupported)
			  .starts_with("found FBX 6.1, expected"));
	CHECK(refusalOf(folder, "Objects:  {\n}\n").starts_with("FBXHeaderExtension.FBXVersion: found nothing"));

	// Counts and sizes that exceed the file.
	for (const uint32_t claim : {0xFFFFFFFFU, 0x7FFFFFFFU, 1000U})
	{
		std::string bytes = box;
		const std::size_t array = bytes.find("Vertices") + 8; // d, count, encoding, size
		REQUIRE(bytes[array] == 'd');
		std::string number;
		append(number, claim);
		bytes.replace(array + 1, 4, number);
		CHECK(refusalOf(folder, bytes).find("bytes (an array)") != std::string::npos);
		bytes = bytesOf(boxed, {7400, true});
		const std::size_t packed = bytes.find("Vertices") + 8;
		bytes.replace(packed + 1, 4, number);
		const std::string found = refusalOf(folder, bytes);
		INFO(found);
		CHECK((found.find("as many as zlib can pack") != std::string::npos ||
			   found.find("that zlib cannot unpack") != std::string::npos));
	}
	std::string broken = bytesOf(boxed, {7400, true});
	broken[broken.find("Vertices") + 25] ^= '\x55';
	CHECK(refusalOf(folder, broken).starts_with("Geometry 'box': Vertices: found an array that zlib cannot unpack"));
	broken = box;
	broken[broken.find("Vertices") + 8] = 'x';
	CHECK(refusalOf(folder, broken).find("found a value of type 120") != std::string::npos);

	// Endlessly nested nodes.
	FbxTestScene deep;
	FbxTestNode* node = &deep.root;
	for (int i = 0; i < 200; ++i)
	{
		node = &node->add("N");
	}
	node->add("N");
	CHECK(refusalOf(folder, deep.bytes()).find("more than 64 nodes within one another") != std::string::npos);
	CHECK(refusalOf(folder, deep.text()).find("more than 64 nodes within one another") != std::string::npos);

	CHECK(refusalOf(folder, bytesOf(
								[](FbxTestScene& scene) {
									scene.mesh(10, "one", {0, 0, 0, 1}, {0, 1, -3}, 1);
								})) == "Geometry 'one': Vertices: found 4 numbers, expected three for each point");
	CHECK(refusalOf(folder, bytesOf(
								[](FbxTestScene& scene)
								{
									scene.model(2, "a", 3);
									scene.model(3, "b", 2);
									scene.box(10, 1);
								})) == "Connections: found a circle of nodes, expected a tree");
	FbxTestScene text;
	text.model(1, "node");
	text.box(10, 1);
	std::string word = text.text();
	word.replace(word.find("a: -1"), 5, "a: -x");
	CHECK(refusalOf(folder, word) == "Geometry 'box': Vertices: found '-x', expected numbers");
	word = text.text();
	word.replace(word.find("*24"), 3, "*99");
	CHECK(refusalOf(folder, word) == "Geometry 'box': Vertices: found 24 numbers, expected 99");

	for (const auto& [indices, weights, expected] :
		 {std::tuple{std::vector<int32_t>{0, 9}, std::vector<double>{1, 1}, "Indexes: found 9, expected one of 4 points"},
		  {std::vector<int32_t>{0, -1}, std::vector<double>{1, 1}, "Indexes: found -1, expected one of 4 points"},
		  {std::vector<int32_t>{0, 1}, std::vector<double>{1}, "Weights: found 1 numbers, expected 2"}})
	{
		FbxTestScene skinned;
		addSkin(skinned, {1.0, 1.0, 1.0}, "", glm::dvec3(0.0));
		for (FbxTestNode& object : skinned.root.child("Objects").children)
		{
			if (object.values[2] == FbxTestValue(std::string("Cluster")))
			{
				object.child("Indexes").values = {indices};
				object.child("Weights").values = {weights};
			}
		}
		CHECK(refusalOf(folder, skinned.bytes()).find(expected) != std::string::npos);
	}
}

TEST_CASE("scene: odd numbers of an FBX file are dropped with their triangles", "[scene]")
{
	const TemporaryFolder folder;
	const double nan = std::numeric_limits<double>::quiet_NaN();
	const auto load = [&](const std::function<void(FbxTestScene&, FbxTestNode&)>& change)
	{
		FbxTestScene scene;
		change(scene, scene.model(1, "odd"));
		scene.box(10, 1);
		scene.model(2, "node").set("Lcl Translation", numbers({9.0, 0.0, 0.0}));
		scene.box(11, 2);
		const LoadedLevel loaded = loadScene(folder, scene);
		return std::to_string(loaded.level.triangles.size()) + " " + findingsOf(loaded.diagnosis);
	};
	for (const char* const property : {"Lcl Translation", "Lcl Rotation", "Lcl Scaling", "PreRotation", "GeometricTranslation"})
	{
		for (const double value : {nan, std::numeric_limits<double>::infinity(), 1e300})
		{
			INFO(property << " " << value);
			const std::string found = load(
				[&](FbxTestScene&, FbxTestNode& node) {
					node.set(property, numbers({value, 0.0, 1.0}));
				});
			CHECK((found.starts_with("12 ") || found.starts_with("24 ")));
		}
	}
	CHECK(load(
			  [&](FbxTestScene& scene, FbxTestNode&) {
				  scene.mesh(12, "bad", {nan, 0, 0, 1, 0, 0, 0, 1, 0}, kTriangle, 1);
			  }) == "24 non-finite-vertices 1 dropped, empty-meshes 1 dropped");
	CHECK(load(
			  [&](FbxTestScene& scene, FbxTestNode&) {
				  scene.mesh(12, "bad", {0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2, 0, 1, -10}, 1);
			  })
			  .starts_with("24 index-out-of-range 1 dropped"));
	CHECK(load(
			  [&](FbxTestScene& scene, FbxTestNode&) {
				  scene.mesh(12, "line", {0, 0, 0, 1, 0, 0}, {0, -2}, 1);
			  }) == "24 points-or-lines 1 dropped, empty-meshes 1 dropped");
}
