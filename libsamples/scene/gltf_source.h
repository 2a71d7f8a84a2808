// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by the parts of readGltf().
#pragma once

#include "scene/gltf_file.h"
#include "scene/load_parts.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace nook
{

// A node of the scene, or an instance of its mesh, with its world transform.
struct PlacedNode
{
	std::size_t index = 0;
	glm::dmat4 world{1.0};
	std::optional<std::size_t> instance; // instance number
	bool has_mesh = true;                // false: the node is hidden, or only its instances have the mesh
};

// The node's local transform.
glm::dmat4 localOf(const JsonValue& node);

// Appends the triangles of all nodes to `level` in order, and findings to `source`, whose materials must be read already.
void readMeshes(GltfFile& file, const std::vector<PlacedNode>& nodes, const glm::dmat4& world_from_file, LevelSource& source,
				Level& level);

} // namespace nook
