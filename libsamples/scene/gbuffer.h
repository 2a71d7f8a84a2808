// SPDX-License-Identifier: GPL-3.0-or-later
// A camera → depth and normals of every pixel, by rays; and the same as an OpenEXR file, ours or an engine's.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "scene/camera.h"
#include "scene/tracer.h"

#include <glm/vec3.hpp>

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
	std::vector<float> depth;       // metres along the view direction, > 0; +inf: sky; rows from the top
	std::vector<glm::vec3> normals; // view space, unit, facing the camera; 0 where there is sky; empty: none yet
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

// Fills `normals` from depth alone. Five taps: on each axis the difference to the neighbour that continues the surface best.
void normalsFromDepth(GBuffer& gbuffer);

// View-space position of a pixel's surface; requires a finite depth.
glm::dvec3 positionOf(const GBuffer& gbuffer, const Projector& projector, int x, int y);

// EXR as DESIGN has it: Z, N.X, N.Y, N.Z; worldToCamera and projection; `notes` besides.
std::string gbufferBytes(const GBuffer& gbuffer, const Notes& notes);

enum class DepthKind
{
	linear, // metres along the view direction
	device, // what a depth buffer holds, 0 to 1
};

enum class ClipRange
{
	minus_one_to_one, // z_ndc = 2 × device − 1: OpenGL's default
	zero_to_one,      // z_ndc = device: Direct3D, Vulkan, Metal, and reversed depth
};

enum class NormalSpace
{
	view,
	world,
};

// How to read a file that nook did not write. What is empty or absent comes from the file.
struct GBufferImport
{
	DepthKind depth = DepthKind::linear;
	ClipRange clip = ClipRange::minus_one_to_one;
	std::string depth_channel;   // empty: Z, else the only channel of that last name part, in any case, or "depth"
	std::string normal_channels; // what stands before .X .Y .Z; empty: N, or "normal"
	NormalSpace normal_space = NormalSpace::view;
	bool normals_from_depth = false;
	std::optional<glm::dmat4> projection;
	std::optional<glm::dmat4> camera_from_world;
};

// Throws Error: file where it cannot be read; invalid_input where channels or matrices are missing or a value is impossible
// (negative or NaN depth, zero normals), naming the first pixel.
GBuffer readGBuffer(const std::string& path, const GBufferImport& import);

} // namespace nook
