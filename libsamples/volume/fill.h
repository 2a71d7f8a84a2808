// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes and a view → how many fragments drawing them shades, counted on the CPU: a volume has a fragment in a pixel where the
// line from the eye to the pixel's surface meets it (its front faces pass the depth test there, or the eye is in it).
#pragma once

#include "core/progress.h"
#include "scene/gbuffer.h"
#include "volume/volumes.h"

#include <cstdint>

namespace nook
{

struct FillCount
{
	uint64_t pixels = 0;    // that show a surface; sky has a fragment for every volume before it, which is not counted
	uint64_t fragments = 0; // whole volumes are drawn, nothing is culled by cluster
	uint64_t within = 0;    // fragments whose pixel's surface is in the volume: the others add nothing
};

// Perspective views only.
FillCount countFill(const GBuffer& gbuffer, const VolumeSet& volumes, const RunSettings& run);

} // namespace nook
