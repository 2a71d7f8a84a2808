// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volume_glb.h"

#include "core/error.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/text.h"
#include "scene/level_glb.h"

#include <glm/common.hpp>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace nook
{

namespace
{

using Json = nlohmann::json;
using nook_volumes::Cluster;
using nook_volumes::Corner;
using nook_volumes::Header;

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and numbers are written as they lie in memory");

constexpr int kUshorts = 5123;     // component type
constexpr int kVertexData = 34962; // targets of buffer views
constexpr int kIndexData = 34963;

glm::dvec3 originOf(const VolumeSet& volumes)
{
	const auto boxOf = [&](std::size_t i)
	{
		return Bounds{volumes.clusters[i].least, volumes.clusters[i].most};
	};
	const auto polygonsOf = [&](std::size_t i)
	{
		return volumes.clusters[i].polygon_count;
	};
	return glbOrigin(preciseBounds(volumes.clusters.size(), boxOf, polygonsOf)); // 0 without clusters
}

class Writer
{
public:
	Writer(const VolumeSet& volumes, const PackedVolumes& packed, const VolumeFileSettings& settings)
		: m_volumes(volumes), m_packed(packed), m_settings(settings), m_origin(originOf(volumes))
	{
		std::memcpy(m_header.magic, "NOOKVOLS", sizeof m_header.magic);
		m_header.version = nook_volumes::kVersion;
		m_header.flags = (volumes.exact_bounds ? nook_volumes::kExactBounds : 0U) | (prisms() ? nook_volumes::kHasPrisms : 0U) |
						 (sharesCorners() ? nook_volumes::kSharedCorners : 0U);
		m_header.distance = volumes.distance_m;
		m_header.ray_distance = volumes.ray_distance_m;
		std::copy_n(&m_origin.x, 3, m_header.origin);
		m_header.greatest_error = packed.greatest_error_m;
		m_header.plane_error = std::max(volumes.plane_error_m, packed.plane_error_m);
		m_header.sum_range = volumes.compensation.range;
		std::copy(volumes.compensation.occlusion.begin(), volumes.compensation.occlusion.end(), m_header.occlusion);
	}

	std::string bytes(std::string_view level, std::string_view generator)
	{
		std::string chunk(padded(sizeof(Header)), '\0');
		m_views.push_back({{"name", "nook header"}, {"buffer", 0}, {"byteOffset", 0}, {"byteLength", sizeof(Header)}});
		addArray(chunk, nook_volumes::kClusters, "nook clusters", m_packed.clusters);
		addArray(chunk, nook_volumes::kPolygons, "nook polygons", m_packed.polygons);
		addArray(chunk, nook_volumes::kCorners, "nook corners", sharesCorners() ? std::vector<Corner>() : m_packed.corners);
		addArray(chunk, nook_volumes::kIndices, "triangles", m_packed.indices);
		addArray(chunk, nook_volumes::kVertices, prisms() ? "prisms" : "shared corners", m_packed.vertices);
		std::memcpy(chunk.data(), &m_header, sizeof m_header);
		if (m_packed.polygons.empty())
		{
			return container(jsonLine(emptyRoot(level, generator, chunk.size())), chunk);
		}
		addScene();
		return container(jsonLine(root(level, generator, chunk.size())), chunk);
	}

private:
	bool prisms() const
	{
		return m_settings.layout == VolumeLayout::prisms;
	}

	bool sharesCorners() const
	{
		return m_settings.compress && !prisms();
	}

	// The array that the scene draws.
	nook_volumes::ArrayName drawn() const
	{
		return prisms() || sharesCorners() ? nook_volumes::kVertices : nook_volumes::kCorners;
	}

	[[noreturn]] void refuseSize() const
	{
		throw Error(ExitCode::unsupported, "volumes: found a file of more than " + capText(m_settings.most_bytes) + " for " +
											   std::to_string(m_packed.polygons.size()) +
											   " polygons, expected less: " + (prisms() ? "--layout polygons, " : "") +
											   (m_settings.compress ? "" : "--compress, ") +
											   "--detail auto, --drop-below 1/512, or parts of the level (nook level --cells)");
	}

	static std::size_t padded(std::size_t size)
	{
		return (size + 15) / 16 * 16;
	}

	template <class Item>
	void addArray(std::string& chunk, nook_volumes::ArrayName name, const char* title, const std::vector<Item>& items)
	{
		const auto* const plain = reinterpret_cast<const unsigned char*>(items.data());
		const std::size_t size = items.size() * sizeof(Item);
		const bool compress = m_settings.compress && name != nook_volumes::kClusters && !items.empty();
		const std::string coded = compress ? encoded(name, items) : std::string();
		const std::size_t bytes = compress ? coded.size() : size;
		if (bytes > m_settings.most_bytes - std::min(m_settings.most_bytes, chunk.size()))
		{
			refuseSize();
		}
		const auto encoding = !compress                        ? nook_volumes::kPlain
							  : name == nook_volumes::kIndices ? nook_volumes::kMeshoptTriangles
															   : nook_volumes::kMeshoptVertices;
		m_header.arrays[name] = {chunk.size(), bytes, static_cast<uint32_t>(items.size()), sizeof(Item), encoding};
		if (items.empty()) // glTF has no empty views
		{
			return;
		}
		m_view_of[name] = m_views.size();
		m_views.push_back(viewJson(name, title, chunk.size(), bytes, size));
		chunk.append(compress ? coded.data() : reinterpret_cast<const char*>(plain), bytes);
		chunk.resize(padded(chunk.size()), '\0');
	}

	// A compressed view's fallback refers to a second buffer without data: viewers that support the extension never read it.
	Json viewJson(nook_volumes::ArrayName name, const char* title, std::size_t offset, std::size_t bytes, std::size_t plain_bytes)
	{
		Json view{{"name", title}, {"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}};
		const bool vertices = name == drawn();
		if (vertices || name == nook_volumes::kIndices)
		{
			view["target"] = vertices ? kVertexData : kIndexData;
		}
		if (vertices)
		{
			view["byteStride"] = sizeof(Corner);
		}
		const nook_volumes::Array& array = m_header.arrays[name];
		if (array.encoding != nook_volumes::kPlain)
		{
			view["buffer"] = 1;
			view["byteOffset"] = m_plain_bytes;
			view["byteLength"] = plain_bytes;
			view["extensions"]["EXT_meshopt_compression"] = {
				{"buffer", 0},          {"byteOffset", offset},
				{"byteLength", bytes},  {"byteStride", array.stride},
				{"count", array.count}, {"mode", array.encoding == nook_volumes::kMeshoptTriangles ? "TRIANGLES" : "ATTRIBUTES"}};
			m_plain_bytes += padded(plain_bytes);
		}
		return view;
	}

	// Codec versions required by the extension: 0 for vertices, 1 for triangles.
	template <class Item> std::string encoded(nook_volumes::ArrayName name, const std::vector<Item>& items) const
	{
		std::string coded;
		auto* const bytes =
			[&](std::size_t bound)
		{
			coded.resize(bound);
			return reinterpret_cast<unsigned char*>(coded.data());
		}(name == nook_volumes::kIndices ? meshopt_encodeIndexBufferBound(items.size(), items.size())
										 : meshopt_encodeVertexBufferBound(items.size(), sizeof(Item)));
		if constexpr (sizeof(Item) == 2)
		{
			meshopt_encodeIndexVersion(1);
			coded.resize(meshopt_encodeIndexBuffer(bytes, coded.size(), items.data(), items.size()));
		}
		else
		{
			meshopt_encodeVertexVersion(0);
			coded.resize(meshopt_encodeVertexBuffer(bytes, coded.size(), items.data(), items.size(), sizeof(Item)));
		}
		return coded;
	}

	void addScene()
	{
		for (const Cluster& cluster : m_packed.clusters)
		{
			const std::size_t mesh = m_meshes.size();
			const bool vertices = drawn() == nook_volumes::kVertices;
			const double(&origin)[3] = vertices ? cluster.vertex_origin : cluster.origin;
			const float(&step)[3] = vertices ? cluster.vertex_step : cluster.step;
			const Json translation{origin[0] - m_header.origin[0], origin[1] - m_header.origin[1], origin[2] - m_header.origin[2]};
			m_nodes.push_back({{"mesh", mesh}, {"translation", translation}, {"scale", step}});
			m_meshes.push_back(
				{{"primitives",
				  {{{"attributes", {{"POSITION", positions(cluster)}}}, {"indices", indices(cluster)}, {"material", 0}}}}});
		}
	}

	std::size_t positions(const Cluster& cluster)
	{
		const bool vertices = drawn() == nook_volumes::kVertices;
		const std::vector<Corner>& all = vertices ? m_packed.vertices : m_packed.corners;
		const std::size_t first = vertices ? cluster.first_vertex : cluster.first_corner;
		const std::size_t count = vertices ? cluster.vertex_count : cluster.corner_count;
		glm::ivec3 least(65535);
		glm::ivec3 most(0);
		for (std::size_t i = first; i < first + count; ++i)
		{
			const glm::ivec3 at(all[i].x, all[i].y, all[i].z);
			least = glm::min(least, at);
			most = glm::max(most, at);
		}
		return accessor(drawn(), first * sizeof(Corner), count,
						{{"type", "VEC3"}, {"min", {least.x, least.y, least.z}}, {"max", {most.x, most.y, most.z}}});
	}

	std::size_t indices(const Cluster& cluster)
	{
		return accessor(nook_volumes::kIndices, std::size_t{cluster.first_index} * 2, cluster.index_count, {{"type", "SCALAR"}});
	}

	std::size_t accessor(nook_volumes::ArrayName name, std::size_t offset, std::size_t count, Json item)
	{
		item["bufferView"] = m_view_of[name];
		item["byteOffset"] = offset;
		item["componentType"] = kUshorts;
		item["count"] = count;
		m_accessors.push_back(std::move(item));
		return m_accessors.size() - 1;
	}

	Json root(std::string_view level, std::string_view generator, std::size_t chunk_bytes)
	{
		Json nodes = listOf(m_nodes.size(), [](std::size_t i) { return i; });
		if (m_origin != glm::dvec3(0.0))
		{
			m_nodes.push_back({{"name", "level"}, {"translation", {m_origin.x, m_origin.y, m_origin.z}}, {"children", nodes}});
			nodes = Json::array({m_nodes.size() - 1});
		}
		Json root{{"scene", 0}, {"accessors", m_accessors}, {"bufferViews", m_views}, {"meshes", m_meshes}, {"nodes", m_nodes}};
		root["asset"] = {{"version", "2.0"}, {"generator", generator}, {"extras", {{"nook_volumes", facts(level)}}}};
		root["scenes"] = Json::array({Json{{"nodes", nodes}}});
		root["materials"] = Json::array({Json{{"name", prisms() ? "volumes" : "polygons"}, {"doubleSided", true}}});
		root["buffers"] = Json::array({Json{{"byteLength", chunk_bytes}}});
		Json extensions = Json::array({"KHR_mesh_quantization"});
		if (m_settings.compress)
		{
			extensions.push_back("EXT_meshopt_compression");
			root["buffers"].push_back(
				{{"byteLength", m_plain_bytes}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
		}
		root["extensionsUsed"] = extensions;
		root["extensionsRequired"] = extensions;
		return root;
	}

	// Nothing to draw: glTF allows neither empty buffer views nor empty lists.
	Json emptyRoot(std::string_view level, std::string_view generator, std::size_t chunk_bytes) const
	{
		Json root{{"scene", 0}, {"bufferViews", m_views}};
		root["asset"] = {{"version", "2.0"}, {"generator", generator}, {"extras", {{"nook_volumes", facts(level)}}}};
		root["scenes"] = Json::array({Json::object()});
		root["buffers"] = Json::array({Json{{"byteLength", chunk_bytes}}});
		return root;
	}

	Json facts(std::string_view level) const
	{
		Json facts{{"version", nook_volumes::kVersion},
				   {"level", level},
				   {"layout", prisms() ? "prisms" : "polygons"},
				   {"distance_m", m_volumes.distance_m},
				   {"ray_distance_m", m_volumes.ray_distance_m},
				   {"exact_bounds", m_volumes.exact_bounds},
				   {"quantisation_error_m", m_packed.greatest_error_m},
				   {"plane_error_m", m_header.plane_error},
				   {"clusters", m_packed.clusters.size()},
				   {"polygons", m_packed.polygons.size()},
				   {"corners", m_packed.corners.size()}};
		facts["compensation"] = {{"range", m_volumes.compensation.range}, {"occlusion", m_volumes.compensation.occlusion}};
		constexpr std::array kNames{"clusters", "polygons", "corners", "triangles", "prisms"};
		facts["views"] = {{"header", 0}};
		for (std::size_t name = 0; name < kNames.size(); ++name)
		{
			if (m_view_of[name] > 0)
			{
				facts["views"][name == nook_volumes::kVertices && !prisms() ? "shared_corners" : kNames[name]] = m_view_of[name];
			}
		}
		return facts;
	}

	// glTF 2.0, section 4.4. The content of the binary chunk is aligned to 16, for programs that map the file.
	std::string container(std::string text, const std::string& chunk) const
	{
		constexpr std::size_t kHeads = 12 + 8 + 8;
		text.resize(padded(text.size() + kHeads) - kHeads, ' ');
		const std::size_t size = kHeads + text.size() + chunk.size();
		if (size > m_settings.most_bytes)
		{
			refuseSize();
		}
		std::string bytes = "glTF";
		bytes.reserve(size);
		const auto word = [&bytes](std::size_t value)
		{
			const auto number = static_cast<uint32_t>(value);
			bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
		};
		word(2);
		word(size);
		word(text.size());
		bytes += "JSON" + text;
		word(chunk.size());
		bytes.append("BIN\0", 4);
		return bytes += chunk;
	}

	const VolumeSet& m_volumes;
	const PackedVolumes& m_packed;
	const VolumeFileSettings& m_settings;
	glm::dvec3 m_origin;
	Header m_header{};
	std::size_t m_plain_bytes = 0;                              // size of the buffer without data
	std::array<std::size_t, nook_volumes::kArrays> m_view_of{}; // 0: an empty array
	Json m_views = Json::array();
	Json m_accessors = Json::array();
	Json m_meshes = Json::array();
	Json m_nodes = Json::array();
};

// Reads through the header that other programs use, so both reject the same files.

uint32_t wordAt(std::string_view bytes, std::size_t at)
{
	uint32_t word = 0;
	std::memcpy(&word, bytes.data() + at, sizeof word);
	return word;
}

// A string of the JSON, or "" if absent; it is informative only.
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

VolumeFile volumeGlb(const VolumeSet& volumes, const VolumeFileSettings& settings, std::string_view level,
					 std::string_view generator, const RunSettings& run)
{
	const ProgressCounter stage(run.progress, "file");
	VolumeFile file;
	const bool prisms = settings.layout == VolumeLayout::prisms;
	file.packed = packVolumes(volumes, {.prisms = prisms, .shared_corners = settings.compress && !prisms}, run);
	refuseIf(file.packed.polygons.empty() && !volumes.occluders.polygons.empty(),
			 std::string(level) + ": found no polygon that is larger than the steps of 16-bit numbers, expected one",
			 ExitCode::invalid_input);
	file.bytes = Writer(volumes, file.packed, settings).bytes(level, generator);
	return file;
}

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
	const nlohmann::json json = looseJson(std::string_view(bytes).substr(20, wordAt(bytes, 12)));
	facts.level = textAt(json, "/asset/extras/nook_volumes/level");
	facts.generator = textAt(json, "/asset/generator");
	facts.layout = file.hasPrisms() ? VolumeLayout::prisms : VolumeLayout::polygons;
	facts.compressed = header.arrays[nook_volumes::kPolygons].encoding != nook_volumes::kPlain;
	facts.greatest_error_m = header.greatest_error;
	facts.vertices = file.hasPrisms() ? file.vertexCount() : 0;
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
