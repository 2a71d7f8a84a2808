// Made by: nook emit --methods statvo
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
// For C++17 and later. Every GLSL module of this version of nook has this block.
#ifndef NOOK_STATVO_H
#define NOOK_STATVO_H

#include <cmath>
#include <cstddef>
#include <cstdint>

#ifndef NOOK_BLOCK_H
#define NOOK_BLOCK_H

// The uniform block nook_block, std140: copy it into your buffer as it is.
struct alignas(16) nook_block
{
	float size[4]; // width and height of the picture in pixels, 1 / width, 1 / height
	float across_x[4]; // of the projection P: 1 / P00, P20 / P00, -P30 / P00 (P20: column 2, row 0)
	float across_y[4]; // 1 / P11 (negative where the first row of pixels is that of NDC y = -1), P21 / P11, -P31 / P11
	float w[4]; // w after the projection, of a depth d: x * d + y; z: what device depth is at the far end
	float origin[4]; // the picture's first pixel in the texture
	std::int32_t rect[4]; // first and last pixel with depth: x, y, x, y
	float depth[4]; // depth at a device depth t away from the far end: (x + y * t) / (z + w * t)
	float error[4]; // of a depth: x * w * w + y * depth; z: sine of the angle by which a normal may be off
	float radius[4]; // x: radius in metres, or in the unit of your depths
	float alchemy[4]; // Alchemy: sigma, contrast k, beta, epsilon
	float volume[4]; // volumetric obscurance: x thickness of surfaces, y second radius, in the unit of the radius
	float limits[4]; // of the bands: below a radius of x pixels the first one's samples, below y the first two's; z, w: most, least pixels
	float statvo[4]; // statistical volumetric obscurance: height of the box in radii, slope of psi, its largest and least half side in pixels
	float slices[4]; // slices: x thickness of surfaces, in radii
};
static_assert(sizeof(nook_block) == 224, "std140");
static_assert(offsetof(nook_block, size) == 0, "std140");
static_assert(offsetof(nook_block, across_x) == 16, "std140");
static_assert(offsetof(nook_block, across_y) == 32, "std140");
static_assert(offsetof(nook_block, w) == 48, "std140");
static_assert(offsetof(nook_block, origin) == 64, "std140");
static_assert(offsetof(nook_block, rect) == 80, "std140");
static_assert(offsetof(nook_block, depth) == 96, "std140");
static_assert(offsetof(nook_block, error) == 112, "std140");
static_assert(offsetof(nook_block, radius) == 128, "std140");
static_assert(offsetof(nook_block, alchemy) == 144, "std140");
static_assert(offsetof(nook_block, volume) == 160, "std140");
static_assert(offsetof(nook_block, limits) == 176, "std140");
static_assert(offsetof(nook_block, statvo) == 192, "std140");
static_assert(offsetof(nook_block, slices) == 208, "std140");

struct nook_settings
{
	int width = 0; // of the picture that the projection makes, pixels
	int height = 0;
	int x = 0; // its first pixel in the textures, as texelFetch counts
	int y = 0;
	int guard = 0; // pixels around it that hold depth and normals, too
	int first_row_ndc_y = -1; // which edge row 0 of the pixels is at: -1 OpenGL and Vulkan, 1 Direct3D
	double radius = 0.5; // metres, or in the unit of your depths; > 0
	double most_pixels = 0.0; // greatest radius in the picture, near the camera; 0: the height of the picture
	double least_pixels = 0.0; // least radius in the picture, far away
	bool device_depth = false; // of a module emitted with --depth device
	bool zero_to_one = false; // device depth: NDC z from 0 to 1 (Vulkan, Direct3D, Metal), else from -1
	int depth_bits = 32; // 16, 24 or 32; device depth of 16 and 24 bits: whole numbers; all others: floats
	int normal_bits = 32; // of a component: 8 to 16, or 32
	double second_radius = 0.0; // of a module with two radii; 0: as the first
	double thickness = 0.0; // of a module with a thickness: of surfaces, in the unit of the radius
	double first_band = 16.0; // of a module with bands: radius in pixels below which the first band is enough
	double second_band = 48.0; // of a module with three bands: below which the first two are
	double box_height = 1.0; // StatVO: of the box over the surface, in radii
	double slope = 1.0; // StatVO: how fast what is farther in front stops counting, per height
	double largest_pixels = 127.0; // StatVO: half side of the box in the picture at most; 255 or less
	double slice_thickness = 0.65; // slices: of surfaces, in radii
	double sigma = 1.0; // Alchemy: intensity, with lengths in units of the radius
	double contrast = 1.0; // Alchemy: the power at the end
	double beta = 1.0e-04; // Alchemy: bias, a share of the depth
	double epsilon = 1.0e-04; // Alchemy: keeps the quotient finite, in squares of the radius
};

