// SPDX-License-Identifier: GPL-3.0-or-later
// Merges a level's triangles into the convex polygons that block light, so that a wall is a few polygons regardless of its
// tessellation.
#pragma once

#include "core/progress.h"
#include "scene/level.h"
#include "volume/volumes.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace nook
{

class Tracer;

enum class Sides
{
	automatic, // opaque surfaces that are consistently wound and closed (up to `holes`), with fronts outside, are oriented, unless
			   // seen from inside; others are two-sided
	oriented,  // every polygon darkens only what lies in front of it
	two_sided,
};

struct OccluderSettings
{
	double distance_m = 1.0; // δ: unit of `flat` and `detail`; > 0, finite
	bool merge = true;       // else one polygon per triangle, as in AOV
	Sides sides = Sides::automatic;
	// Share of a surface's area that its holes may have if it counts as closed (slits have none): a scanned figure stays below it,
	// a vase's mouth is above. Backs that show through holes need 0, which suits masks; sums count the back of a thin wall twice.
	double holes = 0.01;
	double flat = 1e-4; // corners may deviate from a polygon's plane or outline by this fraction of δ; 1e-6 to 0.05
	// Merged polygons longer than this multiple of δ are halved until shorter; 0: never; at least 0.1. The limit is doubled,
	// repeatedly if needed, while that makes over a quarter more polygons. Smaller polygons also fall off sideways, closer to a
	// falloff with distance: with 2, merged polygons are closer to rays than AOV's triangles, and no more of them act on a point
	// (within a tenth).
	double extent = 2.0;
	bool extent_always = false; // apply `extent` regardless of the number of polygons
	double detail = 0.0;  // simplify opaque oriented surfaces first, by at most about this fraction of δ; 0: off; below 1. Not
						  // those with two sides that count: in front of them, proxies would have them as receivers
	int gap_halvings = 0; // polygons with alpha masks are halved along their longer axis (squares along both) up to this often to
						  // separate leaves from gaps, whose mean coverage would let light through everywhere alike
	const Tracer* tracer = nullptr;    // of the level, with `detail`: leaves out folds and steps that only simplification made
	std::vector<uint8_t> one_sided{};  // with `detail` and Sides::automatic, per level triangle: not 0 if backs are idle
									   // (idleBacks), so that it is oriented although not closed; 0: it is not simplified; empty:
									   // closed surfaces are
	std::vector<uint8_t> seen_backs{}; // with Sides::automatic, per level triangle: not 0 if it is two-sided although closed, since
									   // cameras look into it (seenBacks); empty: none
	std::function<void(uint64_t)> before_cutting{}; // called with an upper bound of the polygons after cutting; may throw
};

struct OccluderCounts
{
	uint64_t triangles = 0;   // in the level
	uint64_t proxies = 0;     // triangles after simplification; unchanged without it
	uint64_t polygons = 0;    // in the result
	uint64_t two_sided = 0;   // two-sided polygons
	uint64_t corners = 0;     // corners of all polygons
	uint64_t regions = 0;     // flat pieces; a triangle without coplanar neighbours is one
	uint64_t with_holes = 0;  // regions whose outline has several loops
	uint64_t fallbacks = 0;   // regions that overlap themselves; their triangles were joined while convex
	uint64_t duplicates = 0;  // triangles dropped: same corners as another of the same kind
	uint64_t reversed = 0;    // triangles dropped: back of another
	uint64_t thin = 0;        // triangles dropped: no area
	uint64_t uncut = 0;       // polygons before cutting
	uint64_t clear = 0;       // polygons dropped: fully transparent masks
	uint64_t components = 0;  // pieces of surface connected by edges
	uint64_t closed = 0;      // closed components: every edge has as many triangles in each direction, up to `holes`
	double extent_m = 0.0;    // length that merged polygons were cut to; infinite: none was cut; 0: not requested
	double deviation_m = 0.0; // upper bound of how far simplification moved the surface
};

struct Occluding
{
	Occluders occluders;
	OccluderCounts counts;
};

// Triangles are joined if they share an edge exactly (positions are compared bit by bit), traverse it in opposite directions, are
// of one kind (opaque, or one masked material with one texture mapping), have the same sides and lie in one plane within
//     max(flat · δ, min(4 ulp of a 32-bit float at the coordinates, 1e-4 δ)),
// and for two-sided polygons at most δ/20000, so that a receiver on the surface is within the evaluator's bias of the plane. The
// result depends on the flat region, not on its triangles: outlines lose corners that are equally close to the line between others.
// ᾱ of a masked polygon is the fraction of its area that passes the cut-off (as for rays, isSolidAt), from 64 to 1024 even samples.
// Same bytes for any thread count. Throws Error: invalid_input if no polygon remains; runtime if cutting makes more corners than
// 32-bit numbers can count.
Occluding occludersOf(const Level& level, const OccluderSettings& settings, const RunSettings& run);

// Finds a level's closed surfaces, before a part of it is cut out and they can no longer be recognised.

// 1 for opaque triangles of a closed surface with its fronts outside: those that Sides::automatic treats as one-sided.
std::vector<uint8_t> closedTriangles(const Level& level, const RunSettings& run);

} // namespace nook
