// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of one mesh → triangles, and what was wrong with them.
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
	// Starts the triangles of a mesh. `positions` must outlive its faces.
	void start(std::string name, std::span<const glm::dvec3> positions, bool mirrored);

	// A face by its corners, indices into the positions. One with fewer than three is counted as a line; one with an index out of
	// range, or with a position that is not finite, becomes one triangle that the level drops and counts.
	void add(std::span<const uint32_t> corners);

	std::vector<glm::uvec3> triangles; // of the mesh, wound the other way round where it is mirrored
	Tally lines;                       // of all meshes
	Tally bad_polygons;

private:
	void addPolygon(std::span<const uint32_t> corners);

	std::string m_name;
	std::span<const glm::dvec3> m_positions;
	bool m_mirrored = false;
	std::vector<glm::dvec3> m_corners; // of a polygon
};

} // namespace nook
