// SPDX-License-Identifier: GPL-3.0-or-later
// A node of a checked glTF file → the shape its mesh has in the file's pose: default morph weights, and joints where their nodes
// stand (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
#pragma once

#include "scene/gltf_file.h"
#include "scene/gltf_values.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace nook
{

// How a node poses its mesh.
struct NodePose
{
	std::vector<double> weights;                     // of morph targets; empty where all are zero
	const std::vector<glm::dmat4>* joints = nullptr; // joint matrices into the file's space; null: no skin
};

class GltfPoses
{
public:
	explicit GltfPoses(GltfFile& file) : m_file(file) {}

	// Throws Error (invalid_input) where a skin has no joint or too few matrices, or weights are not one per target.
	NodePose poseOf(const JsonValue& node, const JsonValue& mesh, std::size_t targets);

private:
	const std::vector<glm::dmat4>& jointsOf(std::size_t skin);

	GltfFile& m_file;
	std::vector<glm::dmat4> m_worlds;                        // of all nodes; empty until a skin asks
	std::map<std::size_t, std::vector<glm::dmat4>> m_joints; // of the skins in use
};

// The arrays of a primitive that poses move its vertices by.
struct PoseValues
{
	std::string where;                                                    // the primitive, for messages
	std::vector<std::pair<const GltfValues*, const GltfValues*>> targets; // positions and normals; null where one has none
	std::vector<std::pair<const GltfValues*, const GltfValues*>> joints;  // JOINTS_n and WEIGHTS_n

	// Adds what the morph targets move a vertex by.
	void morph(const std::vector<double>& weights, std::size_t vertex, glm::dvec3& position, glm::dvec3& normal) const;

	// The mean of a vertex's joint matrices by its weights, which need not sum to 1; the first joint's where all are zero.
	// Throws Error (invalid_input) where a joint is not one of the skin's.
	glm::dmat4 skin(const std::vector<glm::dmat4>& joints, std::size_t vertex) const;
};

} // namespace nook
