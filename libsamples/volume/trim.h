// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes → shorter ones, where sampled receivers lose little by that: fewer fragments to draw.
#pragma once

#include "core/progress.h"
#include "scene/tracer.h"
#include "volume/verify.h"
#include "volume/volumes.h"

#include <cstddef>
#include <cstdint>
#include <span>

namespace nook
{

struct TrimSettings
{
	// Of the sum of all volumes' occlusion at a receiver, or of kTrimFloor where that is more: what it may lose, (0, 1].
	double share = 0.1;
	ReceiverSettings receivers{8, 10000, 220000, 0, 7}; // trimmed for these
	// Shares are what a receiver gets from a volume, 8 to 16 bytes each. Beyond the greater of both, receivers are left out at
	// random.
	std::size_t most_shares = std::size_t{1} << 25U;
	std::size_t shares_each = 64; // of a volume, on average
};

inline constexpr double kTrimFloor = 0.05;

struct TrimCounts
{
	std::size_t receivers = 0; // that were asked
	std::size_t left_out = 0;  // that were not: all would have more shares than they may
	std::size_t whole = 0;     // volumes that keep their reach, since fewer than four receivers get something from them
	std::size_t shares = 0;    // what they get from single volumes, counted
	std::size_t lost = 0;      // of those
	std::size_t trimmed = 0;   // volumes
	double mean_reach = 1.0;   // of all volumes, along the normal
	double surface = 1.0; // of the volumes that four receivers tell of: share of what it was, by the estimate that is made less
	double greatest_loss = 0.0; // of occlusion, at those receivers
	double mean_loss = 0.0;
};

// Sets Occluder::reach and side_reach of the set's polygons, which have to be 1, as files have them: multiples of 1/128, and of 1/8
// of that. A volume that fewer than four receivers get something from keeps its reach. The same for any thread count.
TrimCounts trimVolumes(VolumeSet& volumes, const Tracer& tracer, const TrimSettings& settings, const RunSettings& run);

// The same for given receivers, and, with a tracer, for what polygons see whose volumes give something to fewer than four of them.
TrimCounts trimVolumes(VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
					   const RunSettings& run, const Tracer* tracer = nullptr);

// Shares of the distance that a volume has to reach for a point: along its normal, and beyond its edges.
struct VolumeReach
{
	float height = 1.0F;
	float side = 1.0F;
};

VolumeReach reachFor(const VolumeSet& volumes, const Occluder& polygon, glm::dvec3 position);

} // namespace nook
