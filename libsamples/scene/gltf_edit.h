// SPDX-License-Identifier: GPL-3.0-or-later
// Adds baked values to a glTF file and leaves everything else in it as it is.
#pragma once

#include "scene/gltf_file.h"
#include "scene/level_glb.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

// Where a file stores visibility.
enum class BakeTarget
{
	visibility,  // the attribute _VISIBILITY, or another name of the bake's kind
	color,       // COLOR_0, multiplied into an existing one
	color_alpha, // alpha of COLOR_0
	texcoord,    // a set of texture coordinates: the front in u, the back in v
	custom,      // an attribute with a name of the user's
	texture,     // occlusionTexture of the materials
};

// Values of a mesh that several nodes or instances use.
enum class BakeInstances
{
	separate,  // each node gets its own, and a copy of the mesh that shares all other data
	shared,    // the mean of all
	attribute, // the mean, and a factor for each node or instance
};

struct GltfBake : GlbBake
{
	BakeTarget target = BakeTarget::visibility;
	std::string attribute; // of BakeTarget::texcoord and custom: TEXCOORD_2, _AO
	BakeInstances instances = BakeInstances::separate;
	std::optional<uint32_t> uv_set; // coordinates in the file that `png` uses, in place of `uvs`
	nlohmann::ordered_json record;  // asset.extras.nook: what was baked and how, "to" for the target; null: none
};

struct GltfBaked
{
	std::vector<std::string> files; // one for each output
	std::vector<float> front;       // per vertex of the level, as stored
	std::vector<float> back;        // empty if the bake has none
	std::string compression;        // that the input had: "draco" or "meshopt"; empty: none
	std::size_t shared_meshes = 0;  // meshes at several places
	std::size_t copies = 0;         // meshes added for them
	std::size_t bytes_added = 0;    // of values and pictures
	std::size_t kept_alpha = 0;     // materials whose alpha is coverage, so that BakeTarget::color_alpha leaves them out
};

// Adds values at these places to a file, after decompressing it and removing an earlier bake. An output with the ending .glb has
// all buffers inside (required of a .glb file); others have the form of the input. Relative names are rewritten for an output in
// another folder. Throws Error: file; invalid_input if the file uses the target for something else; unsupported for a result above
// 1 GiB.
GltfBaked bakeInto(const GltfFile& file, std::span<const GltfPlace> places, const GltfBake& bake,
				   std::span<const std::string> outputs);

// asset.extras.nook of a .gltf or .glb file; null without a bake, and for other files.
nlohmann::ordered_json bakeRecordOf(const std::string& path);

// Values of each place's vertices in the order of the file, 1 for vertices without: as .csv, .json or .npy.
std::string placeValues(std::span<const GltfPlace> places, std::span<const float> front, std::span<const float> back,
						const std::string& ending);

} // namespace nook
