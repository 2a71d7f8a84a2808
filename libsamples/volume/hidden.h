// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes that were taken for hidden, and receivers → what each receiver sees of them, and what it would get through something
// opaque.
#pragma once

#include "core/progress.h"
#include "scene/reference.h"
#include "scene/tracer.h"
#include "volume/drop.h"
#include "volume/volumes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

struct HiddenShares
{
	std::vector<double> behind;        // one a receiver: sum of the contributions of which no part is seen
	std::vector<uint8_t> seen_volumes; // one a volume: 1 where a receiver sees some of what it contributes there
	HiddenCheck check;
};

// Volumes of one side. 8 segments from the receiver to the polygon, and those to its corners and its nearest point, until one gets
// through, for each contribution above kHiddenLeast; lesser ones count as behind. `lift_m` as in sight.h.
HiddenShares hiddenShares(const VolumeSet& hidden, const Tracer& tracer, std::span<const ReferencePoint> receivers, double lift_m,
						  const RunSettings& run);

// How far segments keep off surfaces: rounding, and δ's share within which polygons give nothing anyway.
double sightLift(const Tracer& tracer, double distance_m, double surface_m);

} // namespace nook
