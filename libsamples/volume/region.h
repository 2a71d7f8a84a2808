// SPDX-License-Identifier: GPL-3.0-or-later
// One side of an occluder polygon → the region in which it may darken, and which triangles reach into it. In double, and on the
// safe side: what is only just outside counts as inside.
#pragma once

#include "scene/level.h"
#include "volume/triangle_tree.h"
#include "volume/volumes.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace nook
{

// Receivers no further than this share of δ from a polygon's plane get nothing from it.
inline constexpr double kPlaneBias = 1e-4;

// A polygon counts as above a tangent plane where it rises by more than this share of δ. A polygon that rises less and lies
// kPlaneBias · δ or more away fills at most the lowest 0.01 rad of the hemisphere: a form factor of at most sin² 0.01 = 1e-4.
inline constexpr double kRise = 1e-6;

struct VolumeRegion
{
	std::array<HalfSpace, kMaxOccluderCorners + 2> halves;
	std::size_t count = 0;
	Bounds box;
	double distance_m = 1.0; // δ

	std::span<const HalfSpace> planes() const
	{
		return {halves.data(), count};
	}
};

// Of the side that `front` (unit, perpendicular to the polygon) points to; corners counter-clockwise seen from `winding`, which is
// front or −front. Unless exact, no further than 2δ from the nearest corner on each axis (prism.h).
VolumeRegion regionOf(std::span<const glm::dvec3> corners, glm::dvec3 front, glm::dvec3 winding, double distance_m,
					  bool exact_bounds);

// True where some point of the triangle is in the region.
bool reaches(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle);

// That part of the triangle, a convex polygon: appended to `corners`, none where there is none. Says how many.
std::size_t partWithin(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle, std::vector<glm::dvec3>& corners);

// A side of a triangle as it receives.
struct ReceiverSide
{
	std::array<glm::dvec3, 3> corners;
	glm::dvec3 flat{0.0};               // unit
	std::array<glm::dvec3, 3> smooth{}; // of the vertices, turned to this side; 0 where there is none
	bool has_smooth = false;
	bool mixed = false; // they do not agree on a side: nothing is known of what lies between
};

// `side`: 0 its front, 1 its back. False for a triangle without area.
bool receiverSide(const Level& level, uint32_t triangle, int side, bool smooth_normals, ReceiverSide& receiver);

// By how many metres the polygon's highest corner is above the tangent plane of any point of the triangle; an upper bound with
// interpolated normals: for n = Σ bᵢ nᵢ at x = Σ bⱼ pⱼ, n · (c − x) is a quadratic form of the weights b, at most the greatest of
// its Bernstein coefficients ½ (nᵢ·(c − pⱼ) + nⱼ·(c − pᵢ)), and n is at least as long as the least √(nᵢ·nⱼ). 1e300 where nothing is
// known.
double riseOf(std::span<const glm::dvec3> polygon, const ReceiverSide& receiver);

// At least g · form factor (AOV eqs. 4 and 5, with alpha) at any point of that triangle within the region, for a polygon of that
// area that rises by `rise_m`.
double greatestShare(const VolumeRegion& region, std::span<const glm::dvec3> polygon, double area_m2, double alpha,
					 const ReceiverSide& receiver, double rise_m);

} // namespace nook
