// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gltf_file.h"

#include "core/base64.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/words.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

namespace nook
{
namespace
{

constexpr uint32_t kGlbMagic = 0x46546C67;  // "glTF"
constexpr uint32_t kJsonChunk = 0x4E4F534A; // "JSON"
constexpr uint32_t kBinChunk = 0x004E4942;  // "BIN\0"

// Splits a .glb into its chunks and returns the JSON text.
std::string takeChunks(std::string bytes, GltfFile& file)
{
	const std::string header = file.path + ": header";
	refuseInputIf(bytes.size() < 20 || littleEndian(bytes, 0, 4) != kGlbMagic, header,
				  std::to_string(bytes.size()) + " bytes that are not a binary glTF", "\"glTF\" first");
	refuseInputIf(littleEndian(bytes, 4, 4) != 2, header, "version " + std::to_string(littleEndian(bytes, 4, 4)), "2");
	refuseInputIf(littleEndian(bytes, 8, 4) > bytes.size(), header, std::to_string(bytes.size()) + " bytes",
				  std::to_string(littleEndian(bytes, 8, 4)));
	const std::size_t end = littleEndian(bytes, 8, 4);
	std::string json;
	std::size_t chunk_at = 0;
	std::size_t chunk_size = 0;
	std::size_t at = 12;
	for (int chunk = 0; at + 8 <= end; ++chunk)
	{
		const std::size_t size = littleEndian(bytes, at, 4);
		const uint64_t kind = littleEndian(bytes, at + 4, 4);
		at += 8;
		refuseInputIf(size > end - at, file.path + ": chunk " + std::to_string(chunk), std::to_string(end - at) + " bytes",
					  std::to_string(size));
		refuseInputIf(chunk == 0 && kind != kJsonChunk, file.path + ": chunk 0", "another type", "JSON");
		if (chunk == 0)
		{
			json = bytes.substr(at, size);
		}
		else if (kind == kBinChunk && !file.has_chunk)
		{
			chunk_at = at;
			chunk_size = size;
			file.has_chunk = true;
		}
		else
		{
			file.others.append(bytes, at - 8, size + 8);
		}
		at += size;
	}
	// In place, because it is most of a file that may be large.
	bytes.resize(chunk_at + chunk_size);
	bytes.erase(0, chunk_at);
	file.chunk = std::move(bytes);
	return json;
}

// Rejects JSON with so many values that parsing would take gigabytes ("{}," becomes 64 bytes), and text with a zero byte inside.
void checkText(const std::string& text, const std::string& path)
{
	constexpr std::size_t kMost = std::size_t{1} << 22U; // a level of 100 000 nodes has 2 million
	std::size_t values = 0;
	bool in_text = false;
	for (std::size_t i = 0; i < text.size(); ++i)
	{
		const char c = text[i];
		if (in_text)
		{
			if (text.compare(i, 6, "\\u0000") == 0)
			{
				refuseInput(path + ": JSON", "a character 0 at byte " + std::to_string(i), "text"); // names would end there
			}
			in_text = c != '"';
			i += c == '\\' ? 1 : 0;
			continue;
		}
		in_text = c == '"';
		values += c == ',' || c == '[' || c == '{' ? 1 : 0; // each starts at most one
	}
	refuseInputIf(values > kMost, path + ": JSON", std::to_string(values) + " values", "at most " + std::to_string(kMost));
}

void parseText(GltfFile& file)
{
	const std::string& path = file.path;
	checkText(file.text, path);
	try
	{
		file.json = nlohmann::json::parse(file.text);
	}
	catch (const nlohmann::json::exception& error)
	{
		std::string reason = error.what();
		const std::size_t at = reason.find("at line");
		const std::size_t tag = reason.find("] "); // "[json.exception.out_of_range.406] "
		reason = at != std::string::npos    ? reason.substr(at)
				 : tag != std::string::npos ? "(" + reason.substr(tag + 2) + ")"
											: reason;
		refuseInput(path + ": JSON", "an error " + reason.substr(0, reason.find(';')), "the text of a glTF file");
	}
}

// Validates the structure of a glTF file for readers that trust it: khronos.org/registry/glTF/specs/2.0, sections 3.5 to 3.7 and 5.

constexpr uint64_t kMaxBytes = uint64_t{1} << 32U;
constexpr uint64_t kMaxVertices = 3 * uint64_t{kMaxTriangles};
constexpr std::size_t kMaxDepth = 512; // of nodes; readers recurse

// Extensions that a file may require: supported here, or irrelevant for surfaces.
constexpr std::array<std::string_view, 11> kKnownExtensions{
	"EXT_meshopt_compression", "KHR_draco_mesh_compression", "EXT_texture_webp",    "KHR_texture_basisu",
	"KHR_mesh_quantization",   "KHR_texture_transform",      "KHR_lights_punctual", "KHR_animation_pointer",
	"KHR_xmp_json_ld",         "EXT_mesh_gpu_instancing",    "KHR_node_visibility"};

struct BufferView
{
	uint64_t length = 0;
	uint64_t stride = 0; // 0: packed
};

struct Accessor
{
	std::string type;
	uint64_t component = 0;
	uint64_t count = 0;
	bool stored = false; // at least partly in a buffer
};

bool isIndex(uint64_t component)
{
	return component == 5121 || component == 5123 || component == 5125;
}

class GltfChecker
{
public:
	explicit GltfChecker(GltfFile& file) : m_file(file), m_root(file.root()) {}

