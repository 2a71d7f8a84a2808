// SPDX-License-Identifier: GPL-3.0-or-later
// Fills the kernels' uniform block, for the CPU and for OpenGL.
#pragma once

#include "methods/kernels.h"
#include "methods/settings.h"

#include <glm/mat4x4.hpp>

#include <cstddef>
#include <map>
#include <span>
#include <string>

namespace nook
{

constexpr int kMomentLevels = 6; // up to texels of 64 × 64 pixels

// Fills size, pixel_size, across_x, across_y, aside, w_slope, w_start, first and last. Throws Error (unsupported) for a skewed
// projection.
void fillCamera(ShadeBlock& block, const glm::dmat4& projection, int width_px, int height_px);

// Everything about a picture that its block depends on.
struct ShadeFrame
{
	int width_px = 0;
	int height_px = 0;
	glm::dmat4 projection{1.0};
	std::span<const float> depth{};         // GBuffer::depth; empty: unknown so far
	std::span<const float> depth_error_m{}; // GBuffer::depth_error_m
};

// Depth formats, whose settings are DepthFormat.

// Fills depth, far_end, depth_step and depth_share; requires w_slope and w_start. Throws Error: invalid_input for device depth with
// a projection whose z is singular, unsupported if its z depends on x or y.
void fillDepth(ShadeBlock& block, const glm::dmat4& projection, const DepthFormat& format);

// Sets depth_step and depth_share so that no depth is off by more than nookDepthError returns. For linear depths with given errors,
// uses the smaller of a depth buffer's error with this projection and the error of floats. Requires w_slope and w_start.
void fillMeasuredError(ShadeBlock& block, std::span<const float> depths, std::span<const float> depth_error_m);

// Sine of the angle by which rounding may turn a normal with three components of 8 to 16 bits; 0 for 32. Step size: 2 / (2ᵇ − 1),
// for components stored as 0…1 and, to within a hundredth, as −1…1.
double normalError(int bits);

// Throws like fillCamera, and Error (invalid_input), naming the pixel, for lengths that kernels cannot square.
ShadeBlock blockOf(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings);

// The members of the block as a table, and as GLSL.

struct BlockMember
{
	const char* type; // GLSL type
	const char* name;
	const char* meaning; // one line
	std::size_t offset;  // in ShadeBlock
};

// The members of modules come first; `all` adds those of methods that are never emitted.
std::span<const BlockMember> blockMembers(bool all = false);

// Offset and end in std140 of a member of that type that follows `end` bytes.
struct MemberPlace
{
	std::size_t offset = 0;
	std::size_t end = 0;
};
MemberPlace placeOf(const BlockMember& member, std::size_t end);

// One line per member of all methods with its meaning.
std::string membersGlsl();

// "NOOK_SAMPLES" → its value, for every constant.
std::map<std::string, std::string> constantsOf(const ShadeBlock& block);

} // namespace nook
