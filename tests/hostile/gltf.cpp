// SPDX-License-Identifier: GPL-3.0-or-later
// glTF and GLB: every field at its limits, every type exchanged, truncations, cycles, wrong lengths, decompression bombs.
#include "corpus.h"

#include "../hostile_pictures.h"
#include "../level_files.h"
#include "core/json_text.h"

namespace nook::hostile
{
namespace
{

using nlohmann::json;

std::string dataUri(const std::string& type, const std::string& bytes)
{
	return "data:" + type + ";base64," + base64(bytes);
}

std::vector<std::pair<std::string, std::string>> asFile(const json& document)
{
	return {{"a.gltf", jsonLine(document)}};
}

json withBuffer(json document)
{
	document["buffers"][0]["uri"] = dataUri("application/octet-stream", cubeBuffer());
	return document;
}

// Features that the plain cube lacks: transforms, a camera, byteStride, sparse values, normals of other types. Masks are below,
// since each starts a decoder.
json manyFields()
{
	json document = withBuffer(cubeGltf());
	document["nodes"][0]["translation"] = {1, 2, 3};
	document["nodes"][0]["rotation"] = {0, 0, 0, 1};
	document["nodes"][0]["scale"] = {1, 1, 1};
	document["nodes"][0]["children"] = {1};
	document["nodes"].push_back({{"camera", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}});
	document["cameras"] = {
		{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}, {"zfar", 10}, {"aspectRatio", 1}}}}};
	document["meshes"][0]["primitives"][0]["material"] = 0;
	document["meshes"][0]["primitives"][0]["mode"] = 4;
	document["materials"] = {{{"name", "grey"},
							  {"doubleSided", true},
							  {"alphaMode", "BLEND"},
							  {"alphaCutoff", 0.5},
							  {"pbrMetallicRoughness", {{"baseColorFactor", {1, 1, 1, 0.5}}}}}};
	document["bufferViews"][0]["byteStride"] = 12;
	document["accessors"][0]["byteOffset"] = 0;
	document["accessors"][0]["normalized"] = false;
	document["accessors"][0]["sparse"] = {{"count", 1},
										  {"indices", {{"bufferView", 2}, {"byteOffset", 2}, {"componentType", 5123}}},
										  {"values", {{"bufferView", 0}, {"byteOffset", 0}}}};
	document["extensionsUsed"] = {"KHR_materials_unlit"};
	return document;
}

