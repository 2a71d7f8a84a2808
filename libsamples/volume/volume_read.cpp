// SPDX-License-Identifier: GPL-3.0-or-later
// Reading goes through the header that other programs use, too: what it refuses is refused here.
#include "volume/volume_glb.h"

#include "core/error.h"
#include "core/file.h"
#include "core/json_text.h"

#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <cstring>

namespace nook
{
namespace
{

uint32_t wordAt(std::string_view bytes, std::size_t at)
{
	uint32_t word = 0;
	std::memcpy(&word, bytes.data() + at, sizeof word);
	return word;
}

// The file's JSON, where there is one that nlohmann takes.
nlohmann::json jsonOf(std::string_view bytes)
{
	const std::string_view text = bytes.substr(20, wordAt(bytes, 12));
	return looseJson(text);
}

// A text of the JSON, or "": nothing depends on it.
std::string textAt(const nlohmann::json& json, const char* pointer)
{
	const nlohmann::json::json_pointer at(pointer);
	return json.is_object() && json.contains(at) && json[at].is_string() ? json[at].get<std::string>() : "";
}

template <class Item> std::vector<Item> copied(const Item* items, std::size_t count)
{
	return {items, items + count};
}

} // namespace

bool holdsVolumes(std::string_view bytes)
{
	if (bytes.size() < 20 || !bytes.starts_with("glTF"))
	{
		return false;
	}
	const std::size_t chunk = std::size_t{28} + wordAt(bytes, 12);
	return chunk < bytes.size() && bytes.substr(chunk).starts_with("NOOKVOLS");
}

VolumeSet readVolumes(const std::string& path)
{
	VolumeFileFacts facts;
	return readVolumes(path, facts);
}

VolumeSet readVolumes(const std::string& path, VolumeFileFacts& facts)
{
	const std::string bytes = readFile(path);
	nook_volumes::Volumes file;
	if (const char* const problem = file.open(bytes.data(), bytes.size(), {meshopt_decodeVertexBuffer, meshopt_decodeIndexBuffer}))
	{
		throw Error(ExitCode::invalid_input, path + ": found " + problem + ", expected a file of nook volumes");
	}
	const nook_volumes::Header& header = file.header();
	const nlohmann::json json = jsonOf(bytes);
	facts.level = textAt(json, "/asset/extras/nook_volumes/level");
	facts.generator = textAt(json, "/asset/generator");
	facts.layout = file.hasPrisms() ? VolumeLayout::prisms : VolumeLayout::polygons;
	facts.compressed = header.arrays[nook_volumes::kCorners].encoding != nook_volumes::kPlain;
	facts.greatest_error_m = header.greatest_error;
	facts.vertices = file.vertexCount();
	facts.indices = file.indexCount();
	facts.bytes = bytes.size();

	PackedVolumes packed;
	packed.clusters = copied(file.clusters(), file.clusterCount());
	packed.polygons = copied(file.polygons(), file.polygonCount());
	packed.corners = copied(file.corners(), file.cornerCount());
	VolumeSet volumes;
	volumes.distance_m = header.distance;
	volumes.ray_distance_m = header.ray_distance;
	volumes.plane_error_m = header.plane_error;
	volumes.exact_bounds = (header.flags & nook_volumes::kExactBounds) != 0;
	volumes.compensation.range = header.sum_range;
	std::copy_n(header.occlusion, nook_volumes::kKnots, volumes.compensation.occlusion.begin());
	return unpacked(packed, std::move(volumes));
}

} // namespace nook