	void run()
	{
		head();
		buffers();
		views();
		if (expandGltf(m_file))
		{
			buffers(); // also checks what was decoded
			views();
		}
		accessors();
		meshes();
		nodes();
		scenes();
	}

private:
	void head() const
	{
		const std::string version = m_root.objectNeeded("asset").text("version");
		failIf(!version.starts_with("2."), m_root, "asset.version", "\"" + version + "\"", "\"2.0\"");
		for (const std::string& name : m_root.texts("extensionsRequired"))
		{
			refuseInputIf(!name.starts_with("KHR_materials_") &&
							  std::find(kKnownExtensions.begin(), kKnownExtensions.end(), name) == kKnownExtensions.end(),
						  m_file.path + ": extensionsRequired", "\"" + name + "\"",
						  "a file that can be read without it, as `gltf-transform copy IN.glb OUT.glb` may make one",
						  ExitCode::unsupported);
		}
	}

	void buffers()
	{
		const std::vector<JsonValue> items = m_root.objects("buffers");
		m_buffers.clear();
		m_buffer_bytes = 0;
		for (const JsonValue& item : items)
		{
			const uint64_t length = item.at("byteLength").whole(kMaxBytes);
			const bool first = m_buffers.empty();
			m_buffers.push_back(length);
			if (m_buffers.size() > items.size() - m_file.decoded.size() || isFallbackBuffer(item))
			{
				continue;
			}
			uint64_t held = m_file.chunk.size();
			if (item.has("uri"))
			{
				held = heldOf(item);
			}
			else if (!first || !m_file.has_chunk)
			{
				item.fail("uri", "nothing", "a file's name or data");
			}
			m_buffer_bytes += held; // files are read whole
			failIf(m_buffer_bytes > 2 * kMaxFileBytes, item, "byteLength",
				   std::to_string(m_buffer_bytes) + " bytes of buffers so far", "at most " + std::to_string(2 * kMaxFileBytes));
			failIf(held < length, item, "byteLength", std::to_string(held) + " bytes", std::to_string(length));
		}
	}

	uint64_t heldOf(const JsonValue& item)
	{
		const std::string uri = item.text("uri");
		if (const std::optional<std::string> data = dataOf(uri, item))
		{
			return data->size();
		}
		const std::string path = besideLevel(m_file.path, unescaped(uri));
		std::error_code failed;
		const bool regular = std::filesystem::is_regular_file(nativePath(path), failed);
		const uint64_t size = regular ? std::filesystem::file_size(nativePath(path), failed) : 0;
		refuseInputIf(!regular || failed, m_file.path + ": " + item.element, "no file " + path, "the level's data", ExitCode::file);
		checkInside(m_file.path, item.element + ".uri", path, m_file.settings);
		addOnce(m_file.files, path);
		return size;
	}

