// SPDX-License-Identifier: GPL-3.0-or-later
// Depths and a second layer of them, behind the first → visibility: what a screen-space method could know of two layers.
#pragma once

#include "core/progress.h"
#include "scene/gbuffer.h"
#include "scene/tracer.h"

#include <span>
#include <vector>

namespace nook
{

// Which surface behind the one that a pixel shows is its second.
enum class SecondSurface
{
	any,    // the next: of a solid, its back
	facing, // the next that faces the camera
};

// Along the view direction, as G-buffers have them; infinity where there is none.
std::vector<float> secondDepths(const Tracer& tracer, const GBuffer& gbuffer, SecondSurface which, const RunSettings& run);

struct LayersSettings
{
	int slices = 16;
	int steps = 8;                 // on either side
	double radius_m = 1.0;         // of the rays
	double thickness = 0.5;        // of the first layer at the reach, in radii; as SliceSettings::thickness
	double second_thickness = 0.5; // of the second
	int every_px = 1;              // of both axes: those between are left out
};

// Slices (slices.glsl) step by step: bits that the first layer covers, then those that the second covers besides. Pixels that are
// left out have 1. With a second layer of nothing but infinity it is the method of SliceSettings, to the bit.
std::vector<float> layersVisibility(const GBuffer& gbuffer, std::span<const float> second, const LayersSettings& settings,
									const RunSettings& run);

} // namespace nook
