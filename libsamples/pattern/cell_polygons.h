// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of cells, for drawing.
#pragma once

#include "pattern/pattern.h"

#include <glm/mat3x3.hpp>
#include <glm/vec2.hpp>

#include <vector>

namespace nook
{

using CellPolygon = std::vector<glm::dvec2>; // empty if the point has no cell

// Cells of the disk and of the hemisphere's projection, one per point, clipped to the unit circle (as a polygon of 192 sides).
std::vector<CellPolygon> planeCellPolygons(const Pattern& pattern);

// The ball's cells cut by the plane z = 0: a power diagram of the plane, |x − p|² = |x_xy − p_xy|² + p_z².
std::vector<CellPolygon> sectionPolygons(const Pattern& pattern);

// The sphere's cells that face the viewer, in parallel projection: the rows of `view` are the picture's x and y axes and the
// direction to the viewer. Great circles become chains of segments.
std::vector<CellPolygon> spherePolygons(const Pattern& pattern, const glm::dmat3& view);

} // namespace nook
