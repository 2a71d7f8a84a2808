// SPDX-License-Identifier: GPL-3.0-or-later
// A G-buffer and the occlusion volumes of its level → visibility, on the CPU or through OpenGL (AOV §5).
#pragma once

#include "scene/gbuffer.h"
#include "shade/shade.h"
#include "volume/volumes.h"

#include <cstdint>

namespace nook
{

// What OpenGL adds occlusion up in.
enum class AovTarget
{
	r16f,
	r8, // saturates
	r32f,
};

struct AovSettings
{
	bool mask = false;                  // bits of directions in place of sums: nothing is counted twice (Laine and Karras 2010)
	int directions = 128;               // of mask: 32 to 256, a multiple of 32
	int every_px = 1;                   // 1; 3 or 5: one pixel of as many squared, then AOV §5.5's filter over 5×5 of those,
										// and once more the pixels that it cannot know (aov_sparse.glsl)
	bool compensate = true;             // by the volumes' curve; not with mask
	AovTarget target = AovTarget::r16f; // OpenGL
	bool cull = true;                   // OpenGL: only clusters in sight
	bool choose_faces = true;           // OpenGL, volumes with exact bounds: front or back faces of each, whichever cover fewer
										// pixels in vain (aov_faces.glsl); else front ones, and back ones of clusters that hold
										// the eye
};

struct AovCounts
{
	uint64_t volumes = 0;        // of the set
	uint64_t clusters_drawn = 0; // OpenGL
	uint64_t volumes_drawn = 0;  // OpenGL
	uint64_t fragments = 0;      // OpenGL: fragment shaders run; CPU: pairs of a pixel and a volume that holds it
	uint64_t pixels_alone = 0;   // of every_px > 1: drawn by themselves, beside one of each cell
};

struct AovShaded
{
	Shaded shaded;
	AovCounts counts;
};

AovShaded aovOnCpu(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const RunSettings& run,
				   const DrawSettings& drawing = {});

// OpenGL 3.3 or later, without a display. Throws Error (unsupported) where no context can be made.
AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing = {});

} // namespace nook