	void views()
	{
		m_views.clear();
		for (const JsonValue& item : m_root.objects("bufferViews"))
		{
			const std::size_t index = item.at("buffer").indexInto(m_buffers.size());
			const uint64_t buffer = m_buffers[index];
			const std::optional<JsonValue> extensions = item.object("extensions");
			failIf(isFallbackBuffer(m_root.item("buffers", index)) && !(extensions && extensions->has("EXT_meshopt_compression")),
				   item, "buffer", "one that EXT_meshopt_compression decodes into", "one that holds bytes");
			BufferView view;
			const uint64_t offset = item.whole("byteOffset", kMaxBytes).value_or(0);
			view.length = item.at("byteLength").whole(kMaxBytes);
			view.stride = item.whole("byteStride", 252).value_or(0);
			failIf(offset + view.length > buffer, item, "byteLength",
				   "bytes " + std::to_string(offset) + " to " + std::to_string(offset + view.length),
				   "an end by byte " + std::to_string(buffer));
			m_views.push_back(view);
		}
	}

	// Checks `count` elements of `size` bytes from `offset` in the view that `field` of `item` names.
	void range(const JsonValue& item, uint64_t offset, uint64_t count, uint64_t size) const
	{
		const BufferView& view = m_views[item.at("bufferView").indexInto(m_views.size())];
		const uint64_t stride = view.stride == 0 ? size : view.stride;
		const uint64_t end = count == 0 ? offset : offset + stride * (count - 1) + size;
		failIf(end > view.length || stride < size, item, "bufferView",
			   "a view of " + std::to_string(view.length) + " bytes, " + std::to_string(stride) + " apart",
			   std::to_string(end) + " bytes, at least " + std::to_string(size) + " apart");
	}

	void accessors()
	{
		for (const JsonValue& item : m_root.objects("accessors"))
		{
			Accessor accessor;
			accessor.type = item.text("type");
			accessor.component = item.at("componentType").whole(UINT16_MAX);
			accessor.count = item.at("count").whole(kMaxVertices);
			const uint64_t size = componentsOf(accessor.type) * bytesOfComponent(accessor.component);
			failIf(size == 0, item, "type", "\"" + accessor.type + "\" of " + std::to_string(accessor.component),
				   "SCALAR to MAT4 of 5120 to 5126");
			if (item.has("bufferView"))
			{
				range(item, item.whole("byteOffset", kMaxBytes).value_or(0), accessor.count, size);
			}
			else
			{
				m_empty_bytes += accessor.count * size; // zeros, or sparse
			}
			if (const std::optional<JsonValue> sparse = item.object("sparse"))
			{
				const uint64_t count = sparse->at("count").whole(accessor.count);
				const JsonValue indices = sparse->objectNeeded("indices");
				const uint64_t component = indices.at("componentType").whole(UINT16_MAX);
				failIf(!isIndex(component), indices, "componentType", std::to_string(component), "5121, 5123 or 5125");
				range(indices, indices.whole("byteOffset", kMaxBytes).value_or(0), count, bytesOfComponent(component));
				const JsonValue values = sparse->objectNeeded("values");
				range(values, values.whole("byteOffset", kMaxBytes).value_or(0), count, size);
			}
			accessor.stored = item.has("bufferView") || item.has("sparse");
			m_accessors.push_back(accessor);
		}
		// Values without a buffer: a count alone could request any amount of memory.
		failIf(m_empty_bytes > (uint64_t{1} << 28U), m_root, "accessors",
			   std::to_string(m_empty_bytes) + " bytes that no buffer holds", "at most 268435456");
	}

	const Accessor& attribute(const JsonValue& item, std::string_view field, std::string_view types) const
	{
		const Accessor& accessor = m_accessors[item.at(field).indexInto(m_accessors.size())];
		failIf(types.find(accessor.type) == std::string_view::npos, item, field, "an accessor of type " + accessor.type,
			   std::string(types));
		return accessor;
	}

