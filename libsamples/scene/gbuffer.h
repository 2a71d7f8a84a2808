// SPDX-License-Identifier: GPL-3.0-or-later
// A camera → depth and normals of every pixel, by rays; and the same as an OpenEXR file, ours or an engine's.
#pragma once

#include "core/clip_range.h"
#include "core/image.h"
#include "core/progress.h"
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
	double view_error_m = 0.0; // by how much rounding in the view's matrices may move a position: > 0 where a file held 32 bits
	std::vector<float> depth;  // metres along the view direction, > 0; +inf: sky; rows from the top
	std::vector<glm::vec3> normals; // view space, unit; 0 where there is sky; empty: none yet. Ours face the camera; those of an
									// engine are kept as they are (normal maps and smooth shading turn some slightly away)
	std::vector<float> depth_error_m{}; // by how much a depth may be too great, ≥ 0; empty: by its own rounding to 32 bits
};

enum class NormalKind
{
	geometric,    // of the triangle
	interpolated, // of the file's vertices; of the triangle where it has none
	from_depth,   // from the depth of the pixel and its four neighbours
};

// One ray through every pixel's centre. Near and far planes do not cut; both sides of a triangle are seen, its normal turned to the
// camera. Requires width, height ≥ 1. Throws as Projector.
GBuffer castGBuffer(const Tracer& tracer, const View& view, int width_px, int height_px, NormalKind normals,
					const RunSettings& run);

// Fills `normals` from depth alone. Five taps: on each axis the difference to the neighbour that continues the surface best
// (see gbuffer_normals.cpp). Throws as Projector.
void normalsFromDepth(GBuffer& gbuffer, const RunSettings& run = {});

// View-space position of a pixel's surface; requires a finite depth.
glm::dvec3 positionOf(const GBuffer& gbuffer, const Projector& projector, int x, int y);

// EXR as DESIGN has it: Z, N.X, N.Y, N.Z (without normals: Z alone); worldToCamera, worldToNDC and projection in 32 bits, which
// other tools know, worldToCamera64 and projection64 in 64, which readGBuffer() prefers: 32 lose millimetres far from the origin.
// depth_error holds GBuffer::depth_error_m where there is one, and worldToCamera64 is left out where the view had 32 bits.
std::string gbufferBytes(const GBuffer& gbuffer, const Notes& notes);

enum class DepthKind
{
	linear,   // metres along the view direction
	distance, // metres from the eye (parallel projections: from the plane of the camera)
	device,   // what a depth buffer holds, 0 to 1; its far end is sky, since that is what it is cleared to
};

enum class NormalSpace
{
	view,
	world,
};

enum class NormalRange
{
	plus_minus_one, // the components themselves
	zero_to_one,    // (component + 1) / 2, as 8-bit buffers hold them
};

// How to read a file that nook did not write. What is empty or absent comes from the file.
struct GBufferImport
{
	DepthKind depth = DepthKind::linear;
	ClipRange clip = ClipRange::minus_one_to_one;
	double sky_depth_m = 1e10;   // linear and distance: from here on it is sky; some renderers write 1e10 for it, others infinity
	std::string depth_channel;   // empty: Z, else the only channel whose last name part is Z or depth, in any case
	std::string normal_channels; // what stands before .X .Y .Z; empty: N, else the only layer called N or normal(s), in any case
	NormalSpace normal_space = NormalSpace::view;
	NormalRange normal_range = NormalRange::plus_minus_one;
	bool normals_from_depth = false;            // the file's normals, if any, are not read
	std::optional<std::array<int, 4>> viewport; // x, y, width, height, ≥ 1: all that is read, pixels from the upper left corner
	std::optional<glm::dmat4> projection;
	std::optional<glm::dmat4> camera_from_world;
};

// Throws Error: file where it cannot be read; invalid_input where channels or matrices are missing or a value is impossible
// (negative or NaN depth, zero normals), naming the first pixel. A channel depth_error says in metres how far the depths may be
// off; without it that follows from how the file holds them.
GBuffer readGBuffer(const std::string& path, const GBufferImport& import);

// The same of an image that was read already; `path` is for messages only.
GBuffer gbufferFrom(Image image, const std::string& path, const GBufferImport& import);

// The depth channel that readGBuffer() would take: its index, or an Error that lists the channels of `image`.
int depthChannel(const Image& image, const std::string& path, const std::string& wanted);

// Which pixels of a G-buffer with linear depth show a surface: 1, else 0; rows from the top. Needs no camera. Throws as
// readGBuffer.
struct SurfaceMask
{
	int width_px = 0;
	int height_px = 0;
	std::vector<uint8_t> surface;
};
SurfaceMask readSurfaceMask(const std::string& path);

} // namespace nook
