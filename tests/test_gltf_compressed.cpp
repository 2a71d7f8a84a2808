// SPDX-License-Identifier: GPL-3.0-or-later
// glTF extensions that change how triangles and masks are stored.
#include "cube_gltf.h"
#include "testing.h"

#include "core/image_codec.h"
#include "format/arrays.h"

#if NOOK_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif
#include <meshoptimizer.h>

using namespace nook;

namespace
{

// Adds EXT_mesh_gpu_instancing to the cube's node; returns its attributes.
nlohmann::json& instanced(Cube& cube, const std::vector<float>& translations)
{
	nlohmann::json& attributes = cube.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
	attributes["TRANSLATION"] = cube.accessor(cube.view(packed(translations)), 5126, translations.size() / 3, "VEC3");
	return attributes;
}

// Compresses view `view` of the cube with EXT_meshopt_compression into buffer 0; decoded it would be in buffer 1.
void compress(Cube& cube, std::size_t view, const std::string& mode, std::size_t count, std::size_t stride,
			  const std::vector<unsigned char>& coded)
{
	nlohmann::json& item = cube.json["bufferViews"][view];
	item["extensions"]["EXT_meshopt_compression"] = {
		{"buffer", 0}, {"byteOffset", cube.buffer.size()}, {"byteLength", coded.size()}, {"byteStride", stride}, {"count", count},
		{"mode", mode}};
	item["buffer"] = 1;
	item["byteOffset"] = 256 * view;
	cube.buffer.append(coded.begin(), coded.end());
	cube.json["buffers"][1] = {{"byteLength", 1024}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}};
}

// Positions and indices; the texture coordinates stay uncompressed.
Cube meshoptCube()
{
	Cube cube;
	const std::string raw = cubeBuffer();
	std::vector<unsigned char> positions(meshopt_encodeVertexBufferBound(8, 12));
	positions.resize(meshopt_encodeVertexBuffer(positions.data(), positions.size(), raw.data(), 8, 12));
	std::vector<unsigned> wide;
	for (const auto& triangle : cubeTriangles())
	{
		wide.insert(wide.end(), triangle.begin(), triangle.end());
	}
	std::vector<unsigned char> indices(meshopt_encodeIndexBufferBound(36, 8));
	indices.resize(meshopt_encodeIndexBuffer(indices.data(), indices.size(), wide.data(), 36));
	compress(cube, 0, "ATTRIBUTES", 8, 12, positions);
	compress(cube, 2, "TRIANGLES", 36, 2, indices);
	cube.json["extensionsRequired"] = {"EXT_meshopt_compression"};
	return cube;
}

#if NOOK_HAS_DRACO
Cube dracoCube()
{
	draco::TriangleSoupMeshBuilder builder;
	const std::vector<std::array<unsigned, 3>> triangles = cubeTriangles();
	builder.Start(static_cast<int>(triangles.size()));
	const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
	const int uvs = builder.AddAttribute(draco::GeometryAttribute::TEX_COORD, 2, draco::DT_FLOAT32);
	for (uint32_t i = 0; i < triangles.size(); ++i)
	{
		const std::array<glm::vec3, 3> p{cubeCorner(triangles[i][0]), cubeCorner(triangles[i][1]), cubeCorner(triangles[i][2])};
		builder.SetAttributeValuesForFace(positions, draco::FaceIndex(i), &p[0], &p[1], &p[2]);
		builder.SetAttributeValuesForFace(uvs, draco::FaceIndex(i), &p[0], &p[1], &p[2]);
	}
	const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
	draco::Encoder encoder;
	encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 14);
	draco::EncoderBuffer coded;
	REQUIRE(encoder.EncodeMeshToBuffer(*mesh, &coded).ok());
	Cube cube;
	for (std::size_t i = 0; i < 3; ++i)
	{
		cube.json["accessors"][i].erase("bufferView");
	}
	cube.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
	cube.primitive()["extensions"]["KHR_draco_mesh_compression"] = {
		{"bufferView", cube.view(std::string(coded.data(), coded.size()))},
		{"attributes", {{"POSITION", mesh->attribute(positions)->unique_id()}, {"TEXCOORD_0", mesh->attribute(uvs)->unique_id()}}}};
	return cube;
}
#endif

