// SPDX-License-Identifier: GPL-3.0-or-later
// Triangulates the faces of a mesh and records their defects.
#pragma once

#include "scene/load_parts.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace nook
{

class FaceCutter
{
public:
	// Begins a mesh. `positions` must outlive its faces.
	void start(std::string name, std::span<const glm::dvec3> positions, bool mirrored);

	// A face given by its corners, indices into the positions. With fewer than three corners it counts as a line; with an index out
	// of range or a non-finite position it becomes one triangle that the level drops and counts.
	void add(std::span<const uint32_t> corners);

	std::vector<glm::uvec3> triangles; // of the mesh, with reversed winding if it is mirrored
	Tally lines;                       // over all meshes
	Tally bad_polygons;

private:
	void addPolygon(std::span<const uint32_t> corners);

	std::string m_name;
	std::span<const glm::dvec3> m_positions;
	bool m_mirrored = false;
	std::vector<glm::dvec3> m_corners; // of a polygon
};

// Triangulates a polygon in space using its own corners; supports concave ones and holes connected by bridges.

// Appends triangles, as indices into `corners`, with the polygon's winding. Requires at least 3 finite corners. False if the
// polygon has no area or runs out of ears, like most self-intersecting ones: some triangles are then a guess. O(n · reflex
// corners).
bool triangulate(std::span<const glm::dvec3> corners, std::vector<glm::uvec3>& triangles);

} // namespace nook
