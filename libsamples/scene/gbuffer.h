// SPDX-License-Identifier: GPL-3.0-or-later
// Ray-casts depth and normals for a camera; writes them as OpenEXR, and reads such files from nook or an engine.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "core/round.h"
#include "scene/camera.h"
#include "scene/tracer.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

struct GBuffer
{
	int width_px = 0;
	int height_px = 0;
	View view;
	double view_error_m = 0.0;      // bound on the position error from rounding of the view's matrices: > 0 if the file had 32 bits
	std::vector<float> depth;       // metres along the view direction, > 0; +inf: sky; rows from the top
	std::vector<glm::vec3> normals; // view space, unit; 0 for sky; empty: none yet. Ours face the camera; an engine's are unchanged
									// (normal maps and smooth shading turn some slightly away)
	std::vector<float> depth_error_m{}; // upper bound by which a depth may be too large, ≥ 0; empty: only its rounding to 32 bits

	std::size_t index(int x, int y) const
	{
		return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_px) + static_cast<std::size_t>(x);
	}
};

enum class NormalKind
{
	geometric,    // the triangle's
	interpolated, // interpolated from the file's vertices; the triangle's if it has none
	from_depth,   // from the depth of the pixel and its neighbours
};

// One ray through every pixel's centre. Near and far planes are ignored; both sides of a triangle are visible, with the normal
// turned to the camera. Requires width, height ≥ 1. Throws like Projector.
GBuffer castGBuffer(const Tracer& tracer, const View& view, int width_px, int height_px, NormalKind normals,
					const RunSettings& run);

// Fills `normals` from depth alone. On each axis it uses the difference to the neighbour that continues the surface best (see
// gbuffer.cpp). Throws like Projector.
void normalsFromDepth(GBuffer& gbuffer, const RunSettings& run = {});

// View-space position of a pixel's surface; requires a finite depth.
glm::dvec3 positionOf(const GBuffer& gbuffer, const Projector& projector, int x, int y);

// EXR channels Z, N.X, N.Y, N.Z (without normals only Z). Matrices: worldToCamera, worldToNDC and projection with 32 bits, which
// other tools know; worldToCamera64 and projection64 with 64 bits, which readGBuffer() prefers, since 32 lose millimetres far from
// the origin. depth_error holds GBuffer::depth_error_m if present; worldToCamera64 is omitted if the view had 32 bits.
std::string gbufferBytes(const GBuffer& gbuffer, const Notes& notes);

enum class DepthKind
{
	linear,   // metres along the view direction
	distance, // metres from the eye (parallel projections: from the camera plane)
	device,   // depth buffer values, 0 to 1; the far end is sky, to which buffers are cleared
};

enum class NormalSpace
{
	view,
	world,
};

enum class NormalRange
{
	plus_minus_one, // the components themselves
	zero_to_one,    // (component + 1) / 2, as in 8-bit buffers
};

// How to read a file from another program. Empty or absent settings come from the file.
struct GBufferImport
{
	DepthKind depth = DepthKind::linear;
	ClipRange clip = ClipRange::minus_one_to_one;
	double sky_depth_m = 1e10;   // linear and distance: sky from here on; some renderers write 1e10, others infinity
	std::string depth_channel;   // empty: Z, else the only channel whose last name part is Z or depth (case-insensitive)
	std::string normal_channels; // prefix of .X .Y .Z; empty: N, else the only layer called N or normal(s) (case-insensitive)
	NormalSpace normal_space = NormalSpace::view;
	NormalRange normal_range = NormalRange::plus_minus_one;
	bool normals_from_depth = false;            // ignore the file's normals
	std::optional<std::array<int, 4>> viewport; // region to read: x, y, width, height, ≥ 1; pixels from the upper left corner
	std::optional<glm::dmat4> projection;
	std::optional<glm::dmat4> camera_from_world;
};

// Throws Error: file if it cannot be read; invalid_input if channels or matrices are missing or a value is impossible (negative or
// NaN depth, zero normals), naming the first pixel. A channel depth_error gives the depths' error in metres; without it the error
// follows from the file's number format.
GBuffer readGBuffer(const std::string& path, const GBufferImport& import);

// Likewise for an image already read; `path` is for messages only.
GBuffer gbufferFrom(Image image, const std::string& path, const GBufferImport& import);

// Index of the depth channel that readGBuffer() would use; throws an Error listing the channels of `image`.
int depthChannel(const Image& image, const std::string& path, const std::string& wanted);

// True if a depth channel can be recognised by name.
bool looksLikeGBuffer(const Image& image);

// Pixels of a G-buffer with linear depth that show a surface: 1, else 0; rows from the top. Needs no camera. Throws like
// readGBuffer.
struct SurfaceMask
{
	int width_px = 0;
	int height_px = 0;
	std::vector<uint8_t> surface;
};
SurfaceMask readSurfaceMask(const std::string& path);

} // namespace nook
