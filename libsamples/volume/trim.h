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
	std::size_t most_shares = std::size_t{1} << 24U;    // of receivers by volumes: beyond, receivers are left out; 12 bytes each
};

inline constexpr double kTrimFloor = 0.02;

struct TrimCounts
{
	std::size_t receivers = 0;  // that were asked
	std::size_t shares = 0;     // what they get from single volumes, counted
	std::size_t lost = 0;       // of those
	std::size_t trimmed = 0;    // volumes
	double mean_reach = 1.0;    // of all volumes
	double greatest_loss = 0.0; // of occlusion, at those receivers
	double mean_loss = 0.0;
};

// Sets Occluder::reach of the set's polygons, which has to be 1, to multiples of 1/128. A volume that fewer than four receivers get
// something from keeps its reach. The same for any thread count.
TrimCounts trimVolumes(VolumeSet& volumes, const Tracer& tracer, const TrimSettings& settings, const RunSettings& run);

// The same for given receivers.
TrimCounts trimVolumes(VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
					   const RunSettings& run);

// Share of the distance that a volume has to reach for a point in front of its polygon: the greater one of its height and its
// distance beyond an edge.
double reachFor(const VolumeSet& volumes, const Occluder& polygon, glm::dvec3 position);

} // namespace nook
