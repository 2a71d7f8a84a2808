// SPDX-License-Identifier: GPL-3.0-or-later
// How volumes are drawn on the GPU.
#pragma once

#include "methods/aov_text.h"
#include "shade/aov.h"
#include "shade/gl_context.h"
#include "volume/packed.h"
#include "volume/runtime/nook_volumes_draw.h"

namespace nook
{

// How aovOnGl draws; does not affect the pictures.
struct AovGlOptions
{
	bool storage_buffers = false; // the OpenGL 4.3 shaders, with one draw call for all clusters
	bool prisms = false;          // draw the file's points and triangles; else the vertex shader expands polygons to volumes
	bool depth_bounds = true;     // per cluster, if the driver has EXT_depth_bounds_test and clusters are drawn separately
	bool back_faces = false;      // for all clusters, not only those that contain the eye; requires choose_faces to be false
	bool choose_faces = true; // volumes with exact bounds: front or back faces per volume (aov_faces.glsl); else per cluster: back
							  // faces for those that contain the eye
};
AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing,
				  const AovGlOptions& options);

// The part of a file's header that shaders read.
nook_volumes::Header headerOf(const VolumeSet& volumes, bool compensate);

// Camera of a picture whose row 0 is at the top, with z from −1 at the nearest surface to 1 at the farthest.
nook_volumes::Camera cameraOf(const GBuffer& gbuffer, int every_px);

} // namespace nook
