// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the parts of bakeInto().
#pragma once

#include "core/image.h"
#include "scene/gltf_edit.h"

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

namespace nook
{

// A mesh with separate values: at one node, or at all.
struct MeshUnit
{
	std::size_t mesh = 0;
	std::vector<std::size_t> nodes;
	std::map<std::size_t, std::vector<const GltfPlace*>> primitives;
	std::map<std::size_t, std::size_t> groups; // per primitive
};

inline constexpr int kMostSet = 7; // of texture coordinates

inline std::string setName(int set)
{
	return "TEXCOORD_" + std::to_string(set);
}

int firstFreeSet(const GltfEditor::Document& attributes);

// A number as one of that component type. `normalized`: 1 is the greatest integer.
void appendComponent(std::string& bytes, uint64_t component, double value, bool normalized);

// The meshes of nodes that have no values.
std::set<std::size_t> meshesOfOthers(GltfEditor& editor, const std::vector<MeshUnit>& units);

// Gives nodes meshes of their own.
class OwnMeshes
{
public:
	explicit OwnMeshes(GltfEditor& editor);

	// A copy, unless it is the last node with that mesh.
	std::size_t meshOf(std::size_t node);

	std::size_t copies = 0;

private:
	GltfEditor& m_editor;
	std::map<std::size_t, std::size_t> m_users; // nodes with each mesh
	std::set<std::size_t> m_done;               // nodes
};

// Gives materials a texture of the bake.
class TextureBaker
{
public:
	TextureBaker(GltfEditor& editor, const GltfBake& bake) : m_editor(editor), m_bake(bake) {}

	// Throws for what add() would.
	void check(const std::vector<MeshUnit>& units);

	// Returns the copies of meshes. With charts, primitives get coordinates.
	std::size_t add(std::span<const GltfPlace> places, const std::vector<MeshUnit>& units);

	std::map<std::size_t, int> set_of_material; // texture coordinates that were added

private:
	using Document = GltfEditor::Document;

	Document& items(const char* name)
	{
		return m_editor.items(name);
	}
	Document& primitiveOf(std::size_t mesh, std::size_t primitive)
	{
		return items("meshes")[mesh]["primitives"][primitive];
	}

	std::size_t addImage(const std::string& name, std::string_view png);
	std::size_t textureOf(std::string_view png);
	std::size_t roughOf(std::size_t material);
	Image pictureOf(std::size_t texture);
	std::size_t withRed(std::size_t texture, std::string_view png);
	void setTexture(std::size_t material, std::string_view png, std::size_t set);
	std::size_t textured(std::size_t before, std::size_t page, std::string_view png, std::size_t set);
	std::size_t freeSet(const std::vector<MeshUnit>& units);
	void keepOthers(const std::vector<MeshUnit>& units);
	void addCharts(const MeshUnit& unit, std::size_t number, std::size_t mesh, const GltfCharts& charts, std::size_t set);

	GltfEditor& m_editor;
	const GltfBake& m_bake;
	std::size_t m_sampler = kNoNumber;                                      // of the textures
	std::map<std::pair<const char*, std::size_t>, std::size_t> m_textures;  // by picture and metallic-roughness texture
	std::map<std::pair<std::size_t, std::size_t>, std::size_t> m_materials; // by the one before and the page
	std::set<std::size_t> m_taken;                                          // materials that got a page, or stay as they are
	std::map<std::pair<std::size_t, std::size_t>, Document> m_split;        // primitives with added vertices
	std::map<std::tuple<std::size_t, std::size_t, std::vector<uint32_t>>, std::size_t> m_indices; // accessors
};

} // namespace nook
