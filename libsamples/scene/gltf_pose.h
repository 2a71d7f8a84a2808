// SPDX-License-Identifier: GPL-3.0-or-later
// The shape of a node's mesh in the pose of a checked glTF file: default morph weights, and joints at their nodes' positions (glTF
// 2.0, sections 3.7.2.2 and 3.7.3.3).
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

	GltfFile& m_file;
	std::vector<glm::dmat4> m_worlds;                        // for all nodes; empty until a skin needs them
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

} // namespace nook
