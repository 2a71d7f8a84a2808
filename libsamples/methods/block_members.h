// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels' uniform block, a line a member, from which C++, GLSL and the twins in other numbers are made.
//
// MEMBER(type of GLSL, name, what it means). In this order std140 needs no gap between them: pairs begin at multiples of 8 bytes,
// fours at multiples of 16. A test holds the offsets against that. No threes: not all drivers agree on where they end.
#pragma once

// What modules have.
#define NOOK_MODULE_MEMBERS(MEMBER)                                                                                                \
	MEMBER(vec2, size, "width and height of the picture in pixels")                                                                \
	MEMBER(vec2, pixel_size, "1 / width, 1 / height")                                                                              \
	MEMBER(vec2, across_x, "of the projection P: 1 / P00, P20 / P00 (P20: column 2, row 0)")                                       \
	MEMBER(vec2, across_y, "1 / P11 (negative where the first row of pixels is that of NDC y = -1), P21 / P11")                    \
	MEMBER(vec2, aside, "-P30 / P00, -P31 / P11")                                                                                  \
	MEMBER(float, w_slope, "w after the projection, of a depth d: w_slope * d + w_start")                                          \
	MEMBER(float, w_start, "see w_slope")                                                                                          \
	MEMBER(ivec2, first, "first pixel with depth")                                                                                 \
	MEMBER(ivec2, last, "last pixel with depth")                                                                                   \
	MEMBER(vec4, depth, "depth at a device depth t away from the far end: (x + y * t) / (z + w * t)")                              \
	MEMBER(vec2, origin, "the picture's first pixel in the texture")                                                               \
	MEMBER(float, far_end, "what device depth is at the far end, 0 or 1")                                                          \
	MEMBER(float, depth_step, "a depth may be off by depth_step * w * w + depth_share * depth")                                    \
	MEMBER(float, depth_share, "see depth_step")                                                                                   \
	MEMBER(float, normal_error, "sine of the angle by which a normal may be off")                                                  \
	MEMBER(float, radius, "in metres, or in the unit of your depths")                                                              \
	MEMBER(float, second_radius, "volumetric obscurance: in the unit of the radius")                                               \
	MEMBER(float, third_radius, "volumetric obscurance: in the unit of the radius")                                                \
	MEMBER(float, thickness, "volumetric obscurance: of surfaces, in the unit of the radius")                                      \
	MEMBER(float, second_thickness, "the same for the second radius")                                                              \
	MEMBER(float, third_thickness, "the same for the third radius")                                                                \
	MEMBER(float, first_band_px, "of the bands: below a radius of so many pixels the first one's samples are taken")               \
	MEMBER(float, second_band_px, "of three bands: below it the first two's")                                                      \
	MEMBER(float, most_px, "most pixels of a radius in the picture")                                                               \
	MEMBER(float, least_px, "least pixels of a radius in the picture")                                                             \
	MEMBER(float, sigma, "Alchemy: intensity")                                                                                     \
	MEMBER(float, contrast, "Alchemy: k")                                                                                          \
	MEMBER(float, beta, "Alchemy: bias, a share of the depth")                                                                     \
	MEMBER(float, epsilon, "Alchemy: in squares of the radius")                                                                    \
	MEMBER(float, box_height, "statistical volumetric obscurance: height of the box in radii")                                     \
	MEMBER(float, slope, "statistical volumetric obscurance: slope of psi")                                                        \
	MEMBER(float, largest_px, "statistical volumetric obscurance: largest half side of the box in pixels")                         \
	MEMBER(float, least_box_px, "statistical volumetric obscurance: least half side of the box in pixels")                         \
	MEMBER(float, slice_thickness, "slices: of surfaces at the reach, in radii")                                                   \
	MEMBER(float, strength, "factor of the obscurance")                                                                            \
	MEMBER(float, power, "of visibility, after the strength")                                                                      \
	MEMBER(float, frame, "its number, for tiles of several frames")

// Of methods to compare with (rivals_*.glsl), never emitted.
#define NOOK_RIVAL_MEMBERS(MEMBER)                                                                                                 \
	MEMBER(float, crytek_range, "radii in front from which a sample counts as 1/2")                                                \
	MEMBER(float, hbao_sine, "sine of the angle bias")                                                                             \
	MEMBER(float, hbao_cosine, "cosine of the angle bias")                                                                         \
	MEMBER(float, sao_intensity, "factor of the obscurance")                                                                       \
	MEMBER(float, sao_bias, "height over the tangent plane that counts for nothing, in radii")                                     \
	MEMBER(float, sao_epsilon, "in squares of the radius")                                                                         \
	MEMBER(float, gtao_falloff, "radii from which horizons fade")                                                                  \
	MEMBER(float, gtao_thickness, "share of the way down that a lower step brings a horizon")                                      \
	MEMBER(float, bitmask_thickness, "of surfaces, in radii")                                                                      \
	MEMBER(float, bitmask_round, "added to a number of sectors before it is cut off")

// Known when a shader is made: numbers in its text, where kernels say NOOK_NAME, and blocks of #if. On the CPU members as well.
// CONSTANT(name, default, what it means).
#define NOOK_SHADE_CONSTANTS(CONSTANT)                                                                                             \
	CONSTANT(samples, 0, "of a variant")                                                                                           \
	CONSTANT(window, 0, "side of the window of variants, pixels")                                                                  \
	CONSTANT(variant, 0, "what makes a pixel's variant that of a frame (variantOfFrame in tile.h), or of --debug noise")           \
	CONSTANT(variants, 0, "drawn so far (--debug noise)")                                                                          \
	CONSTANT(use_normal, 0, "1: above the tangent plane alone")                                                                    \
	CONSTANT(cut, 0, "1: Alchemy's")                                                                                               \
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
	CONSTANT(steps, 0, "hbao: along each direction; slices: on either side")
