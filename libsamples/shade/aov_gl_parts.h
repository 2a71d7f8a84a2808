// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes on the GPU, and the programs that draw them.
#pragma once

#include "methods/aov_text.h"
#include "shade/aov.h"
#include "shade/gl_context.h"
#include "volume/packed.h"
#include "volume/runtime/nook_volumes_draw.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace nook
{

// An array for shaders: a buffer and its buffer texture.
class GlArray
{
public:
	// `format` is the texel format and `texel` its size in bytes. Throws Error (unsupported) for more texels than OpenGL supports.
	GlArray(std::span<const std::byte> bytes, unsigned format, std::size_t texel);

	void bindTexture(unsigned unit) const;
	void bindStorage(unsigned binding) const; // OpenGL 4.3
	unsigned buffer() const
	{
		return m_buffer;
	}

private:
	GlName m_buffer;
	GlName m_texture;
};

// Textures that the programs read, by unit.
inline constexpr std::array<const char*, 9> kAovUnits{"nook_corners",   "nook_polygons", "nook_clusters",
													  "nook_depths",    "nook_normals",  "nook_sums",
													  "nook_more_sums", "nook_cells",    "nook_half_spaces"};

// The block `NookVolumes` has binding 0.
class GlProgram
{
public:
	GlProgram(const std::string& vertex, const std::string& fragment);

	unsigned name() const
	{
		return m_name;
	}

private:
	GlName m_name;
};

// An empty texture used as render target.
class GlTarget
{
public:
	GlTarget(unsigned stored, unsigned channels, unsigned type, int width, int height);

	unsigned name() const
	{
		return m_name;
	}

private:
	GlName m_name;
};

// Render targets drawn into together; depth: with stencil, 0: none.
class GlFrame
{
public:
	GlFrame(std::span<const unsigned> colours, unsigned depth);
	void use() const;

private:
	GlName m_name;
};

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
