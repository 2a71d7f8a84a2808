// SPDX-License-Identifier: GPL-3.0-or-later
// Baked values and a G-buffer → what each pixel has of them, and the same view of what does not move.
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
	std::vector<float> values;     // of a pixel that shows the baked surface; 0 elsewhere
	std::vector<uint8_t> is_baked; // 1: it shows it; 0: something else, or sky
	GBuffer still;                 // depth and normals of what was baked; those of the G-buffer itself where they are the same
};

// `tracer` is of the file's level. A pixel shows its surface where both depths differ by no more than 0.001 of them and what the
// G-buffer's own may be off by. Throws as Projector. Stage "baked pixels".
BakedPicture bakedPicture(const Tracer& tracer, const BakedValues& baked, const GBuffer& gbuffer, const RunSettings& run);

// Where `still` shows the same as `gbuffer` (by that rule), it gets its depth and normal, bit for bit; 1 for such pixels.
std::vector<uint8_t> alignStill(GBuffer& still, const GBuffer& gbuffer);

} // namespace nook
