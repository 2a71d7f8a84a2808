// SPDX-License-Identifier: GPL-3.0-or-later
// Per-pixel baked values for a G-buffer, and the same view of the static level.
#pragma once

#include "core/progress.h"
#include "scene/baked_values.h"
#include "scene/gbuffer.h"
#include "scene/tracer.h"

#include <cstdint>
#include <vector>

namespace nook
{

struct BakedPicture
{
	std::vector<float> values;     // where the pixel shows the baked surface; 0 elsewhere
	std::vector<uint8_t> is_baked; // 1: shows the baked surface; 0: something else, or sky
	GBuffer fixed;                 // depth and normals of the baked level; the G-buffer's own where they agree
};

// `tracer` holds the file's level. A pixel shows the baked surface if both depths agree within 0.1 % plus the G-buffer's own
// uncertainty. Throws like Projector. Progress stage "baked pixels".
BakedPicture bakedPicture(const Tracer& tracer, const BakedValues& baked, const GBuffer& gbuffer, const RunSettings& run);

// Where `fixed` shows the same surface as `gbuffer` (by that rule), copies its depth and normal exactly; returns 1 for such pixels.
std::vector<uint8_t> alignStatic(GBuffer& fixed, const GBuffer& gbuffer);

} // namespace nook
