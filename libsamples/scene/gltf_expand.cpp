// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "EXT_meshopt_compression" and "KHR_draco_mesh_compression", glTF extensions.
#include "scene/gltf_file.h"

#include "core/file.h"
#include "core/isolate.h"
#include "core/lists.h"
#include "core/words.h"
#include "scene/mesh_codec.h"

#include <array>
#include <span>

namespace nook
{
namespace
{

constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

// A block of 256 equal elements takes four bytes per byte of an element; nothing else comes close. Three 4-byte indices take at
// least one byte.
constexpr uint64_t kMostPerByte = 64;
constexpr uint64_t kSlack = 65536; // for the last block

constexpr uint64_t kMostBytes = uint64_t{1} << 32U; // limit of offsets and lengths

// Adds a buffer of decoded bytes; returns its index.
std::size_t addBuffer(GltfFile& file, std::string bytes)
{
	nlohmann::json& buffers = file.json["buffers"];
	buffers.push_back({{"byteLength", bytes.size()}});
	file.decoded.push_back(std::move(bytes));
	return buffers.size() - 1;
}

// Likewise, with a view of the whole buffer; returns the view's index.
std::size_t addView(GltfFile& file, std::string bytes)
{
	nlohmann::json& views = file.json["bufferViews"];
	const std::size_t size = bytes.size();
	views.push_back({{"buffer", addBuffer(file, std::move(bytes))}, {"byteLength", size}});
	return views.size() - 1;
}

std::size_t wordIn(const JsonValue& item, std::string_view field, std::span<const std::string_view> words)
{
	const std::string word = item.text(field, std::string(words.front()));
	for (std::size_t i = 0; i < words.size(); ++i)
	{
		if (words[i] == word)
		{
			return i;
		}
	}
	item.fail(field, "\"" + word + "\"", "one that the extension has");
}

MeshoptView meshoptViewOf(const JsonValue& extension, std::size_t index)
{
	constexpr std::array<std::string_view, 4> kModes{"", "ATTRIBUTES", "TRIANGLES", "INDICES"};
	constexpr std::array<std::string_view, 4> kFilters{"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"};
	MeshoptView view;
	view.index = index;
	view.count = extension.at("count").whole(kMostBytes);
	view.stride = extension.at("byteStride").whole(256);
	const std::size_t mode = wordIn(extension, "mode", kModes);
	failIf(mode == 0, extension, "mode", "none", "ATTRIBUTES, TRIANGLES or INDICES");
	view.mode = static_cast<MeshoptView::Mode>(mode - 1);
	view.filter = static_cast<MeshoptView::Filter>(wordIn(extension, "filter", kFilters));
	const bool attributes = view.mode == MeshoptView::Mode::attributes;
	const bool good_stride = attributes ? view.stride >= 4 && view.stride % 4 == 0 : view.stride == 2 || view.stride == 4;
	const bool good_count = view.mode != MeshoptView::Mode::triangles || view.count % 3 == 0;
	const bool good_filter =
		view.filter == MeshoptView::Filter::none ||
		(attributes && (view.filter == MeshoptView::Filter::exponential  ? true
						: view.filter == MeshoptView::Filter::quaternion ? view.stride == 8
																		 : view.stride == 4 || view.stride == 8));
	failIf(!good_stride || !good_count || !good_filter, extension, "",
		   std::to_string(view.count) + " elements, " + std::to_string(view.stride) + " bytes apart",
		   "what its mode and filter allow");
	return view;
}

// The compressed bytes of a view, after checking that its count is plausible.
std::string_view codedOf(GltfFile& file, const JsonValue& extension, const MeshoptView& view)
{
	const std::size_t buffer = extension.at("buffer").indexInto(file.root().count("buffers"));
	const uint64_t offset = extension.whole("byteOffset", kMostBytes).value_or(0);
	const uint64_t length = extension.at("byteLength").whole(kMostBytes);
	const JsonValue holder = file.root().item("buffers", buffer);
	failIf(isFallbackBuffer(holder) || offset + length > holder.at("byteLength").whole(kMostBytes), extension, "byteLength",
		   "bytes " + std::to_string(offset) + " to " + std::to_string(offset + length), "bytes that its buffer holds");
	failIf(view.count * view.stride > kMostPerByte * length + kSlack, extension, "count",
		   std::to_string(view.count) + " of " + std::to_string(view.stride) + " bytes, made of " + std::to_string(length),
		   "at most " + std::to_string(kMostPerByte) + " times as many");
	return bufferBytes(file, buffer, static_cast<std::size_t>(offset), static_cast<std::size_t>(length));
}

bool expandMeshopt(GltfFile& file)
{
	std::vector<MeshoptView> views;
	std::vector<std::string_view> coded;
	std::size_t bytes = 0;
	uint64_t made = 0;
	const std::vector<JsonValue> items = file.root().objects("bufferViews");
	for (std::size_t i = 0; i < items.size(); ++i)
	{
		const std::optional<JsonValue> extension = extensionOf(items[i], kMeshopt);
		const std::size_t buffer = items[i].at("buffer").indexInto(file.root().count("buffers"));
		if (!extension || !isFallbackBuffer(file.root().item("buffers", buffer)))
		{
			continue; // the uncompressed fallback is read
		}
		views.push_back(meshoptViewOf(*extension, i));
		coded.push_back(codedOf(file, *extension, views.back()));
		bytes += coded.back().size();
		made += views.back().count * views.back().stride;
		failIf(made > 2 * kMaxFileBytes, *extension, "count", std::to_string(made) + " bytes of views so far",
			   "at most " + std::to_string(2 * kMaxFileBytes));
	}
	if (views.empty())
	{
		return false;
	}
	std::vector<std::string> decoded(views.size());
	const auto ask = [&](ValueWriter& to)
	{
		to.text(file.path);
		to.value(uint64_t{views.size()});
		for (std::size_t i = 0; i < views.size(); ++i)
		{
			to.value(views[i]);
			to.values(coded[i]);
		}
	};
	const auto take = [&](ValueReader& from)
	{
		for (std::size_t i = 0; i < views.size(); ++i)
		{
			from.values(decoded[i], static_cast<std::size_t>(views[i].count * views[i].stride));
		}
	};
	isolate({kLevelWorker, kDecodeMeshopt}, file.path, levelLimits(bytes), ask, take);
	for (std::size_t i = 0; i < views.size(); ++i)
	{
		// Modifies the view in place, so that references stay valid.
		nlohmann::json& view = file.json["bufferViews"][static_cast<std::size_t>(views[i].index)];
		view["byteLength"] = decoded[i].size();
		view["buffer"] = addBuffer(file, std::move(decoded[i]));
		view.erase("byteOffset");
	}
	return true;
}

// A mesh stored only in Draco.
struct DracoMesh
{
	std::vector<std::pair<std::size_t, std::size_t>> primitives; // primitives that use it: mesh and primitive number
	std::string where;                                           // location of the first one
	std::size_t view = 0;                                        // buffer view of the coded bytes
	std::string_view coded;
	std::vector<DracoAttribute> attributes;
	std::vector<std::size_t> accessors; // one accessor each
	uint64_t vertices = 0;              // decoded
	std::vector<uint32_t> indices;
	std::vector<std::string> values;
};

class DracoExpander
{
public:
	explicit DracoExpander(GltfFile& file) : m_file(file) {}