// Truncates and changes a cube's compressed bytes: the result must be the cube, or one line of error.
void damage(const Cube& cube, std::size_t first, std::size_t step)
{
	std::size_t refused = 0;
	std::size_t tried = 0;
	for (std::size_t at = first; at < cube.buffer.size(); at += step)
	{
		for (const unsigned bits : {0xFFU, 0x11U})
		{
			Cube changed = cube;
			changed.buffer[at] = static_cast<char>(static_cast<unsigned char>(changed.buffer[at]) ^ bits);
			const std::string refusal = changed.refusal();
			CHECK((refusal == "none" || refusal[0] == '3'));
			CHECK(refusal.find('\n') == std::string::npos);
			refused += refusal == "none" ? 0U : 1U;
			tried += 1;
		}
	}
	CHECK(tried > 10);
	CHECK(refused > 0);
}

std::string rowsKtx2(Ktx2Texel texel)
{
	Ktx2Texture texture;
	texture.texel = texel;
	texture.width = 8;
	texture.height = 8;
	for (unsigned i = 0; i < 64; ++i)
	{
		texture.bytes += std::string("abc") + (i < 16 ? '\0' : '\xFF');
	}
	if (texel == Ktx2Texel::rgba32_float)
	{
		texture.bytes.resize(1024);
	}
	return ktx2Bytes(texture);
}