	void primitive(const JsonValue& item)
	{
		static_cast<void>(item.whole("mode", 6));
		item.index("material", m_root.count("materials"));
		const JsonValue attributes = item.objectNeeded("attributes");
		if (attributes.has("POSITION"))
		{
			const Accessor& positions = attribute(attributes, "POSITION", "VEC3");
			m_used += (item.has("indices") ? 0 : positions.count) + item.count("targets") * positions.count;
			const auto check = [&](const std::string& name, std::string_view types)
			{
				if (attributes.has(name) && attribute(attributes, name, types).count != positions.count)
				{
					attributes.fail(name, std::to_string(attribute(attributes, name, types).count) + " values",
									std::to_string(positions.count) + ", as many as positions");
				}
			};
			check("NORMAL", "VEC3");
			check("TANGENT", "VEC4");
			for (char set = '0'; set < '8'; ++set)
			{
				check(std::string("TEXCOORD_") + set, "VEC2");
			}
			check("COLOR_0", "VEC3 VEC4");
			check("JOINTS_0", "VEC4");
			check("WEIGHTS_0", "VEC4");
		}
		if (item.has("indices"))
		{
			const Accessor& indices = attribute(item, "indices", "SCALAR");
			failIf(!isIndex(indices.component), item, "indices",
				   "an accessor of component type " + std::to_string(indices.component), "5121, 5123 or 5125");
			m_used += indices.count;
		}
		// Primitives may share data: this many cost time and memory even before counting instances.
		failIf(m_used > 2 * kMaxVertices, item, "", std::to_string(m_used) + " vertices and indices of primitives so far",
			   "at most " + std::to_string(2 * kMaxVertices));
		for (const JsonValue& target : item.objects("targets"))
		{
			for (const char* const name : {"POSITION", "NORMAL", "TANGENT"})
			{
				target.index(name, m_accessors.size());
			}
		}
	}

	void meshes()
	{
		for (const JsonValue& mesh : m_root.objects("meshes"))
		{
			for (const JsonValue& item : mesh.objects("primitives"))
			{
				primitive(item);
			}
		}
	}

	void nodes()
	{
		const std::vector<JsonValue> items = m_root.objects("nodes");
		std::vector<std::vector<std::size_t>> children;
		std::vector<std::size_t>& parent = m_file.parents;
		parent.assign(items.size(), items.size());
		for (std::size_t i = 0; i < items.size(); ++i)
		{
			items[i].index("mesh", m_root.count("meshes"));
			items[i].index("camera", m_root.count("cameras"));
			items[i].index("skin", m_root.count("skins"));
			items[i].numbers("matrix", 16);
			items[i].numbers("translation", 3);
			items[i].numbers("rotation", 4);
			items[i].numbers("scale", 3);
			for (const std::size_t child : children.emplace_back(items[i].indices("children", items.size())))
			{
				failIf(parent[child] != items.size(), items[i], "children",
					   "node " + std::to_string(child) + ", already a child of node " + std::to_string(parent[child]),
					   "a tree, every node in it once");
				parent[child] = i;
			}
		}
		// Every node has at most one parent, so nodes unreachable from the roots form a cycle.
		std::vector<std::size_t> level = indicesWhere(items.size(), [&](std::size_t i) { return parent[i] == items.size(); });
		std::vector<bool> reached(items.size(), false);
		for (std::size_t depth = 0; !level.empty(); ++depth)
		{
			failIf(depth > kMaxDepth, items[level.front()], "", "more than " + std::to_string(kMaxDepth) + " nodes above it",
				   "a flatter tree");
			std::vector<std::size_t> below;
			for (const std::size_t i : level)
			{
				reached[i] = true;
				append(below, children[i]);
			}
			level = std::move(below);
		}
		const auto circle = static_cast<std::size_t>(std::find(reached.begin(), reached.end(), false) - reached.begin());
		if (circle < items.size())
		{
			items[circle].fail("children", "a circle of nodes", "a tree, every node in it once");
		}
	}

	void scenes() const
	{
		const std::size_t count = m_root.count("nodes");
		m_root.index("scene", m_root.count("scenes"));
		for (const JsonValue& scene : m_root.objects("scenes"))
		{
			std::vector<std::size_t> roots = scene.indices("nodes", count);
			for (const std::size_t root : roots)
			{
				std::size_t above = m_file.parents[root];
				while (above != count && std::find(roots.begin(), roots.end(), above) == roots.end())
				{
					above = m_file.parents[above];
				}
				if (m_file.parents[root] != count && above == count) // otherwise reached from its parent
				{
					scene.fail("nodes",
							   "node " + std::to_string(root) + ", a child of node " + std::to_string(m_file.parents[root]),
							   "nodes that have no parent, or one in the scene");
				}
			}
			std::sort(roots.begin(), roots.end());
			failIf(std::adjacent_find(roots.begin(), roots.end()) != roots.end(), scene, "nodes", "a node twice",
				   "every node once");
		}
		failIf(m_root.count("scenes") == 0, m_root, "scenes", "none", "a scene, that says which nodes are in the level");
	}