// The cube with a skin of two joints, a morph target and vertex alphas.
json posedFields()
{
	json document = withBuffer(cubeGltf());
	std::string buffer = cubeBuffer();
	const std::size_t first = buffer.size();
	for (int i = 0; i < 8; ++i)
	{
		buffer += std::string("\1\0\0\0", 4) + std::string("\xFF\0\0\0", 4) + std::string("\1\2\3\x80", 4);
	}
	for (const float value : {1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F, 0.0F, 0.0F, 0.0F, 0.0F, 1.0F})
	{
		append(buffer, value);
	}
	document["buffers"][0] = {{"byteLength", buffer.size()}, {"uri", dataUri("application/octet-stream", buffer)}};
	json& views = document["bufferViews"];
	views.push_back({{"buffer", 0}, {"byteOffset", first}, {"byteLength", 96}, {"byteStride", 12}});
	views.push_back({{"buffer", 0}, {"byteOffset", first + 96}, {"byteLength", 64}});
	json& attributes = document["meshes"][0]["primitives"][0]["attributes"];
	for (const auto& [name, offset] : {std::pair{"JOINTS_0", 0}, {"WEIGHTS_0", 4}, {"COLOR_0", 8}})
	{
		attributes[name] = document["accessors"].size();
		document["accessors"].push_back({{"bufferView", 3},
										 {"byteOffset", offset},
										 {"componentType", 5121},
										 {"normalized", offset > 0},
										 {"count", 8},
										 {"type", "VEC4"}});
	}
	document["accessors"].push_back({{"bufferView", 4}, {"componentType", 5126}, {"count", 1}, {"type", "MAT4"}});
	document["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}, {"NORMAL", 0}}};
	document["meshes"][0]["primitives"][0]["material"] = 0;
	document["meshes"][0]["weights"] = {0.5};
	document["materials"] = {{{"alphaMode", "MASK"},
							  {"extensions",
							   {{"KHR_materials_transmission", {{"transmissionFactor", 1}}},
								{"KHR_materials_pbrSpecularGlossiness", {{"diffuseFactor", {1, 1, 1, 1}}}}}}}};
	document["skins"] = {{{"joints", {1, 2}}}, {{"joints", {1}}, {"inverseBindMatrices", 6}}};
	document["nodes"][0]["skin"] = 0;
	document["nodes"].push_back({{"children", {2}}, {"extensions", {{"KHR_node_visibility", {{"visible", true}}}}}});
	document["nodes"].push_back({{"mesh", 0}, {"weights", {-1}}});
	document["scenes"][0]["nodes"] = {0, 1};
	return document;
}

json masked(const std::string& picture)
{
	json document = withBuffer(cubeGltf());
	document["images"] = {{{"uri", dataUri("image/png", picture)}}};
	document["samplers"] = {{{"wrapS", 10497}, {"wrapT", 33071}, {"magFilter", 9729}, {"minFilter", 9987}}};
	document["textures"] = {{{"source", 0}, {"sampler", 0}}};
	document["materials"] = {
		{{"alphaMode", "MASK"},
		 {"pbrMetallicRoughness",
		  {{"baseColorTexture",
			{{"index", 0},
			 {"texCoord", 0},
			 {"extensions", {{"KHR_texture_transform", {{"offset", {0, 0}}, {"rotation", 0}, {"scale", {1, 1}}}}}}}}}}}};
	document["meshes"][0]["primitives"][0]["material"] = 0;
	return document;
}

void addGlb(Cases& cases)
{
	const std::string whole = glbBytes(cubeGltf(), cubeBuffer());
	addCuts(cases, "glb/cuts", "3", "a.glb", whole);
	const std::size_t text = whole.size() - 28 - 232;
	// Both numbers of the header and of each chunk.
	for (const std::size_t at :
		 {std::size_t{0}, std::size_t{4}, std::size_t{8}, std::size_t{12}, std::size_t{16}, 20 + text, 24 + text})
	{
		for (const uint32_t value : {0U, 1U, 3U, 27U, 28U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFF0U, 0xFFFFFFFFU})
		{
			std::string changed = whole;
			std::memcpy(changed.data() + at, &value, sizeof value);
			cases.push_back(
				{"glb/lengths", "number at " + std::to_string(at) + " = " + std::to_string(value), "35", {{"a.glb", changed}}});
		}
	}
}

// Documents of invalid overall structure.
void addShapes(Cases& cases)
{
	const auto add = [&](const std::string& what, const std::string& codes, const json& document)
	{
		cases.push_back({"gltf/shapes", what, codes, asFile(document)});
	};
	json document = withBuffer(cubeGltf());
	document["nodes"][0]["children"] = {0};
	add("a node that is its own child", "3", document);
	document["nodes"] = {{{"children", {1}}, {"mesh", 0}}, {{"children", {2}}}, {{"children", {0}}}};
	add("a circle of three nodes", "3", document);
	document["nodes"] = {{{"children", {1, 1}}}, {{"mesh", 0}}};
	add("a node with one child twice", "3", document);
	document = withBuffer(cubeGltf());
	for (int i = 0; i < 100000; ++i)
	{
		document["nodes"].push_back({{"children", {i + 2}}});
	}
	document["nodes"].push_back({{"mesh", 0}});
	document["scenes"][0]["nodes"] = {1};
	add("100000 nodes above a mesh", "3", document);
	document = withBuffer(cubeGltf());
	for (int i = 0; i < 25; ++i)
	{
		const int next = static_cast<int>(document["nodes"].size());
		document["nodes"].back()["children"] = {next, next};
		document["nodes"].push_back(json::object());
	}
	add("twice twice twice as many children", "3", document);
	document = withBuffer(cubeGltf());
	document["accessors"][0].erase("bufferView");
	document["accessors"][0]["count"] = 2000000000;
	add("two thousand million zeros", "3", document);
	for (const int depth : {100, 100000})
	{
		cases.push_back({"gltf/shapes", "arrays in arrays", "3", {{"a.gltf", std::string(static_cast<std::size_t>(depth), '[')}}});
		cases.push_back({"gltf/shapes",
						 "objects in objects",
						 "3",
						 {{"a.gltf", [&]
						   {
							   std::string text;
							   for (int i = 0; i < depth; ++i)
								   text += "{\"a\":";
							   return text;
						   }()}}});
	}
	for (const char* const text :
		 {"", "null", "[]", "{}", "0", "\"\"", "{\"asset\":{\"version\":\"2.0\"}}", "\xEF\xBB\xBF{}", "{\"a\":1e999}",
		  "{\"asset\":{\"version\":\"2.0\"},\"asset\":{\"version\":\"1.0\"}}", "{\"\\ud800\":1}", "{\"\xFF\":1}"})
	{
		cases.push_back({"gltf/shapes", text, "3", {{"a.gltf", text}}});
	}
}

// Defects in buffers instead of fields: non-finite numbers, out-of-range indices.
void addValues(Cases& cases)
{
	for (std::size_t at = 0; at < 232; at += 4)
	{
		for (const uint32_t value : {0x7F800000U, 0xFFC00000U, 0x7F7FFFFFU, 0x00000001U, 0xFFFFFFFFU})
		{
			std::string bytes = cubeBuffer();
			std::memcpy(bytes.data() + at, &value, sizeof value);
			json document = cubeGltf();
			document["buffers"][0]["uri"] = dataUri("application/octet-stream", bytes);
			cases.push_back(
				{"gltf/values", "bytes at " + std::to_string(at) + " = " + std::to_string(value), "03", asFile(document)});
		}
	}
}

} // namespace

