// SPDX-License-Identifier: GPL-3.0-or-later
// Shortens volumes where sampled receivers lose little, so that fewer fragments are drawn.
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
	// Loss allowed at a receiver, in (0, 1], relative to the summed occlusion of all volumes there, or to kTrimFloor if greater.
	double share = 0.1;
	ReceiverSettings receivers{8, 10000, 220000, 0, 7}; // the receivers to trim for
	// A share is a volume's contribution to a receiver, 8 to 16 bytes. Above the greater of both limits, random receivers are
	// dropped.
	std::size_t most_shares = std::size_t{1} << 25U;
	std::size_t shares_each = 64; // average per volume
};

inline constexpr double kTrimFloor = 0.05;

struct TrimCounts
{
	std::size_t receivers = 0;  // evaluated
	std::size_t left_out = 0;   // dropped because of the limit on shares
	std::size_t whole = 0;      // volumes left as they are because fewer than four receivers have a share of them
	std::size_t shares = 0;     // contributions of single volumes to receivers
	std::size_t lost = 0;       // shares removed
	std::size_t trimmed = 0;    // number of trimmed volumes
	double mean_reach = 1.0;    // over all volumes, along the normal
	double surface = 1.0;       // trimmed relative to original surface, estimated, for volumes with at least four receivers
	double greatest_loss = 0.0; // greatest loss of occlusion at those receivers
	double mean_loss = 0.0;
};

// Sets Occluder::reach and side_reach of the set's polygons, which must be 1, in the steps of files: multiples of 1/128, and of 1/8
// of that. A volume with a contribution to fewer than four receivers keeps its reach. Same result for any thread count.
TrimCounts trimVolumes(VolumeSet& volumes, const Tracer& tracer, const TrimSettings& settings, const RunSettings& run);

// Likewise for given receivers and, with a tracer, for points seen by polygons whose volumes contribute to fewer than four of them.
TrimCounts trimVolumes(VolumeSet& volumes, std::span<const ReferencePoint> receivers, const TrimSettings& settings,
					   const RunSettings& run, const Tracer* tracer = nullptr);

// How far a volume must reach to contain a point, relative to the distance: along its normal, and beyond its edges.
struct VolumeReach
{
	float height = 1.0F;
	float side = 1.0F;
};

VolumeReach reachFor(const VolumeSet& volumes, const Occluder& polygon, glm::dvec3 position);

} // namespace nook
