// SPDX-License-Identifier: GPL-3.0-or-later
// Where rays of a given reach may go: points, and all that is not further from one of them. What lies elsewhere needs no tree.
#pragma once

#include "scene/level.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace nook
{

// Cells over a level's bounds, about 1 MB of them. Says too much at times, never too little.
class Vicinity
{
public:
	// `reach_m`: > 0, metres around every point. Requires bounds of at least one triangle.
	Vicinity(const Bounds& bounds, double reach_m);

	// Before count(). Points outside the bounds count as the nearest within.
	void add(glm::dvec3 point);

	// After the last point.
	void count();

	// Whether something within the bounds of a box may be near. After count().
	bool touches(const Bounds& box) const;

private:
	glm::ivec3 cellOf(glm::dvec3 point) const;
	std::size_t placeOf(glm::ivec3 cell) const;

	Bounds m_bounds;
	double m_cell_m = 1.0;
	int m_reach_cells = 1;
	glm::ivec3 m_cells{1};
	std::array<std::size_t, 3> m_size{}; // of the sums: the cells, after one plane of zeros on each axis
	std::vector<uint32_t> m_sums; // first: 1 where there is a point; then: cells with points in all that come no later on any axis
};

} // namespace nook
