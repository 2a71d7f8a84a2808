// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a Geometry of an FBX file: points, polygons, corner attributes, and its pose from skins and blend shapes.
#pragma once

#include "core/value_stream.h"
#include "scene/fbx_objects.h"
#include "scene/load.h"

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
		other, // edges or unknown: no values
	};
	std::string name;
	By by = By::other;
	std::vector<double> values;   // several numbers per element
	std::vector<int64_t> indices; // element indices; empty: consecutive

	// The element for a corner of the mesh, given its point and polygon; none if the layer has none. `width`: numbers per element.
	std::optional<std::size_t> elementAt(std::size_t corner, std::size_t point, std::size_t polygon, std::size_t width) const;
};

struct FbxMesh
{
	std::vector<glm::dvec3> points;
	std::vector<uint32_t> corners; // point indices, polygon after polygon; may be out of range
	std::vector<std::size_t> ends; // end of each polygon's corners
	FbxLayer normals;
	FbxLayer materials;        // one number per element: index into the node's materials
	std::vector<FbxLayer> uvs; // the first is the default
};

// Throws Error (invalid_input).
FbxMesh readFbxMesh(const FbxObjects& objects, const FbxObject& geometry);

// Reads only its materials.
FbxLayer readFbxMaterials(const FbxObjects& objects, const FbxObject& geometry);

// True if its shape depends on skins, or on blend shapes with non-zero weight.
bool isPosed(const FbxObjects& objects, const FbxObject& geometry);

// Applies blend shapes to the points and stores the change of their normals in `turned` (empty: none). Then returns the skinning
// transform of each point in the file's units and axes; empty without a skin. `place`: the node that shows the mesh; `worlds`: for
// each object that is a node.
std::vector<glm::dmat4> poseFbxMesh(const FbxObjects& objects, const FbxObject& geometry, const FbxPlace& place,
									const std::vector<const FbxPlace*>& worlds, std::vector<glm::dvec3>& points,
									std::vector<glm::dvec3>& turned);

// Reads an FBX file and sends what readGeometry() expects (load_parts.h). Throws Error.
void sendFbx(const std::string& path, const LoadSettings& settings, ValueWriter& to);

} // namespace nook
