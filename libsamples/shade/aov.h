// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility of a G-buffer from its level's occlusion volumes, on the CPU or through OpenGL (AOV §5).
#pragma once

#include "scene/gbuffer.h"
#include "shade/shade.h"
#include "volume/volumes.h"

#include <cstdint>

namespace nook
{

// Texture format in which OpenGL accumulates occlusion.
enum class AovTarget
{
	r16f,
	r8, // saturates
	r32f,
};

struct AovSettings
{
	bool mask = false;    // direction bits instead of sums, so that nothing is counted twice (Laine and Karras 2010)
	int directions = 128; // number of mask directions: 32 to 256, a multiple of 32
	int every_px = 1; // 1, 3 or 5: shade one pixel per cell of that size, then apply AOV §5.5's filter over 5×5 cells, and shade
					  // pixels individually where it fails (aov_sparse.glsl)
	bool compensate = true;             // apply the volumes' compensation curve; not with mask
	AovTarget target = AovTarget::r16f; // OpenGL
	bool cull = true;                   // OpenGL: cull clusters
	bool choose_faces = true; // OpenGL, volumes with exact bounds: per volume, draw the front or the back faces, whichever waste
							  // fewer pixels (aov_faces.glsl); else front faces, and back faces for clusters that contain the eye
};

struct AovCounts
{
	uint64_t volumes = 0;        // in the set
	uint64_t clusters_drawn = 0; // OpenGL
	uint64_t volumes_drawn = 0;  // OpenGL
	uint64_t fragments = 0;      // OpenGL: fragment shader invocations; CPU: pairs of a pixel and a volume that contains it
	uint64_t pixels_alone = 0;   // with every_px > 1: pixels shaded individually, besides one per cell
};

struct AovShaded
{
	Shaded shaded;
	AovCounts counts;
};

AovShaded aovOnCpu(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const RunSettings& run,
				   const DrawSettings& drawing = {});

// OpenGL 3.3 or later, without a display. Throws Error (unsupported) if no context can be created.
AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing = {});

} // namespace nook
