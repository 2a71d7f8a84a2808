// SPDX-License-Identifier: GPL-3.0-or-later
// The region that rays of a given reach from a set of points can enter. Triangles elsewhere need no tree.
#pragma once

#include "scene/level.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nook
{

// A grid of cells over a level's bounds, about 1 MB. Conservative: may report too much, never too little.
class Vicinity
{
public:
	// `reach_m`: > 0, metres around every point. Requires the bounds of at least one triangle.
	Vicinity(const Bounds& bounds, double reach_m);

	// Call before count(). Points outside the bounds count as the nearest ones inside.
	void add(glm::dvec3 point);

	// Call after the last point.
	void count();

	// True if something in the box may be in reach. Requires count().
	bool touches(const Bounds& box) const;

private:
	glm::ivec3 cellOf(glm::dvec3 point) const;
	std::size_t placeOf(glm::ivec3 cell) const;

	Bounds m_bounds;
	double m_cell_m = 1.0;
	int m_reach_cells = 1;
	glm::ivec3 m_cells{1};
	std::array<std::size_t, 3> m_size{}; // of the sums: the cells, after one plane of zeros on each axis
	std::vector<uint32_t> m_sums; // at first 1 where there is a point; then the number of such cells that come no later on any axis
};

} // namespace nook
