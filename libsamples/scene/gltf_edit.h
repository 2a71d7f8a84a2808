// SPDX-License-Identifier: GPL-3.0-or-later
// Edits a glTF file and leaves everything else in it as it is; adds baked values to it.
#pragma once

#include "scene/gltf_file.h"
#include "scene/level_glb.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::size_t kNoNumber = SIZE_MAX;

// A member that is an index or a count, or a text; `otherwise` or "" for anything else.
std::size_t numberIn(const nlohmann::ordered_json& item, const std::string& field, std::size_t otherwise = kNoNumber);
std::string textIn(const nlohmann::ordered_json& item, const char* field);

// The members of a file in their order, without an earlier bake, decompressed, and in one buffer if its form changes.
class GltfEditor
{
public:
	using Document = nlohmann::ordered_json;

	// `output`: a name that says the form of the file to make. Throws Error: unsupported for asset.extras that are no object; like
	// checkGltf().
	GltfEditor(const GltfFile& of, const std::string& output);

	[[noreturn]] void fail(const std::string& where, const std::string& found, const std::string& expected,
						   ExitCode code = ExitCode::invalid_input) const;

	// A list of the document, made if it is missing, which may move others.
	Document& items(const char* name);
	Document& primitiveOf(std::size_t mesh, std::size_t primitive)
	{
		return items("meshes")[mesh]["primitives"][primitive];
	}

	// Return the index. Accessors go to a view of elements of their size, and indices to one of theirs.
	std::size_t addView(Document view, std::string_view bytes);
	std::size_t addAccessor(const std::string& type, uint64_t component, std::size_t count, const std::string& bytes,
							bool is_indices = false);
	std::size_t bytesAdded() const;

	// Makes what was added readable through `file`.
	void settle();

	// The file's bytes, with a record of the bake that allows to undo it (null: none). Call once.
	std::string take(const std::string& output, const Document& record);

	GltfFile file;
	Document json;
	std::string compression; // that the file had
	std::string earlier;     // target of an earlier bake that is still there

private:
	void decompress();
	void setBounds(std::size_t accessor);
	void gather();
	void placeViews();
	void rebase(const std::string& output);
	std::string& chunk();

	Document m_before; // to undo the bake
	bool m_to_binary = false;
	bool m_has_lines = false;                          // the file's JSON
	std::optional<std::string> m_gathered;             // the only buffer
	std::size_t m_view_before = 0;                     // views of the file
	std::size_t m_settled_bytes = 0;                   // of views that were added and settled
	std::vector<std::string> m_added;                  // bytes of the views behind them
	std::map<std::size_t, std::size_t> m_view_of_size; // of elements of that size
};

inline constexpr const char* kBakedImage = "visibility"; // name of the images of textures

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

// Vertices that are added to a primitive: each is the mean of two earlier ones, or a copy if both are the same.
using VertexPairs = std::vector<std::pair<uint32_t, uint32_t>>;

// Gives a primitive further vertices in all attributes and morph targets. Unit vectors keep their length, a vertex has the joints
// with the largest weights, and integers of custom attributes are those of the first vertex.
// `alone`: without the vertices that it had.
void addVertices(GltfEditor& editor, nlohmann::ordered_json& primitive, const VertexPairs& added, bool alone = false);

// Splits triangles at the middles of edges, in copies of meshes that other nodes have as well. Triangles before and after it;
// `places` get the added vertices. Returns the number of copies. Not for instances, which share triangles.
struct GltfSplit
{
	const LevelSplit* how = nullptr; // null: none
	std::span<const glm::uvec3> before{};
	std::span<const glm::uvec3> after{};
	std::size_t vertices = 0; // before
};
std::size_t splitTriangles(GltfEditor& editor, std::vector<GltfPlace>& places, const GltfSplit& split);

// How a primitive is split between charts of a texture: the vertices that the file has stay, copies follow them.
struct GltfCharts
{
	using Numbers = std::vector<std::pair<uint32_t, uint32_t>>; // of vertices: in the primitive, and in the level

	VertexPairs copied;                       // the vertex that each further one copies, twice
	std::vector<glm::vec2> uvs;               // of all
	std::vector<std::vector<uint32_t>> pages; // indices of the triangles on each page of the texture

	// For a bake of values as well: the triangles on pages leave the primitive, with arrays of the copies alone, and the rest
	// stays.
	std::vector<uint32_t> rest{};
	Numbers rest_vertices{};
	std::vector<Numbers> page_vertices{};
};

struct GltfBake : GlbBake
{
	BakeTarget target = BakeTarget::visibility;
	std::string attribute; // of BakeTarget::texcoord and custom: TEXCOORD_2, _AO
	BakeInstances instances = BakeInstances::separate;
	std::optional<uint32_t> uv_set; // coordinates in the file that `png` uses, in place of `uvs`
	std::vector<GltfCharts> charts; // for each place; a set of coordinates for them, and a page of the texture each. With
									// `visibility`: at places without `uvs` everything stays
	std::vector<std::string> pages; // of the texture, as PNG
	GltfSplit split;                // the values belong to the triangles after it
	bool in_red = false;            // textures go into the red channel of the materials' metallic-roughness textures
	bool others_stay = false;       // nodes without a place keep their meshes without values
	nlohmann::ordered_json record;  // asset.extras.nook: what was baked and how, "to" for the target; null: none
};

struct GltfBaked
{
	std::vector<std::string> files; // one for each output
	std::vector<GltfPlace> places;  // with the vertices that a split added
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

// Throws as bakeInto() does for what depends on the file alone, before there are values. `bake.charts`: not empty for charts.
void checkTarget(const GltfFile& file, std::span<const GltfPlace> places, const GltfBake& bake);

// A place's primitive: its bytes per vertex, and whether a part of its triangles can be drawn without new indices.
struct GltfCost
{
	std::size_t vertex_bytes = 0; // in all its arrays
	bool has_list = false;        // it has indices of a list of triangles: runs of them can be drawn
};
std::vector<GltfCost> costsOf(const GltfFile& file, std::span<const GltfPlace> places);

// The triangles that remain of a list: long runs of them, first and number, in order; and numbers of the others, which need new
// indices.
struct TriangleRuns
{
	std::vector<std::pair<std::size_t, std::size_t>> runs;
	std::vector<std::size_t> others;
};
TriangleRuns runsOf(const std::vector<bool>& remains);

// asset.extras.nook of a .gltf or .glb file; null without a bake, and for other files.
nlohmann::ordered_json bakeRecordOf(const std::string& path);

// Values of each place's vertices in the order of the file, 1 for vertices without: as .csv, .json or .npy. A vertex of the file
// that is several of the level's has their mean.
std::string placeValues(std::span<const GltfPlace> places, std::span<const float> front, std::span<const float> back,
						const std::string& ending);

} // namespace nook
