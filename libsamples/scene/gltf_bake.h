// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the parts of bakeInto().
#pragma once

#include "scene/gltf_edit.h"

#include <map>
#include <set>
#include <span>
#include <string>
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

// Are its indices a list of triangles, of which other accessors can read a part?
bool hasList(GltfEditor& editor, const GltfEditor::Document& primitive);

// A number as one of that component type. `normalized`: 1 is the greatest integer.
void appendComponent(std::string& bytes, uint64_t component, double value, bool normalized);

// The meshes of nodes that have no values.
std::set<std::size_t> meshesOfOthers(GltfEditor& editor, const std::vector<MeshUnit>& units);

// Gives nodes meshes of their own.
class OwnMeshes
{
public:
	explicit OwnMeshes(GltfEditor& editor) : m_editor(editor)
	{
		for (const GltfEditor::Document& node : editor.items("nodes"))
		{
			m_users[numberIn(node, "mesh")] += 1;
		}
	}

	// A copy, unless it is the last node with that mesh.
	std::size_t meshOf(std::size_t node)
	{
		GltfEditor::Document& meshes = m_editor.items("meshes");
		const std::size_t mesh = numberIn(m_editor.items("nodes")[node], "mesh");
		if (!m_done.insert(node).second || m_users[mesh] == 1)
		{
			return mesh;
		}
		m_users[mesh] -= 1;
		copies += 1;
		m_editor.items("nodes")[node]["mesh"] = meshes.size();
		const GltfEditor::Document copy = meshes[mesh];
		meshes.push_back(copy);
		return meshes.size() - 1;
	}

	std::size_t copies = 0;

private:
	GltfEditor& m_editor;
	std::map<std::size_t, std::size_t> m_users; // nodes with each mesh
	std::set<std::size_t> m_done;               // nodes
};

// Gives the materials of units a texture of the bake, and primitives coordinates if it has charts. `set_of_material`: texture
// coordinates that were added; `parts` gets what primitives become that keep a rest. Returns the number of copies of meshes.
std::size_t addTextures(GltfEditor& editor, const GltfBake& bake, std::span<const GltfPlace> places,
						const std::vector<MeshUnit>& units, const std::map<std::size_t, int>& set_of_material,
						std::vector<GltfPlace>& parts);

// Throws for what addTextures() would.
void checkTextures(GltfEditor& editor, const GltfBake& bake, const std::vector<MeshUnit>& units);

} // namespace nook
