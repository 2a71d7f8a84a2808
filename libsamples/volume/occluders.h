// SPDX-License-Identifier: GPL-3.0-or-later
// A level's triangles → the convex polygons that block light: neighbours in one plane are merged, so that a wall is a few polygons
// however finely it is tessellated.
#pragma once

#include "core/progress.h"
#include "scene/level.h"
#include "volume/volumes.h"

#include <cstdint>
#include <functional>

namespace nook
{

enum class Sides
{
	automatic, // opaque surfaces, consistently wound and closed (but for small holes), with their fronts outside, are oriented;
			   // all others two-sided
	oriented,  // every polygon darkens what lies before its front alone
	two_sided,
};

struct OccluderSettings
{
	double distance_m = 1.0; // δ: what "flat" and `detail` are measured by; > 0, finite
	bool merge = true;       // else one polygon a triangle, as AOV has it
	Sides sides = Sides::automatic;
	double flat = 1e-4; // corners may lie this far off a polygon's plane or outline, as a share of δ; 1e-6 to 0.05
	double extent =
		2.0; // merged polygons longer than this share of δ are cut in halves (twice or more times that share where there
	// would be over a quarter more of them); 0: none; at least 0.1. Smaller ones fall
	// off sideways, too, which is nearer to a falloff with distance: with 2 merged polygons are nearer to rays
	// than AOV's triangles are, and no more of them act on a point than uncut (within a tenth)
	bool extent_always = false; // `extent` as it is, however many polygons that makes
	double detail = 0.0; // opaque oriented surfaces are simplified first, by about this share at most of δ; 0: not; below 1. Not
						 // those with two sides: where a proxy lies before them, they would be its receivers
	std::function<void(uint64_t)> before_cutting{}; // told how many polygons at most `extent` makes; may throw
};

struct OccluderCounts
{
	uint64_t triangles = 0;  // of the level
	uint64_t proxies = 0;    // triangles left after simplification; as many where there is none
	uint64_t polygons = 0;   // of the result
	uint64_t two_sided = 0;  // of those
	uint64_t corners = 0;    // of those
	uint64_t regions = 0;    // flat pieces; a triangle without a neighbour in its plane is one
	uint64_t with_holes = 0; // regions with an outline of more than one loop
	uint64_t fallbacks = 0;  // regions that overlap themselves: their triangles were joined as long as they are convex
	uint64_t duplicates = 0; // triangles dropped: the same corners as another's of the same kind
	uint64_t reversed = 0;   // triangles dropped: the back of another's
	uint64_t thin = 0;       // triangles dropped: no area
	uint64_t uncut = 0;      // polygons before those that are too long were cut
	uint64_t clear = 0;      // polygons dropped: masks let all light through
	uint64_t components = 0; // pieces of surface joined by edges
	uint64_t closed =
		0; // of those: every edge has as many triangles one way as the other, or slits without area are all that is open
	uint64_t sealed = 0;      // of those: not closed, but their holes have at most a hundredth of their area
	double extent_m = 0.0;    // what merged polygons were cut to, infinite: none was; 0: not asked for
	double deviation_m = 0.0; // greatest distance that simplification moved the surface by, as it was bounded there
};

struct Occluding
{
	Occluders occluders;
	OccluderCounts counts;
};

// Triangles join where they share an edge exactly (positions are compared bit by bit), run along it in opposite ways, are of one
// kind (opaque; or one masked material with one map of texture coordinates), have the same sides and lie in one plane within
//     max(flat · δ, min(4 ulp of a 32-bit float at the coordinates, 1e-4 δ)),
// for two-sided polygons at most δ/20000: on the surface itself, a receiver is then within the evaluator's bias of the plane.
// What comes out depends on the flat region alone, not on its triangles: outlines lose corners that lie as near to the line between
// others. ᾱ of a masked polygon: the share of its own area that passes the cut-off (as rays take it, isSolidAt), from 64 to 1024
// even samples. Same bytes for any thread count. Throws Error: invalid_input where no polygon is left; runtime where
// cutting makes more polygons than 32-bit numbers count the corners of.
Occluding occludersOf(const Level& level, const OccluderSettings& settings, const RunSettings& run);

} // namespace nook