	GltfFile& m_file;
	JsonValue m_root;
	std::vector<uint64_t> m_buffers; // lengths
	std::vector<BufferView> m_views;
	std::vector<Accessor> m_accessors;
	uint64_t m_empty_bytes = 0;
	uint64_t m_buffer_bytes = 0;
	uint64_t m_used = 0; // vertices and indices of all primitives
};

} // namespace

GltfFile openGlb(std::string bytes, const std::string& path)
{
	GltfFile file;
	file.path = path;
	file.is_binary = true;
	file.text = takeChunks(std::move(bytes), file);
	parseText(file);
	return file;
}

GltfFile openGltf(const std::string& path)
{
	std::string text = readFile(path);
	if (endingOf(path) == ".glb")
	{
		return openGlb(std::move(text), path);
	}
	refuseInputIf(text.starts_with("glTF"), path + ": header", "a binary glTF", "the ending .glb of one, or text");
	GltfFile file;
	file.path = path;
	file.text = std::move(text);
	parseText(file);
	return file;
}

std::optional<std::string> dataOf(const std::string& uri, const JsonValue& item)
{
	if (!uri.starts_with("data:"))
	{
		return std::nullopt;
	}
	const std::size_t comma = uri.find(',');
	failIf(comma == std::string::npos || !std::string_view(uri).substr(0, comma).ends_with(";base64"), item, "uri",
		   "data that is not base64", "\"data:...;base64,...\"");
	std::string text = uri.substr(comma + 1);
	text.append((4 - text.size() % 4) % 4, '='); // some writers omit the padding
	const std::optional<std::vector<uint8_t>> bytes = bytesOfBase64(text);
	if (!bytes)
	{
		const std::size_t odd = std::min(uri.find_first_not_of(kBase64, comma + 1), uri.size());
		item.fail("uri", "character " + std::to_string(odd) + " that is not base64", "letters, digits, + and /");
	}
	return std::string(bytes->begin(), bytes->end());
}

std::string_view bufferBytes(GltfFile& file, std::size_t buffer, std::size_t offset, std::size_t length)
{
	const std::size_t count = file.root().count("buffers");
	const std::size_t first_decoded = count - file.decoded.size();
	if (buffer >= first_decoded)
	{
		return std::string_view(file.decoded[buffer - first_decoded]).substr(offset, length);
	}
	const JsonValue holder = file.root().item("buffers", buffer);
	if (!holder.has("uri"))
	{
		return std::string_view(file.chunk).substr(offset, length);
	}
	file.buffers.resize(first_decoded);
	std::optional<std::string>& bytes = file.buffers[buffer];
	if (!bytes)
	{
		const std::string uri = holder.text("uri");
		bytes = dataOf(uri, holder);
		bytes = bytes ? std::move(bytes) : readFile(besideLevel(file.path, unescaped(uri)));
	}
	failIf(bytes->size() < offset + length, holder, "uri", std::to_string(bytes->size()) + " bytes", "what it had a moment ago");
	return std::string_view(*bytes).substr(offset, length);
}

std::optional<JsonValue> extensionOf(const JsonValue& item, std::string_view name)
{
	const std::optional<JsonValue> extensions = item.object("extensions");
	return extensions ? extensions->object(name) : std::nullopt;
}

std::string_view viewBytes(GltfFile& file, std::size_t view)
{
	const JsonValue item = file.root().item("bufferViews", view);
	const auto index = static_cast<std::size_t>(item.at("buffer").whole(UINT32_MAX));
	const auto offset = static_cast<std::size_t>(item.whole("byteOffset", UINT32_MAX).value_or(0));
	const auto length = static_cast<std::size_t>(item.at("byteLength").whole(UINT32_MAX));
	return bufferBytes(file, index, offset, length);
}

void checkGltf(GltfFile& file)
{
	GltfChecker(file).run();
}

} // namespace nook
