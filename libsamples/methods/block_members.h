// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels' uniform block, one line per member, from which the C++, the GLSL and the high-precision twins are generated.
//
// MEMBER(GLSL type, name, meaning). The order avoids padding in std140: pairs start at multiples of 8 bytes, fours at multiples of
// 16. A test checks the offsets. There are no vec3s, because drivers disagree on where they end.
#pragma once

// Members of modules.
#define NOOK_MODULE_MEMBERS(MEMBER)                                                                                                \
	MEMBER(vec2, size, "width and height of the picture, pixels")                                                                  \
	MEMBER(vec2, pixel_size, "1 / width, 1 / height")                                                                              \
	MEMBER(vec2, across_x, "turns NDC x back into view-space x: 1 / P[0][0], P[2][0] / P[0][0] of the projection P[column][row]")  \
	MEMBER(vec2, across_y, "the same for y: 1 / P[1][1], P[2][1] / P[1][1]; the first negated where row 0 is at NDC y = -1")       \
	MEMBER(vec2, aside, "the shift of an off-centre orthographic projection: -P[3][0] / P[0][0], -P[3][1] / P[1][1]")              \
	MEMBER(float, w_slope, "clip-space w at a depth d is w_slope * d + w_start: perspective has 1 and 0, orthographic 0 and 1")    \
	MEMBER(float, w_start, "see w_slope")                                                                                          \
	MEMBER(ivec2, first, "first pixel whose depth may be read, guard band included")                                               \
	MEMBER(ivec2, last, "last pixel whose depth may be read, guard band included")                                                 \
	MEMBER(vec4, depth, "device depth back to linear depth: (x + y * t) / (z + w * t), where t = abs(stored value - far_end)")     \
	MEMBER(vec2, origin, "first pixel of the picture in its textures")                                                             \
	MEMBER(float, far_end, "what the depth buffer holds at the far plane: 1, or 0 where depth is reversed")                        \
	MEMBER(float, depth_step, "a stored depth may be off by depth_step * w * w + depth_share * depth, which is its rounding")      \
	MEMBER(float, depth_share, "see depth_step")                                                                                   \
	MEMBER(float, normal_error, "sine of the angle by which rounding may turn a stored normal")                                    \
	MEMBER(float, radius, "surfaces closer than this occlude; metres, or the unit of your depths")                                 \
	MEMBER(float, second_radius, "volumetric obscurance: a second radius whose result is combined with the first")                 \
	MEMBER(float, third_radius, "volumetric obscurance: a third radius")                                                           \
	MEMBER(float, thickness, "volumetric obscurance: how far a surface goes on behind what is seen, in the unit of the radius")    \
	MEMBER(float, second_thickness, "thickness for the second radius")                                                             \
	MEMBER(float, third_thickness, "thickness for the third radius")                                                               \
	MEMBER(float, first_band_px, "with bands: a radius of fewer pixels takes the samples of the first band only")                  \
	MEMBER(float, second_band_px, "with three bands: a radius of fewer pixels takes the samples of the first two")                 \
	MEMBER(float, most_px, "largest radius in the picture, pixels")                                                                \
	MEMBER(float, least_px, "smallest radius in the picture, pixels")                                                              \
	MEMBER(float, sigma, "Alchemy: intensity")                                                                                     \
	MEMBER(float, contrast, "Alchemy: exponent of the result")                                                                     \
	MEMBER(float, beta, "Alchemy: bias against self-occlusion, as a share of the depth")                                           \
	MEMBER(float, epsilon, "Alchemy: keeps the quotient finite, in squared radii")                                                 \
	MEMBER(float, box_height, "statistical volumetric obscurance: height of the box over the surface, in radii")                   \
	MEMBER(float, slope, "statistical volumetric obscurance: how fast surfaces in front of the box stop counting, per box height") \
	MEMBER(float, largest_px, "statistical volumetric obscurance: largest half side of the box, pixels")                           \
	MEMBER(float, least_box_px, "statistical volumetric obscurance: a box with a smaller half side, in pixels, reads as open")     \
	MEMBER(float, slice_thickness, "slices: thickness of a surface at a distance of one radius, in radii")                         \
	MEMBER(float, strength, "factor of the obscurance, which is 1 - visibility")                                                   \
	MEMBER(float, power, "exponent of the visibility, after the strength")                                                         \
	MEMBER(float, frame, "number of the frame, for tiles whose samples change from frame to frame")

