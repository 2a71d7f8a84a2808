// SPDX-License-Identifier: GPL-3.0-or-later
// A Geometry of an FBX file → points, polygons and what lies at their corners; and the pose that its skins and blend shapes give
// it.
#pragma once

#include "scene/fbx_objects.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

// Values at the corners of a mesh.
struct FbxLayer
{
	enum class By
	{
		corner,
		point,
		polygon,
		all,
		other, // edges, or nothing that is known: no value anywhere
	};
	std::string name;
	By by = By::other;
	std::vector<double> values;   // some numbers for each element
	std::vector<int64_t> indices; // of elements; empty: one after the other

	// The element at a corner of the mesh that is at a point and of a polygon; none where the layer has none. `width`: numbers of
	// an element.
	std::optional<std::size_t> elementAt(std::size_t corner, std::size_t point, std::size_t polygon, std::size_t width) const;
};

struct FbxMesh
{
	std::vector<glm::dvec3> points;
	std::vector<uint32_t> corners; // points, of one polygon after the other; may be out of range
	std::vector<std::size_t> ends; // of each polygon's corners
	FbxLayer normals;
	FbxLayer materials;        // one number for each element: which of the node's materials
	std::vector<FbxLayer> uvs; // the first is the default
};

// Throws Error (invalid_input).
FbxMesh readFbxMesh(const FbxObjects& objects, const FbxObject& geometry);

// Its materials alone.
FbxLayer readFbxMaterials(const FbxObjects& objects, const FbxObject& geometry);

// True where its shape depends on skins, or on blend shapes that have a weight.
bool isPosed(const FbxObjects& objects, const FbxObject& geometry);

// Moves the points as blend shapes say, their normals' changes into `turned` (empty: none). Then returns what places each point
// where the skin has it, in the file's units and axes; empty where there is no skin. `place`: of the node that shows the mesh;
// `worlds`: of each object that is a node.
std::vector<glm::dmat4> poseFbxMesh(const FbxObjects& objects, const FbxObject& geometry, const FbxPlace& place,
									const std::vector<const FbxPlace*>& worlds, std::vector<glm::dvec3>& points,
									std::vector<glm::dvec3>& turned);

} // namespace nook
