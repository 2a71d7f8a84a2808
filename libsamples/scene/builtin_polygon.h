// SPDX-License-Identifier: GPL-3.0-or-later
// A polygon with holes → triangles.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <vector>

namespace nook
{

using Contour = std::vector<glm::dvec2>;

// Indices into the contours' points, one contour behind the other; every triangle counter-clockwise. The first contour is the
// outline, counter-clockwise, the others are holes, clockwise; none may touch another or itself, and no three points in a row may
// lie on a line.
std::vector<glm::uvec3> triangulateContours(const std::vector<Contour>& contours);

// Points of an arc, both ends included; clockwise where `to_rad` is the smaller.
Contour arcOf(glm::dvec2 centre, double radius, double from_rad, double to_rad, int steps);

Contour rectangleOf(glm::dvec2 least, glm::dvec2 most);

// The other way round.
Contour holeOf(Contour contour);

void append(Contour& contour, const Contour& points);

} // namespace nook