// NOOK_OWN_MEMBERS(MEMBER), of methods that are never emitted: their kernels declare them below the head comment.
#include "methods/twins/own_members.h"

// Constants known when a shader is generated: kernels refer to them as NOOK_NAME and in #if blocks. On the CPU they are members
// too. CONSTANT(name, default, meaning).
#define NOOK_SHADE_CONSTANTS(CONSTANT)                                                                                             \
	CONSTANT(samples, 0, "of a variant")                                                                                           \
	CONSTANT(window, 0, "side of the window of variants, pixels")                                                                  \
	CONSTANT(variant, 0, "what makes a pixel's variant that of a frame (variantOfFrame in tile.h), or of --debug noise")           \
	CONSTANT(variants, 0, "drawn so far (--debug noise)")                                                                          \
	CONSTANT(use_normal, 0, "1: above the tangent plane alone")                                                                    \
	CONSTANT(cut, 0, "1: Alchemy's")                                                                                               \
	CONSTANT(extent, 0, "volumetric obscurance by 0 lines, 1 points, 2 areas")                                                     \
	CONSTANT(radii, 0, "TwoRadii")                                                                                                 \
	CONSTANT(third, 0, "1: a third radius")                                                                                        \
	CONSTANT(quadratic, 0, "1: falloff 1 - d^2")                                                                                   \
	CONSTANT(paired, 0, "1: samples 2i and 2i + 1 are opposite")                                                                   \
	CONSTANT(thick, 0, "1: surfaces have a thickness")                                                                             \
	CONSTANT(shaped, 0, "1: strength and power")                                                                                   \
	CONSTANT(bands, 1, "1 to 3")                                                                                                   \
	CONSTANT(first_band, 0, "samples of the first band")                                                                           \
	CONSTANT(two_bands, 0, "samples of the first two")                                                                             \
	CONSTANT(cell, 1, "side of a cell of visibility in pixels (reconstruct.glsl)")                                                 \
	CONSTANT(taps, 0, "on each side of a pass of the bilateral filter")                                                            \
	CONSTANT(levels, 0, "coarser ones of depth or its moments")                                                                    \
	CONSTANT(level, 0, "that a pass makes")                                                                                        \
	CONSTANT(layers, 0, "of depth")                                                                                                \
	CONSTANT(uniform_layers, 0, "1: equal parts of the picture's depths")                                                          \
	CONSTANT(quadrants, 0, "1: four parts of the box by themselves")                                                               \
	CONSTANT(table_cell, 0, "side of a table's cell in pixels")                                                                    \
	CONSTANT(skip, 0, "1: no layers where a surface is smooth")                                                                    \
	CONSTANT(range_width, 0, "pairs that a pass reads")                                                                            \
	CONSTANT(range_height, 0, "pairs that a pass reads")                                                                           \
	CONSTANT(table, 0, "that a pass makes")                                                                                        \
	CONSTANT(stride, 0, "of entries that a pass sums")                                                                             \
	CONSTANT(axis, 0, "of a pass that sums: 0 along x, 1 along y")                                                                 \
	CONSTANT(bent, 0, "1: bent normals as well")                                                                                   \
	CONSTANT(tiled, 0, "1: slices of a tile")                                                                                      \
	CONSTANT(steps, 0, "hbao: along each direction; slices: on either side")                                                       \
	CONSTANT(native_bits, 0, "1: the language counts bits")
