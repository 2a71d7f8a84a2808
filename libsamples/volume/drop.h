// SPDX-License-Identifier: GPL-3.0-or-later
// Drops occluder polygons whose volumes a level does not need, and reports what they could have contributed.
//
// A receiver is a point on a visible side of a level's triangle. The result does not depend on the thread count.
#pragma once

#include "core/progress.h"
#include "scene/tracer.h"
#include "volume/volumes.h"

#include <cstdint>
#include <vector>

namespace nook
{

struct DropSettings
{
	bool no_receiver = true;   // drop polygons without a receiver in their volume that has them above its tangent plane
	bool sides = true;         // make two-sided polygons with receivers on only one side one-sided
	bool inside = true;        // drop polygons inside solids, and ignore receivers there (sampled)
	double simplified_m = 0.0; // ≥ 0: how far simplification moved surfaces; points this far in front of a side belong to it
	double below = 0.0; // drop the smallest contributions as long as no receiver loses more than this in total; 0: none; at most 1
	bool smooth_normals = true;       // receivers may have interpolated normals; else only face normals
	std::vector<Bounds> visible_from; // boxes that contain all cameras; receivers not visible from them are ignored, and so are
									  // polygons that see none of the others (sampled). Empty: cameras anywhere
	int seen_rays = 64;               // rays per triangle before it counts as invisible from the boxes, ≥ 1
	std::vector<uint8_t> receivers;   // 1 for each triangle whose darkening counts; empty: all
};

struct DropCounts
{
	uint64_t polygons = 0;       // before
	uint64_t kept = 0;           // after
	uint64_t inside = 0;         // dropped: inside solids, or visible from nowhere
	uint64_t convex = 0;         // dropped: no surface in their volume has them above its tangent plane
	uint64_t alone = 0;          // dropped: no surface in their volume
	uint64_t enclosed = 0;       // dropped: darken only receivers inside solids
	uint64_t unseen = 0;         // dropped: see only what is invisible from the boxes, or have only that in their volume
	uint64_t below = 0;          // dropped: contributions too small
	uint64_t turned = 0;         // made one-sided
	double area_m2 = 0.0;        // total area of the input polygons
	double inside_m2 = 0.0;      // area inside solids, or darkening only what is
	bool inside_refused = false; // that was more than half, so the level is inside out and nothing was dropped as inside
	double greatest_loss = 0.0;  // proven bound of what a receiver loses by `below`
	uint64_t triangles = 0;      // in the level
	uint64_t inside_sides = 0;   // triangle sides inside solids; each triangle has two sides
	uint64_t unseen_sides = 0;   // other sides invisible from the boxes: proven (behind their plane) or sampled
	uint64_t check_rays = 0;     // rays of an independent sample from the boxes
	uint64_t check_missed = 0;   // rays that hit a side considered invisible, which then counts as visible
};

struct Dropped
{
	Occluders occluders;
	DropCounts counts;
};

// δ and exact_bounds as in VolumeSet. Requires below in [0, 1] and boxes with least ≤ most.
Dropped dropVolumes(const Occluders& occluders, const Tracer& tracer, double distance_m, bool exact_bounds,
					const DropSettings& settings, const RunSettings& run);

} // namespace nook
