// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes on the GPU, and the programs that draw them.
#pragma once

#include "methods/aov_text.h"
#include "shade/aov.h"
#include "volume/packed.h"
#include "volume/runtime/nook_volumes_draw.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>

namespace nook
{

// An array that shaders read: a buffer, and a buffer texture of it.
class GlArray
{
public:
	// `format` is of a texel, whose bytes `texel` says. Throws Error (unsupported) for more texels than OpenGL takes.
	GlArray(std::span<const std::byte> bytes, unsigned format, std::size_t texel);
	~GlArray();
	GlArray(const GlArray&) = delete;
	GlArray& operator=(const GlArray&) = delete;

	void bindTexture(unsigned unit) const;
	void bindStorage(unsigned binding) const; // OpenGL 4.3
	unsigned buffer() const
	{
		return m_buffer;
	}

private:
	unsigned m_buffer = 0;
	unsigned m_texture = 0;
};

// What the programs read, unit by unit.
inline constexpr std::array<const char*, 8> kAovUnits{"nook_corners", "nook_polygons", "nook_clusters",  "nook_depths",
													  "nook_normals", "nook_sums",     "nook_more_sums", "nook_cells"};

// Its block `NookVolumes` has binding 0.
class GlProgram
{
public:
	GlProgram(const std::string& vertex, const std::string& fragment);
	~GlProgram();
	GlProgram(const GlProgram&) = delete;
	GlProgram& operator=(const GlProgram&) = delete;

	unsigned name() const
	{
		return m_name;
	}

private:
	unsigned m_name = 0;
};

// An empty texture to draw into.
class GlTarget
{
public:
	GlTarget(unsigned stored, unsigned channels, unsigned type, int width, int height);
	~GlTarget();
	GlTarget(const GlTarget&) = delete;
	GlTarget& operator=(const GlTarget&) = delete;

	unsigned name() const
	{
		return m_name;
	}

private:
	unsigned m_name = 0;
};

// Textures that are drawn into together; depth: with a stencil, 0: none.
class GlFrame
{
public:
	GlFrame(std::span<const unsigned> colours, unsigned depth);
	~GlFrame();
	GlFrame(const GlFrame&) = delete;
	GlFrame& operator=(const GlFrame&) = delete;
	void use() const;

private:
	unsigned m_name = 0;
};

// How aovOnGl draws; pictures do not depend on it.
struct AovGlOptions
{
	bool storage_buffers = false; // OpenGL 4.3's text, and one call for all clusters
	bool prisms = false;          // the file's points and triangles, else polygons that the vertex shader makes volumes of
	bool depth_bounds = true;     // per cluster, where the driver has EXT_depth_bounds_test and clusters are drawn one by one
	bool back_faces = false;      // of all clusters, not only of those that hold the eye; needs choose_faces false
	bool choose_faces = true; // of volumes with exact bounds: front or back faces volume by volume (aov_faces.glsl); else cluster
							  // by cluster: back faces of those that hold the eye
};
AovShaded aovOnGl(const GBuffer& gbuffer, const VolumeSet& volumes, const AovSettings& settings, const DrawSettings& drawing,
				  const AovGlOptions& options);

// Of a file's header what the shaders read.
nook_volumes::Header headerOf(const VolumeSet& volumes, bool compensate);

// The camera of a picture whose row 0 is its upper one, with z from −1 at its nearest surface to 1 at its farthest.
nook_volumes::Camera cameraOf(const GBuffer& gbuffer, int every_px);

} // namespace nook