	bool run()
	{
		const std::vector<JsonValue> meshes = m_file.root().objects("meshes");
		for (std::size_t i = 0; i < meshes.size(); ++i)
		{
			const std::vector<JsonValue> primitives = meshes[i].objects("primitives");
			for (std::size_t k = 0; k < primitives.size(); ++k)
			{
				find(primitives[k], i, k);
			}
		}
		if (m_meshes.empty())
		{
			return false;
		}
		decode();
		for (DracoMesh& mesh : m_meshes)
		{
			replace(mesh);
		}
		return true;
	}

private:
	void find(const JsonValue& primitive, std::size_t mesh, std::size_t index)
	{
		const std::optional<JsonValue> extension = extensionOf(primitive, kDraco);
		const std::size_t accessors = m_file.root().count("accessors");
		const JsonValue attributes = primitive.objectNeeded("attributes");
		const std::optional<std::size_t> positions = attributes.index("POSITION", accessors);
		if (!extension || !positions || m_file.root().item("accessors", *positions).has("bufferView"))
		{
			return; // the uncompressed fallback is read
		}
		const std::string where = m_file.path + ": " + primitive.element;
		refuseInputIf(!NOOK_HAS_DRACO, where,
					  "KHR_draco_mesh_compression, which this build does not support (Debian's package libdraco-dev)",
					  "what `gltf-transform copy IN.glb OUT.glb` makes of it", ExitCode::unsupported);
		const std::size_t view = extension->at("bufferView").indexInto(m_file.root().count("bufferViews"));
		DracoMesh made;
		made.where = where;
		made.view = view;
		addAttributes(attributes, extension->objectNeeded("attributes"), made);
		const auto [known, is_new] = m_of_view.try_emplace(view, m_meshes.size());
		if (is_new)
		{
			made.coded = viewBytes(m_file, view);
			m_meshes.push_back(std::move(made));
		}
		else if (made.accessors != m_meshes[known->second].accessors)
		{
			extension->fail("bufferView", "the data of " + m_meshes[known->second].where + " with other accessors", "the same");
		}
		m_meshes[known->second].primitives.emplace_back(mesh, index);
	}

