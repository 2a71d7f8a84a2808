// SPDX-License-Identifier: GPL-3.0-or-later
// A .gltf or .glb file → its JSON and its buffers, whole and in range.
#pragma once

#include "core/json_reader.h"
#include "scene/load.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct GltfFile
{
	std::string path;
	LoadSettings settings;
	std::optional<uint32_t> second_set; // texture coordinates to read beside those of each material's mask
	nlohmann::json json;
	std::string chunk; // binary chunk of a .glb
	bool has_chunk = false;
	std::vector<std::optional<std::string>> buffers; // bytes of those that are no chunk, where they were needed
	std::vector<std::string> decoded;                // bytes of the last buffers, which are no files: what expandGltf() made
	std::vector<std::string> files;                  // besides `path`, that buffers lie in

	JsonValue root() const
	{
		JsonValue root{&json, &path, ""};
		root.requireObject();
		return root;
	}
};

// Reads the container and parses. Throws Error: file, or invalid_input.
GltfFile openGltf(const std::string& path);

// Buffers, views, accessors, meshes, nodes, scenes: types, indices and ranges, no node twice in a tree, extensions that are known.
// What is compressed is decoded on the way (gltf_expand.h).
// Missing and short buffer files are errors that name them.
void checkGltf(GltfFile& file);

// An extension of an item by its name; none where the item does not have it.
std::optional<JsonValue> extensionOf(const JsonValue& item, std::string_view name);

// Bytes of a buffer view, or of a part of a buffer, of a checked file; good until the file is expanded or goes.
std::string_view viewBytes(GltfFile& file, std::size_t view);
std::string_view bufferBytes(GltfFile& file, std::size_t buffer, std::size_t offset, std::size_t length);

// Decodes "data:…;base64,…" of an item's "uri"; none where it is not of that form.
std::optional<std::string> dataOf(const std::string& uri, const JsonValue& item);

} // namespace nook
