// SPDX-License-Identifier: GPL-3.0-or-later
// Triangulates the faces of a mesh, records their defects, and sends it.
#pragma once

#include "scene/load_parts.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nook
{

struct FileMesh
{
	std::string name;
	uint32_t material = 0;
	std::vector<glm::dvec3> positions;
	std::vector<glm::vec3> normals; // one per position, or none
	std::vector<glm::vec2> uvs;     // likewise
	std::vector<glm::vec3> colours; // likewise, linear
	std::vector<uint32_t> sources;  // number of each position in the file; none: as they follow each other
	std::vector<uint32_t> corners;  // indices of positions, face after face
	std::vector<uint32_t> ends;     // end of each face's corners
};

class FaceCutter
{
public:
	// Sends a mesh in metres, with v downward, as triangles (load_parts.h). `path`: names from the root to the mesh. A mirrored
	// mesh gets the reverse winding.
	//
	// A face with fewer than three corners counts as a line; with an index out of range or a non-finite position it becomes one
	// triangle that the level drops and counts.
	void send(const FileMesh& mesh, const std::vector<std::string>& path, bool mirrored, ValueWriter& to);

	Tally lines; // over all meshes
	Tally bad_polygons;

private:
	void add(std::span<const uint32_t> corners, const FileMesh& mesh);
	void addPolygon(std::span<const uint32_t> corners, const FileMesh& mesh);

	std::vector<glm::uvec3> m_triangles; // of the mesh
};

// Triangulates a polygon in space using its own corners; supports concave ones and holes connected by bridges.

// Appends triangles, as indices into `corners`, with the polygon's winding. Requires at least 3 finite corners. False if the
// polygon has no area or runs out of ears, like most self-intersecting ones: some triangles are then a guess. O(n · reflex
// corners).
bool triangulate(std::span<const glm::dvec3> corners, std::vector<glm::uvec3>& triangles);

} // namespace nook