	void addAttributes(const JsonValue& attributes, const JsonValue& ids, DracoMesh& made) const
	{
		for (const auto& [name, number] : attributes.value->items())
		{
			if (!ids.has(name))
			{
				continue;
			}
			const std::size_t accessor = attributes.at(name).indexInto(m_file.root().count("accessors"));
			const JsonValue item = m_file.root().item("accessors", accessor);
			DracoAttribute attribute;
			attribute.id = static_cast<uint32_t>(ids.at(name).whole(UINT32_MAX));
			attribute.component = static_cast<uint32_t>(item.at("componentType").whole(UINT16_MAX));
			attribute.components = static_cast<uint32_t>(componentsOf(item.text("type")));
			failIf(attribute.components == 0 || attribute.components > 4 || bytesOfComponent(attribute.component) == 0, item,
				   "type", "\"" + item.text("type") + "\" of " + std::to_string(attribute.component),
				   "SCALAR to VEC4 of 5120 to 5126");
			made.attributes.push_back(attribute);
			made.accessors.push_back(accessor);
		}
	}

	void decode()
	{
		const std::size_t bytes = sumOver(m_meshes, [](const DracoMesh& mesh) { return mesh.coded.size(); });
		const auto ask = [&](ValueWriter& to)
		{
			to.value(uint64_t{m_meshes.size()});
			for (const DracoMesh& mesh : m_meshes)
			{
				to.text(mesh.where);
				to.values(mesh.coded);
				to.values(mesh.attributes);
			}
		};
		const auto take = [&](ValueReader& from)
		{
			for (DracoMesh& mesh : m_meshes)
			{
				receive(mesh, from);
			}
		};
		isolate({kLevelWorker, kDecodeDraco}, m_file.path, levelLimits(bytes), ask, take);
	}

	void receive(DracoMesh& mesh, ValueReader& from)
	{
		mesh.vertices = from.value<uint64_t>();
		from.values(mesh.indices, 3 * kMaxTriangles);
		m_triangles += mesh.indices.size() / 3;
		m_vertices += mesh.vertices;
		checkCounts(mesh.where, m_triangles, m_vertices, " so far");
		for (const DracoAttribute& attribute : mesh.attributes)
		{
			const std::size_t size =
				static_cast<std::size_t>(mesh.vertices) * attribute.components * bytesOfComponent(attribute.component);
			std::string& values = mesh.values.emplace_back();
			from.values(values, size);
			if (values.size() != size)
			{
				throw StreamEnded{};
			}
		}
	}

	// Makes the primitives triangles with accessors into decoded buffers. The coded view becomes that of the indices, and the first
	// primitive's accessor of indices that of all, so that no dead ones remain.
	void replace(DracoMesh& mesh)
	{
		nlohmann::json& accessors = m_file.json["accessors"];
		for (std::size_t i = 0; i < mesh.accessors.size(); ++i)
		{
			nlohmann::json& accessor = accessors[mesh.accessors[i]];
			accessor["bufferView"] = addView(m_file, std::move(mesh.values[i]));
			accessor["count"] = mesh.vertices;
			accessor.erase("byteOffset");
		}
		const std::string_view indices(reinterpret_cast<const char*>(mesh.indices.data()), 4 * mesh.indices.size());
		m_file.json["bufferViews"][mesh.view] = {{"buffer", addBuffer(m_file, std::string(indices))},
												 {"byteLength", indices.size()}};
		const auto& [first_mesh, first] = mesh.primitives.front();
		const JsonValue coded = m_file.root().item("meshes", first_mesh).item("primitives", first);
		std::size_t used = coded.index("indices", accessors.size()).value_or(accessors.size());
		if (used == accessors.size() || accessors[used].contains("bufferView"))
		{
			used = accessors.size();
			accessors.push_back(nlohmann::json::object());
		}
		accessors[used]["bufferView"] = mesh.view;
		accessors[used]["componentType"] = 5125U;
		accessors[used]["count"] = mesh.indices.size();
		accessors[used]["type"] = "SCALAR";
		for (const char* const stale : {"byteOffset", "min", "max"})
		{
			accessors[used].erase(stale);
		}
		std::vector<uint32_t>().swap(mesh.indices);
		for (const auto& [of, index] : mesh.primitives)
		{
			nlohmann::json& primitive = m_file.json["meshes"][of]["primitives"][index];
			primitive["indices"] = used;
			primitive["mode"] = 4U;
		}
	}

	GltfFile& m_file;
	std::vector<DracoMesh> m_meshes;
	std::map<std::size_t, std::size_t> m_of_view; // mesh for each buffer view
	uint64_t m_triangles = 0;                     // decoded so far
	uint64_t m_vertices = 0;
};

} // namespace

bool isFallbackBuffer(const JsonValue& buffer)
{
	const std::optional<JsonValue> extension = extensionOf(buffer, kMeshopt);
	return extension && extension->boolean("fallback", false);
}

bool expandGltf(GltfFile& file)
{
	const bool meshopt = expandMeshopt(file);
	return DracoExpander(file).run() || meshopt;
}

} // namespace nook