// Fills the block from settings and a projection: 16 numbers, column by column, from view space (right-handed, looking down -z)
// to clip space; perspective or orthographic, reversed, infinite, off-centre, jittered. False, and nothing filled, where x or y of
// the picture depends on the other (a skew), where a setting is out of range, or with device depth where z depends on x or y.
template <class number> inline bool nook_fill(nook_block& block, const number (&projection)[16], const nook_settings& settings)
{
	double p[16];
	for (int i = 0; i < 16; ++i)
	{
		p[i] = static_cast<double>(projection[i]);
	}
	const bool skewed = p[1] != 0.0 || p[3] != 0.0 || p[4] != 0.0 || p[7] != 0.0 || p[0] == 0.0 || p[5] == 0.0;
	const bool bits = (settings.depth_bits == 16 || settings.depth_bits == 24 || settings.depth_bits == 32) &&
					  ((settings.normal_bits >= 8 && settings.normal_bits <= 16) || settings.normal_bits == 32);
	const bool in_range = settings.width > 0 && settings.height > 0 && settings.guard >= 0 && settings.radius > 0.0 &&
						  settings.most_pixels >= 0.0 && settings.least_pixels >= 0.0 &&
						  settings.box_height > 0.0 && settings.slope > 0.0 && settings.largest_pixels >= 1.0 &&
						  settings.largest_pixels <= 255.0 && settings.second_radius >= 0.0 && settings.thickness >= 0.0 &&
						  settings.first_band >= 0.0 && settings.second_band >= 0.0 && settings.sigma >= 0.0 &&
						  settings.contrast > 0.0 && settings.slice_thickness > 0.0 && settings.beta >= 0.0 && settings.epsilon > 0.0 &&
						  settings.least_pixels <= (settings.most_pixels > 0.0 ? settings.most_pixels : settings.height) &&
						  (settings.first_row_ndc_y == -1 || settings.first_row_ndc_y == 1);
	if (skewed || !in_range || !bits)
	{
		return false;
	}
	const double width = settings.width;
	const double height = settings.height;
	// StatVO: what is so far away that the box would be smaller needs finer tables.
	const double longer = (width > height ? width : height) + 2.0 * settings.guard;
	const double reach = 2.0 * settings.largest_pixels + 2.0;
	const double table_steps = std::fmin(4294967295.0 / (reach * reach), 4194304.0);
	const double least_box = std::fmax(0.5, std::sqrt(191.0 * longer / (table_steps * settings.box_height)));
	const double first_row = settings.first_row_ndc_y;
	const double most_pixels = settings.most_pixels > 0.0 ? settings.most_pixels : height;
	const double normal_error =
		settings.normal_bits == 32 ? 0.0 : std::sqrt(3.0) / (std::ldexp(1.0, settings.normal_bits) - 1.0);
	// z of the clip space is scale * device + least; a step of it is a length of w * w / |det|, and grows toward the far end.
	double far_end = 0.0;
	double turn = 0.0;
	double above = 0.0;
	double below = 0.0;
	double near_end = 1.0;
	double half_step = 0.0;
	double rounding = settings.depth_bits == 16 ? 0x1p-11 : 0x1p-24;
	if (settings.device_depth)
	{
		const double det = p[10] * p[15] - p[11] * p[14];
		const double scale = settings.zero_to_one ? 1.0 : 2.0;
		const double least = settings.zero_to_one ? 0.0 : -1.0;
		far_end = det < 0.0 ? 1.0 : 0.0;
		turn = det < 0.0 ? -scale : scale;
		above = p[14] - p[15] * (least + far_end * scale);
		below = p[10] - p[11] * (least + far_end * scale);
		near_end = below - p[11] * turn;
		if (!std::isfinite(det) || det == 0.0 || near_end == 0.0 || p[2] != 0.0 || p[6] != 0.0)
		{
			return false;
		}
		const double steps = settings.depth_bits == 32 ? 0.0 : 0.5 / (std::ldexp(1.0, settings.depth_bits) - 1.0);
		half_step = (steps + far_end * 0x1p-25) * scale / std::fabs(det) + (p[15] == 0.0 ? 0.0 : 0x1p-22 * std::fabs(above / near_end));
		rounding = 0x1.8p-22;
	}
	block.size[0] = static_cast<float>(width);
	block.size[1] = static_cast<float>(height);
	block.size[2] = static_cast<float>(1.0 / width);
	block.size[3] = static_cast<float>(1.0 / height);
	block.across_x[0] = static_cast<float>(1.0 / p[0]);
	block.across_x[1] = static_cast<float>(p[8] / p[0]);
	block.across_x[2] = static_cast<float>(-p[12] / p[0]);
	block.across_x[3] = 0;
	block.across_y[0] = static_cast<float>(first_row / p[5]);
	block.across_y[1] = static_cast<float>(p[9] / p[5]);
	block.across_y[2] = static_cast<float>(-p[13] / p[5]);
	block.across_y[3] = 0;
	block.w[0] = static_cast<float>(-p[11]);
	block.w[1] = static_cast<float>(p[15]);
	block.w[2] = static_cast<float>(far_end);
	block.w[3] = 0;
	block.origin[0] = static_cast<float>(settings.x);
	block.origin[1] = static_cast<float>(settings.y);
	block.origin[2] = 0;
	block.origin[3] = 0;
	block.rect[0] = static_cast<std::int32_t>(settings.x - settings.guard);
	block.rect[1] = static_cast<std::int32_t>(settings.y - settings.guard);
	block.rect[2] = static_cast<std::int32_t>(settings.x + settings.width - 1 + settings.guard);
	block.rect[3] = static_cast<std::int32_t>(settings.y + settings.height - 1 + settings.guard);
	block.depth[0] = static_cast<float>(above / near_end);
	block.depth[1] = static_cast<float>((0.0 - p[15] * turn) / near_end);
	block.depth[2] = static_cast<float>(below / near_end);
	block.depth[3] = static_cast<float>((0.0 - p[11] * turn) / near_end);
	block.error[0] = static_cast<float>(half_step);
	block.error[1] = static_cast<float>(rounding);
	block.error[2] = static_cast<float>(normal_error);
	block.error[3] = 0;
	block.radius[0] = static_cast<float>(settings.radius);
	block.radius[1] = 0;
	block.radius[2] = 0;
	block.radius[3] = 0;
	block.alchemy[0] = static_cast<float>(settings.sigma);
	block.alchemy[1] = static_cast<float>(settings.contrast);
	block.alchemy[2] = static_cast<float>(settings.beta);
	block.alchemy[3] = static_cast<float>(settings.epsilon);
	block.volume[0] = static_cast<float>(settings.thickness);
	block.volume[1] = static_cast<float>(settings.second_radius > 0.0 ? settings.second_radius : settings.radius);
	block.volume[2] = 0;
	block.volume[3] = 0;
	block.limits[0] = static_cast<float>(settings.first_band);
	block.limits[1] = static_cast<float>(settings.second_band);
	block.limits[2] = static_cast<float>(most_pixels);
	block.limits[3] = static_cast<float>(settings.least_pixels);
	block.statvo[0] = static_cast<float>(settings.box_height);
	block.statvo[1] = static_cast<float>(settings.slope);
	block.statvo[2] = static_cast<float>(settings.largest_pixels);
	block.statvo[3] = static_cast<float>(least_box);
	block.slices[0] = static_cast<float>(settings.slice_thickness);
	block.slices[1] = 0;
	block.slices[2] = 0;
	block.slices[3] = 0;
	return true;
}

#endif // NOOK_BLOCK_H

#endif // NOOK_STATVO_H
