// SPDX-License-Identifier: GPL-3.0-or-later
// Triangulates a polygon with holes.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace nook
{

using Contour = std::vector<glm::dvec2>;

// Indices into the points of all contours in a row; every triangle is counter-clockwise. The first contour is the outline,
// counter-clockwise; the others are holes, clockwise. Contours must not touch each other or themselves, nor contain three
// consecutive collinear points.
std::vector<glm::uvec3> triangulateContours(const std::vector<Contour>& contours);

// Points of an arc including both ends; clockwise if `to_rad` is smaller.
Contour arcOf(glm::dvec2 centre, double radius, double from_rad, double to_rad, int steps);

Contour rectangleOf(glm::dvec2 least, glm::dvec2 most);

// Reverses a contour.
Contour holeOf(Contour contour);

void append(Contour& contour, const Contour& points);

} // namespace nook