Cube maskedCube(const std::string& picture)
{
	Cube cube;
	cube.json["images"] = {{{"bufferView", cube.view(picture)}, {"mimeType", "image/ktx2"}}};
	cube.json["textures"] = {{{"extensions", {{"KHR_texture_basisu", {{"source", 0}}}}}}};
	cube.json["materials"] = {{{"alphaMode", "MASK"}, {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
	cube.json["extensionsRequired"] = {"KHR_texture_basisu"};
	cube.primitive()["material"] = 0;
	return cube;
}

} // namespace

TEST_CASE("scene: EXT_mesh_gpu_instancing places a mesh as nodes would", "[scene]")
{
	Cube cube;
	nlohmann::json& attributes = instanced(cube, {0.0F, 0.0F, 0.0F, 5.0F, 0.0F, 0.0F, 0.0F, 10.0F, 0.0F});
	cube.json["nodes"][0]["translation"] = {0, 0, 100};
	LoadedLevel loaded = cube.load();
	CHECK(findingsOf(loaded.diagnosis).empty());
	REQUIRE(loaded.level.triangles.size() == 36);
	REQUIRE(loaded.level.meshes.size() == 3);
	CHECK(loaded.level.meshes[2].name == "box 2/cube");
	CHECK(volumeOf(loaded.level) == Approx(3.0));
	CHECK(boundsOf(loaded.level).least == glm::dvec3(0.0, 0.0, 100.0));
	CHECK(boundsOf(loaded.level).most == glm::dvec3(6.0, 11.0, 101.0));

	// A quarter turn about y and a reflection, with integers: x' = z, z' = −x.
	attributes["ROTATION"] =
		cube.accessor(cube.view(packed(std::vector<int8_t>{0, 0, 0, 127, 0, 90, 0, 90, 0, 0, 0, 127})), 5120, 3, "VEC4");
	cube.json["accessors"].back()["normalized"] = true;
	attributes["SCALE"] = cube.accessor(cube.view(packed(std::vector<float>{1, 1, 1, 2, 1, 1, -1, 1, 1})), 5126, 3, "VEC3");
	loaded = cube.load();
	CHECK(volumeOf(loaded.level) == Approx(4.0)); // the winding is reversed for the reflection
	CHECK(boundsOf(loaded.level).least.z == Approx(98.0));
	CHECK(boundsOf(loaded.level).least.x == Approx(-1.0));

	attributes["SCALE"] = attributes["ROTATION"];
	CHECK(cube.refusal().starts_with(
		"3: nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.SCALE: found an accessor of type VEC4"));
	attributes["SCALE"] = cube.accessor(cube.view(packed(std::vector<float>{1, 1, 1})), 5126, 1, "VEC3");
	CHECK(cube.refusal().starts_with(
		"3: nodes[0].extensions.EXT_mesh_gpu_instancing.attributes.SCALE: found 1 instances, expected 3"));
	attributes.erase("SCALE");
	cube.json["accessors"].push_back({{"componentType", 5126}, {"count", 5000000}, {"type", "VEC3"}});
	attributes["TRANSLATION"] = cube.json["accessors"].size() - 1;
	CHECK(cube.refusal().find("found an accessor that no buffer holds") != std::string::npos);
	cube.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = nlohmann::json::object();
	CHECK(cube.refusal().starts_with("3: nodes[0].extensions.EXT_mesh_gpu_instancing"));
}

TEST_CASE("scene: EXT_meshopt_compression is decoded; what it claims is checked first", "[scene]")
{
	const Cube cube = meshoptCube();
	const LoadedLevel loaded = cube.load();
	CHECK(findingsOf(loaded.diagnosis).empty());
	CHECK(loaded.level.triangles.size() == 12);
	CHECK(volumeOf(loaded.level) == Approx(1.0));
	for (std::size_t i = 0; i < loaded.level.positions.size(); ++i)
	{
		CHECK(glm::vec2(loaded.level.positions[i]) == loaded.level.uvs[i]); // stored uncompressed
	}

	Cube other = cube;
	nlohmann::json& extension = other.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
	const auto refused = [&](const char* field, const nlohmann::json& value)
	{
		const nlohmann::json before = extension[field];
		extension[field] = value;
		const std::string refusal = other.refusal();
		extension[field] = before;
		if (before.is_null())
		{
			extension.erase(field);
		}
		return refusal;
	};
	const std::string where = "3: bufferViews[0].extensions.EXT_meshopt_compression";
	CHECK(refused("count", 100000000).starts_with(where + ".count: found 100000000 of 12 bytes, made of"));
	CHECK(refused("count", 900).starts_with(where + ": found bytes that do not decode"));
	CHECK(refused("byteStride", 13).starts_with(where + ": found 8 elements, 13 bytes apart"));
	CHECK(refused("byteStride", 0).starts_with(where));
	CHECK(refused("mode", "OTHER").starts_with(where + ".mode: found \"OTHER\""));
	CHECK(refused("filter", "QUATERNION").starts_with(where));
	CHECK(refused("buffer", 1).starts_with(where + ".byteLength"));
	CHECK(refused("byteLength", 1U << 31U).starts_with(where + ".byteLength"));
	CHECK(refused("byteLength", 5).starts_with(where));
	other.json["bufferViews"][0].erase("extensions");
	CHECK(other.refusal().starts_with("3: bufferViews[0].buffer: found one that EXT_meshopt_compression decodes into"));
	damage(cube, 232, 7);
}

TEST_CASE("scene: KHR_draco_mesh_compression is decoded, or said to be missing here", "[scene]")
{
	Cube beside;
	beside.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
	CHECK(beside.load().level.triangles.size() == 12); // the uncompressed fallback is read
#if NOOK_HAS_DRACO
	const Cube cube = dracoCube();
	const LoadedLevel loaded = cube.load();
	CHECK(findingsOf(loaded.diagnosis).empty());
	CHECK(loaded.level.triangles.size() == 12);
	CHECK(volumeOf(loaded.level) == Approx(1.0).epsilon(1e-3));
	for (std::size_t i = 0; i < loaded.level.positions.size(); ++i)
	{
		CHECK(glm::distance(loaded.level.positions[i], glm::dvec3(loaded.level.uvs[i], loaded.level.positions[i].z)) < 1e-3);
	}

	// Two primitives with the same data.
	Cube twice = cube;
	twice.json["meshes"].push_back(twice.json["meshes"][0]);
	twice.json["nodes"].push_back({{"mesh", 1}, {"translation", {3, 0, 0}}});
	twice.json["scenes"][0]["nodes"] = {0, 1};
	CHECK(volumeOf(twice.load().level) == Approx(2.0).epsilon(1e-3));
	twice.json["accessors"].push_back(twice.json["accessors"][0]);
	twice.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"] = 3;
	CHECK(twice.refusal().find("with other accessors, expected the same") != std::string::npos);

	Cube other = cube;
	other.primitive()["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] = 7;
	CHECK(other.refusal() ==
		  "3: meshes[0].primitives[0]: KHR_draco_mesh_compression: found no attribute 7, expected those that the "
		  "primitive names");
	other = cube;
	other.json["accessors"][0]["type"] = "VEC4";
	CHECK(other.refusal().find("found 3 components of attribute 0, expected 4") != std::string::npos);
	other = cube;
	other.primitive()["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = 0;
	CHECK(other.refusal().find("expected a mesh that Draco decodes") != std::string::npos);
	damage(cube, 232, 9);
#else
	Cube cube;
	cube.primitive()["extensions"]["KHR_draco_mesh_compression"] = {{"bufferView", 0}};
	cube.json["accessors"][0].erase("bufferView");
	CHECK(cube.refusal().starts_with("5: meshes[0].primitives[0]: found KHR_draco_mesh_compression, which this build"));
#endif
}

TEST_CASE("scene: a mask in a KTX2 file of plain texels is read; others name the tool that makes them plain", "[scene]")
{
	const std::string picture = rowsKtx2(Ktx2Texel::rgba8_unorm);
	const LoadedLevel loaded = maskedCube(picture).load();
	REQUIRE(loaded.level.masks.size() == 1);
	CHECK(loaded.level.masks[0].width_px == 8);
	CHECK(loaded.level.masks[0].alpha[15] == 0);
	CHECK(loaded.level.masks[0].alpha[16] == 255);
	CHECK(loaded.level.material_list[0].mean_alpha == 0.75);

	CHECK(maskedCube(rowsKtx2(Ktx2Texel::rgba32_float)).refusal() ==
		  "5: image 0: KTX2: found texels of Vulkan's format 109, expected uncompressed ones, as `ktx transcode --target rgba8 "
		  "IN.ktx2 "
		  "OUT.ktx2` makes them");
	std::string basis = picture;
	basis[12] = '\0';
	CHECK(maskedCube(basis).refusal().find("found texels of UASTC or another codec, expected uncompressed") != std::string::npos);
	basis[44] = '\1';
	CHECK(maskedCube(basis).refusal().starts_with("5: image 0: KTX2: found texels compressed by BasisLZ"));

	// Every field of the header and the level, and every truncation: a picture of that many texels, or a one-line error.
	EncodedAlpha as;
	as.name = "a.ktx2";
	as.channel = MaskChannel::alpha;
	std::size_t refused = 0;
	for (std::size_t at = 12; at < 104; ++at)
	{
		for (const char value : {'\0', '\1', '\x7F', '\xFF'})
		{
			std::string changed = picture;
			changed[at] = value;
			try
			{
				const AlphaImage image = *alphaOfKtx2(changed, as, 4096).image;
				CHECK(image.alpha.size() == static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px));
			}
			catch (const Error& error)
			{
				CHECK((error.code() == ExitCode::invalid_input || error.code() == ExitCode::unsupported));
				refused += 1;
			}
		}
	}
	CHECK(refused > 100);
	for (std::size_t size = 12; size < picture.size(); ++size)
	{
		CHECK_THROWS_AS(alphaOfKtx2(std::string_view(picture).substr(0, size), as, 4096), Error);
	}
	CHECK_THROWS_WITH(alphaOfKtx2(picture, as, 63), "a.ktx2: found 8x8 texels, expected at most 63 (max-texels)");
}
