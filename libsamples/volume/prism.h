// SPDX-License-Identifier: GPL-3.0-or-later
// The closed convex volume that a polygon darkens (AOV §5.2, eqs. 9 to 13).
#pragma once

#include "volume/volumes.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace nook
{

struct VolumeShape
{
	double distance_m = 1.0;   // δ, > 0
	bool two_sided = false;    // extends from δ behind the polygon to δ in front; else from its plane to δ in front
	bool exact_bounds = false; // contains all points with a falloff > 0
	double side_share = 1.0;   // extent beyond the polygon's edges relative to δ, > 0
};

// Twice as many points as corners, in world space: the ring in the lower plane, then, in the same order, the ring in the upper one.
// `front`: unit normal of the polygon. The faces made from them (ring, quads, ring) are outward, convex and not degenerate.
// Requires a convex polygon of at least three corners.
void prismOf(std::span<const glm::dvec3> corners, glm::dvec3 front, const VolumeShape& shape, std::span<glm::dvec3> points);

// Shape of a polygon in a set.
VolumeShape shapeOf(const VolumeSet& volumes, const Occluder& polygon);

// Unit normal of a polygon's front by Newell's sum; zero without area.
glm::dvec3 frontOf(std::span<const glm::dvec3> corners);

} // namespace nook

namespace nook::detail
{

// Halves a convex, flat polygon along or across its longest edge until pieces are at most `longest_m` long in both directions and
// have at most `most_corners` ≥ 4 corners. The pieces cover the polygon; those without area are dropped.
std::vector<std::vector<glm::dvec3>> halvedPolygon(std::span<const glm::dvec3> corners, double longest_m, std::size_t most_corners);

// Upper bound of the number of pieces.
double halvesOf(std::span<const glm::dvec3> corners, double longest_m);

} // namespace nook::detail
