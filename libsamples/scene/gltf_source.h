// SPDX-License-Identifier: GPL-3.0-or-later
// Between the parts of readGltf().
#pragma once

#include "scene/gltf_file.h"
#include "scene/load_parts.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace nook
{

// A node of the scene, or an instance of its mesh, and where it stands, by the transforms of all above it.
struct PlacedNode
{
	std::size_t index = 0;
	glm::dmat4 world{1.0};
	std::optional<std::size_t> instance; // of the node
	bool has_mesh = true;                // false: the node is hidden, or of its mesh the instances alone are there
};

// The node's own transform.
glm::dmat4 localOf(const JsonValue& node);

// Triangles of all nodes into `level`, in their order; findings into `source`, whose materials are read already.
void readMeshes(GltfFile& file, const std::vector<PlacedNode>& nodes, const glm::dmat4& world_from_file, LevelSource& source,
				Level& level);

} // namespace nook
