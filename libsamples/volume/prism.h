// SPDX-License-Identifier: GPL-3.0-or-later
// A polygon → the closed convex volume in which it darkens (AOV §5.2, eqs. 9 to 13).
#pragma once

#include "volume/volumes.h"

#include <glm/vec3.hpp>

#include <span>
#include <vector>

namespace nook
{

struct VolumeShape
{
	double distance_m = 1.0;   // δ, > 0
	bool two_sided = false;    // from δ behind the polygon to δ in front, else from its plane to δ in front
	bool exact_bounds = false; // no point with a falloff > 0 lies outside
	double side_share = 1.0;   // of δ: how far it goes beyond the polygon's edges, > 0
};

// Twice as many points as corners, in world space: the ring in the lower plane, then, in the same order, the ring in the upper
// one. `front`: unit normal of the polygon. Faces made of them (ring, quads, ring) are outward, convex and not degenerate.
// Requires a convex polygon of at least three corners.
void prismOf(std::span<const glm::dvec3> corners, glm::dvec3 front, const VolumeShape& shape, std::span<glm::dvec3> points);

// Of one of a set's polygons.
VolumeShape shapeOf(const VolumeSet& volumes, const Occluder& polygon);

// Unit normal of a polygon's front by Newell's sum; zero for one without area.
glm::dvec3 frontOf(std::span<const glm::dvec3> corners);

} // namespace nook
