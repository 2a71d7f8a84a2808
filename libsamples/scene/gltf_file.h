// SPDX-License-Identifier: GPL-3.0-or-later
// The JSON and buffers of a .gltf or .glb file, complete and in range.
#pragma once

#include "core/json_reader.h"
#include "scene/load.h"
#include "scene/load_parts.h"
#include "scene/mesh_codec.h"

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nook
{

struct GltfFile
{
	std::string path;
	LoadSettings settings;
	std::optional<uint32_t> second_set; // texture coordinates to read in addition to each material's mask coordinates
	nlohmann::json json;
	std::string text;   // of the JSON
	std::string chunk;  // binary chunk of a .glb
	std::string others; // further chunks of a .glb, with their heads
	bool is_binary = false;
	bool has_chunk = false;
	std::vector<std::optional<std::string>> buffers; // contents of buffers other than the chunk, loaded on demand
	std::vector<std::string> decoded;                // contents of the last buffers, made by expandGltf()
	std::vector<std::string> files;                  // buffer files, besides `path`
	std::vector<std::size_t> parents;                // of the nodes, once they are checked; their number for those without one

	JsonValue root() const
	{
		JsonValue root{&json, &path, ""};
		root.requireObject();
		return root;
	}
};

// Reads the container and parses it. Throws Error: file, or invalid_input.
GltfFile openGltf(const std::string& path);

// Likewise for the contents of a .glb file.
GltfFile openGlb(std::string bytes, const std::string& path);

// Checks buffers, views, accessors, meshes, nodes and scenes: types, indices and ranges, no node twice in a tree, known extensions.
// Decompresses on the way.
// Missing and short buffer files are errors that name them.
void checkGltf(GltfFile& file);

// Takes an earlier bake out of the file's JSON. Returns its target, with the values still there, if the file has changed since.
std::string undoBake(GltfFile& file);

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

// Limit per file: each instance has a name, even with few triangles.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22U;

// The instances' transforms by EXT_mesh_gpu_instancing, relative to the node's own; none if the node has a single mesh. Throws
// Error (invalid_input) if attributes have types or counts that the extension does not allow, hold no numbers, or exceed `most`.
std::optional<std::vector<glm::dmat4>> instancesOf(GltfFile& file, const JsonValue& node, std::size_t most);

// Translation × rotation × scale; the rotation is normalised to a unit quaternion (x, y, z, w), or ignored if it is zero.
glm::dmat4 placeOf(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale);

// Appends a value as it lies in memory: glTF is little-endian, as every supported machine.
template <class Value> void appendRaw(std::string& bytes, const Value& value)
{
	bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Appends zeros up to a multiple of four bytes.
inline void padTo4(std::string& bytes)
{
	bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
}

// The numbers of an accessor of a checked glTF file: any component type, normalised or not, strided, sparse, or zeros.
class GltfValues
{
public:
	// Throws Error (invalid_input) if sparse indices are not ascending or exceed the count. The file must outlive this object.
	GltfValues(GltfFile& file, std::size_t accessor);

	std::size_t count() const
	{
		return m_count;
	}
	double number(std::size_t i, std::size_t component) const;
	glm::dvec2 vec2(std::size_t i) const;
	glm::dvec3 vec3(std::size_t i) const;
	uint32_t index(std::size_t i) const;                  // for unsigned integers
	void append(std::string& bytes, std::size_t i) const; // an element as it is stored

private:
	const char* elementAt(std::size_t i) const; // null: zeros

	std::size_t m_count = 0;
	uint64_t m_component = 0; // 5120 … 5126
	bool m_normalized = false;
	std::size_t m_size = 0; // element size in bytes
	std::size_t m_stride = 0;
	std::string_view m_bytes;           // from the first element; empty: zeros
	std::vector<uint32_t> m_replaced;   // indices replaced by a sparse accessor, ascending
	std::string_view m_replacing_bytes; // their values, packed
};

// Size of a component type (5120 to 5126) in bytes, and number of components of "SCALAR" to "MAT4"; 0 for anything else.
std::size_t bytesOfComponent(uint64_t component);
std::size_t componentsOf(std::string_view type);

// The shape of a node's mesh in the pose of a checked glTF file: default morph weights, and joints at their nodes' positions (glTF
// 2.0, sections 3.7.2.2 and 3.7.3.3).

// How a node poses its mesh.
struct NodePose
{
	std::vector<double> weights;                     // morph target weights; empty if all are zero
	const std::vector<glm::dmat4>* joints = nullptr; // joint matrices into the file's space; null: no skin
};

class GltfPoses
{
public:
	explicit GltfPoses(GltfFile& file) : m_file(file) {}

	// Throws Error (invalid_input) if a skin has no joints or too few matrices, or there is not one weight per target.
	NodePose poseOf(const JsonValue& node, const JsonValue& mesh, std::size_t targets);

private:
	const std::vector<glm::dmat4>& jointsOf(std::size_t skin);
	const glm::dmat4& worldOf(std::size_t node);

	GltfFile& m_file;
	std::vector<std::optional<glm::dmat4>> m_worlds;         // of the nodes that a skin needs
	std::map<std::size_t, std::vector<glm::dmat4>> m_joints; // for the used skins
};

// The arrays of a primitive that determine its pose.
struct PoseValues
{
	std::string where;                                                    // location of the primitive, for messages
	std::vector<std::pair<const GltfValues*, const GltfValues*>> targets; // positions and normals; null if absent
	std::vector<std::pair<const GltfValues*, const GltfValues*>> joints;  // JOINTS_n and WEIGHTS_n

	// Adds the morph targets' displacement to a vertex.
	void morph(const std::vector<double>& weights, std::size_t vertex, glm::dvec3& position, glm::dvec3& normal) const;

	// The mean of a vertex's joint matrices, by weights that need not sum to 1; the first joint's if all are zero. Throws Error
	// (invalid_input) for a joint that the skin does not have.
	glm::dmat4 skin(const std::vector<glm::dmat4>& joints, std::size_t vertex) const;
};

// Shared by the parts of readGltf().

// A node of the scene, or an instance of its mesh, with its world transform.
struct PlacedNode
{
	std::size_t index = 0;
	glm::dmat4 world{1.0};
	std::optional<std::size_t> instance; // instance number
	bool has_mesh = true;                // false: the node is hidden, or only its instances have the mesh
};

// The members of an item's "extras": "key=value".
std::vector<std::string> extrasOf(const JsonValue& item);

// The node's local transform.
glm::dmat4 localOf(const JsonValue& node);

// Appends the triangles of all nodes to `level` in order, and findings to `source`, whose materials must be read already.
void readMeshes(GltfFile& file, const std::vector<PlacedNode>& nodes, const glm::dmat4& world_from_file, LevelSource& source,
				Level& level);

} // namespace nook
