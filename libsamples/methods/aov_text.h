// SPDX-License-Identifier: GPL-3.0-or-later
// The shaders that draw ambient occlusion volumes; `nook shade` and `nook emit` use the same text.
#pragma once

#include <glm/ext/vector_uint4.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <string>
#include <vector>

namespace nook
{

enum class GlslTarget
{
	gl330,  // OpenGL 3.3 and later
	gl430,  // OpenGL 4.3 and later: explicit bindings
	es300,  // OpenGL ES 3.0 and later, WebGL 2
	vulkan, // Vulkan: GLSL 4.50 with descriptor sets and bindings
	hlsl60, // HLSL for shader model 6.0, Direct3D 12; it needs nothing that 5.0 lacks
	wgsl,   // WebGPU: translated from the GLSL for Vulkan
};

struct AovTextSettings
{
	GlslTarget target = GlslTarget::gl330;
	int directions = 0;        // aov-mask: 32 to 256, a multiple of 32; 0: sums of occlusion
	bool device_depth = false; // depth as stored in a depth buffer; else along the view direction, metres
};

// One file for all stages, without #version: the including shader defines NOOK_VERTEX, NOOK_FRAGMENT or NOOK_RESOLVE first.
std::string aovText(const AovTextSettings& settings);

// The directions of masks (mask.glsl) and their thresholds.

inline constexpr int kLeastDirections = 32;
inline constexpr int kMostDirections = 256;

// `count` unit directions around z, steepest first, each representing an equal fraction of the cosine-weighted hemisphere; w is a
// threshold in (0, 1), evenly distributed over the directions of any part of the hemisphere. Requires a multiple of 32 within the
// limits.
std::vector<glm::vec4> maskDirections(int count);

// The directions as the kernels take them (mask.glsl).
struct MaskTables
{
	int directions = 0;
	std::vector<glm::vec3> rays;         // the directions times 1 - threshold; then 0 up to a multiple of 128
	std::vector<glm::uvec4> half_spaces; // 64 x 64 texels for every 128 rays
};

// Made at the first call for each count.
const MaskTables& maskTablesOf(int count);

} // namespace nook
