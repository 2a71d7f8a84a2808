// SPDX-License-Identifier: GPL-3.0-or-later
// Occluder polygons → those whose volumes a level needs, with a statement of what the others could have done.
//
// A receiver is a point of a level's triangle on a side of it that can be seen. Nothing here depends on the number of threads.
#pragma once

#include "core/progress.h"
#include "scene/tracer.h"
#include "volume/volumes.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace nook
{

inline constexpr double kHiddenBound = 1.0 / 64.0; // four steps of 8 bits

struct DropSettings
{
	bool no_receiver = true; // polygons that no receiver within their volume has above its tangent plane; convex places among them
	bool sides = true;       // two-sided polygons with receivers on one side only become one-sided
	bool inside = true;      // polygons inside solids, and receivers there (sampled)
	bool hidden = false; // sides of polygons with something opaque between them and all of their receivers (sampled, sight.h; dear)
	double hidden_bound = kHiddenBound; // of occlusion: what a sampled receiver may lose by `hidden`; else more sides are kept
	double surface_m = 0.0;             // ≥ 0: polygons may lie this far off the level's surfaces
	double simplified_m = 0.0; // ≥ 0: of that, what simplification moved them by; places this far before a side count as the side's
	double below = 0.0;        // the least contributions, as long as no receiver loses more than this in all; 0: none; at most 1
	bool smooth_normals = true; // receivers may have normals interpolated between their vertices'; else only their triangle's
	std::vector<Bounds>
		visible_from;   // cameras are in one of these boxes; receivers out of their sight do not count. None: anywhere
	int seen_rays = 64; // rays to a triangle before it counts as out of sight of the boxes, ≥ 1
};

// What independent receivers see of what was dropped as hidden.
struct HiddenCheck
{
	std::size_t receivers = 0;
	std::size_t volumes = 0; // pairs of a receiver and a volume that were asked: contributions above kHiddenLeast
	std::size_t seen = 0;    // of those, where some segment gets through
	double greatest = 0.0;   // sum of the contributions seen at a receiver
	double mean = 0.0;
};

inline constexpr double kHiddenLeast = 1.0 / 1024.0; // of occlusion

struct DropCounts
{
	uint64_t polygons = 0;         // before
	uint64_t kept = 0;             // after
	uint64_t inside = 0;           // dropped: inside solids, or seen from nowhere
	uint64_t convex = 0;           // dropped: surfaces within their volume, none with them above its tangent plane
	uint64_t alone = 0;            // dropped: no surface at all within their volume
	uint64_t enclosed = 0;         // dropped: would darken only what is inside solids
	uint64_t hidden = 0;           // dropped: would darken only what it does not see
	uint64_t hidden_sides = 0;     // of all polygons, also of those kept for their other side
	uint64_t hidden_segments = 0;  // asked for these
	uint64_t hidden_unsettled = 0; // sides kept because too many segments would have been needed
	uint64_t hidden_restored = 0;  // sides kept because of independent samples of receivers
	uint64_t hidden_samples = 0;   // of these; the last one lost no more than the bound, or there were kMostHiddenSamples
	HiddenCheck hidden_check;      // what one more sample loses
	bool hidden_lost = false;      // that is above the bound
	uint64_t unseen = 0;           // dropped: would darken only what is out of sight of the boxes
	uint64_t below = 0;            // dropped: contributions too small
	uint64_t turned = 0;           // two-sided before, one-sided after
	double area_m2 = 0.0;          // of the polygons before
	double inside_m2 = 0.0;        // of those that are inside, or would darken only what is
	bool inside_refused = false;   // that was more than half: the level is inside out, so nothing was dropped for it
	double greatest_loss = 0.0;    // proven: no receiver loses more by `below`
	uint64_t triangles = 0;        // of the level
	uint64_t inside_sides = 0;     // sides of triangles that count as inside; there are two of each
	uint64_t unseen_sides = 0;     // further sides out of sight of the boxes, proven (behind their plane) or sampled
	uint64_t check_rays = 0;       // of an independent sample from the boxes
	uint64_t check_missed = 0;     // of those, met a side that was taken for unseen (and is taken for seen since)
};

struct Dropped
{
	Occluders occluders;
	Occluders hidden; // the sides that went as hidden, each as a polygon of one side
	DropCounts counts;
};

// δ and exact_bounds as in VolumeSet. Requires below in [0, 1] and boxes with least ≤ most.
Dropped dropVolumes(const Occluders& occluders, const Tracer& tracer, double distance_m, bool exact_bounds,
					const DropSettings& settings, const RunSettings& run);

} // namespace nook
