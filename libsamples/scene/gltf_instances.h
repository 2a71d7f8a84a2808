// SPDX-License-Identifier: GPL-3.0-or-later
// A node of a checked glTF file → where EXT_mesh_gpu_instancing places its mesh.
#pragma once

#include "scene/gltf_file.h"

#include <glm/mat4x4.hpp>

#include <optional>
#include <vector>

namespace nook
{

// At most so many in a file, each of which has a name, however few its triangles.
inline constexpr std::size_t kMaxInstances = std::size_t{1} << 22U;

// The instances' transforms, which the node's own come before; none where the node has one mesh in one place. Throws Error
// (invalid_input) where attributes have other types or counts than the extension allows, hold no numbers, or are more than `most`.
std::optional<std::vector<glm::dmat4>> instancesOf(GltfFile& file, const JsonValue& node, std::size_t most);

// Translation × rotation × scale; the rotation is made a unit quaternion (x, y, z, w), or none where it is zero.
glm::dmat4 placeOf(glm::dvec3 translation, glm::dvec4 rotation, glm::dvec3 scale);

} // namespace nook
