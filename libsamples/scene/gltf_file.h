// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON and buffers of a .gltf or .glb file, complete and in range.
#pragma once

#include "core/json_reader.h"
#include "scene/load.h"
#include <glm/mat4x4.hpp>

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
	std::optional<uint32_t> second_set; // texture coordinates to read in addition to each material's mask coordinates
	nlohmann::json json;
	std::string chunk; // binary chunk of a .glb
	bool has_chunk = false;
	std::vector<std::optional<std::string>> buffers; // contents of buffers other than the chunk, loaded on demand
	std::vector<std::string> decoded;                // contents of the last buffers, made by expandGltf()
	std::vector<std::string> files;                  // buffer files, besides `path`

	JsonValue root() const
	{
		JsonValue root{&json, &path, ""};
		root.requireObject();
		return root;
	}
};

// Reads the container and parses it. Throws Error: file, or invalid_input.
GltfFile openGltf(const std::string& path);

// Checks buffers, views, accessors, meshes, nodes and scenes: types, indices and ranges, no node twice in a tree, known extensions.
// Decompresses on the way (gltf_expand.h).
// Missing and short buffer files are errors that name them.
void checkGltf(GltfFile& file);

// An item's extension by name; none if absent.
std::optional<JsonValue> extensionOf(const JsonValue& item, std::string_view name);

// Bytes of a buffer view or of a part of a buffer, in a checked file; valid until the file is expanded or destroyed.
std::string_view viewBytes(GltfFile& file, std::size_t view);
std::string_view bufferBytes(GltfFile& file, std::size_t buffer, std::size_t offset, std::size_t length);

// Decodes "data:…;base64,…" in an item's "uri"; none for any other form.
std::optional<std::string> dataOf(const std::string& uri, const JsonValue& item);

// Decompresses a glTF file with checked buffers and views: KHR_draco_mesh_compression and EXT_meshopt_compression, if the file has
// no uncompressed fallback.

// True if a buffer is only a target for decoding: EXT_meshopt_compression, "fallback". It has no data.
bool isFallbackBuffer(const JsonValue& buffer);

// Decodes in a worker (core/isolate.h) and redirects views, accessors and primitives of `file` to the decoded data, in additional
// buffers. True if anything was decoded. Throws Error: invalid_input if decoding fails or claims too much; unsupported for Draco in
// a build without it.
bool expandGltf(GltfFile& file);

// The placements of a node's mesh by EXT_mesh_gpu_instancing, in a checked glTF file.

// Limit per file: each instance has a name, even with few triangles.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22U;

// The instances' transforms, relative to the node's own; none if the node has a single mesh. Throws Error (invalid_input) if
// attributes have types or counts that the extension does not allow, hold no numbers, or exceed `most`.
std::optional<std::vector<glm::dmat4>> instancesOf(GltfFile& file, const JsonValue& node, std::size_t most);

// Translation × rotation × scale; the rotation is normalised to a unit quaternion (x, y, z, w), or ignored if it is zero.
glm::dmat4 placeOf(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale);

} // namespace nook