void addGltf(Cases& cases, const Bait& bait)
{
	addFields(cases, "gltf/fields", "0235", manyFields(), asFile);
	addFields(cases, "gltf/posed_fields", "0235", posedFields(), asFile);
	addFields(cases, "gltf/mask_fields", "0235", masked(blackPng(4, 4)).at("materials"),
			  [](const json& materials)
			  {
				  json document = masked(blackPng(4, 4));
				  document["materials"] = materials;
				  return asFile(document);
			  });
	addShapes(cases);
	addValues(cases);
	addGlb(cases);
	addCuts(cases, "gltf/cuts", "3", "a.gltf", jsonLine(withBuffer(cubeGltf())));
	for (const uint32_t side : {1U, 100U, 4000U, 8192U, 16384U, 16385U, 65535U, 2000000000U})
	{
		const std::string picture = side > 65535U ? blackPng(1, 1) : blackPng(side, side);
		std::string changed = picture;
		if (side > 65535U)
		{
			changed.replace(16, 8,
							std::string("\x77\x35\x94\x00\x77\x35\x94\x00", 8)); // claimed in its header, with a wrong checksum
		}
		cases.push_back({"gltf/bombs", "a mask of " + std::to_string(side) + " by as many pixels", side > 16384U ? "3" : "0",
						 asFile(masked(changed)), "", decodedMb(side)});
	}
	json many = masked(blackPng(8192, 8192));
	for (int i = 1; i < 40; ++i)
	{
		many["images"].push_back(many["images"][0]);
		many["textures"].push_back({{"source", i}});
		many["materials"].push_back(many["materials"][0]);
		many["materials"][static_cast<std::size_t>(i)]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = i;
	}
	cases.push_back({"gltf/bombs", "forty masks of 8192 by 8192 pixels", "3", asFile(many)});
	for (const std::string& uri :
		 {"http://127.0.0.1:" + std::to_string(bait.port) + "/b.bin", "https://127.0.0.1:" + std::to_string(bait.port) + "/b.bin",
		  "file://" + bait.folder + "/b.bin", bait.folder + "/b.bin", std::string("../../bait/b.bin"),
		  std::string("%2e%2e/%2e%2e/bait/b.bin"), std::string("//127.0.0.1/b.bin"), std::string("/dev/zero"),
		  std::string("/proc/self/environ"), std::string("."), std::string("a.gltf"), std::string("data:,"),
		  std::string("data:;base64,"), std::string("data:;base64,!!!!"), std::string("data:")})
	{
		json document = cubeGltf();
		document["buffers"][0]["uri"] = uri;
		cases.push_back({"gltf/uris", uri, "23", asFile(document)});
	}
}

} // namespace nook::hostile
