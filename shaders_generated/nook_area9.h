// Made by: nook emit --methods vo-area --patterns disk_009_tile4.json --recipe paper
// Version: nook 0.1.0
// Base pattern: nook tile --pattern disk_009.json --size 4
// SPDX-License-Identifier: MIT
//
// Fills the uniform block of a GLSL module that nook emitted: C++17 and later, no dependencies. All modules of one version of
// nook share nook_block, nook_settings and nook_fill.
#if defined(NOOK_VO_AREA_SETTINGS) && NOOK_VO_AREA_SETTINGS != 0
#error nook: another header with this method reads depth in another way, emit one of them with --namespace
#endif
#ifndef NOOK_VO_AREA_H
#define NOOK_VO_AREA_H

#ifndef NOOK_BLOCK_H
#define NOOK_BLOCK_H

#include <cmath>
#include <cstddef>
#include <cstdint>

// The uniform block nook_block in std140 layout: copy it into your buffer as it is.
struct alignas(16) nook_block
{
	float size[2];          // width and height of the picture, pixels
	float pixel_size[2];    // 1 / width, 1 / height
	float across_x[2];      // turns NDC x back into view-space x: 1 / P[0][0], P[2][0] / P[0][0] of the projection P[column][row]
	float across_y[2];      // the same for y: 1 / P[1][1], P[2][1] / P[1][1]; the first negated where row 0 is at NDC y = -1
	float aside[2];         // the shift of an off-centre orthographic projection: -P[3][0] / P[0][0], -P[3][1] / P[1][1]
	float w_slope;          // clip-space w at a depth d is w_slope * d + w_start: perspective has 1 and 0, orthographic 0 and 1
	float w_start;          // see w_slope
	std::int32_t first[2];  // first pixel whose depth may be read, guard band included
	std::int32_t last[2];   // last pixel whose depth may be read, guard band included
	float depth[4];         // device depth back to linear depth: (x + y * t) / (z + w * t), where t = abs(stored value - far_end)
	float origin[2];        // first pixel of the picture in its textures
	float far_end;          // what the depth buffer holds at the far plane: 1, or 0 where depth is reversed
	float depth_step;       // a stored depth may be off by depth_step * w * w + depth_share * depth, which is its rounding
	float depth_share;      // see depth_step
	float normal_error;     // sine of the angle by which rounding may turn a stored normal
	float radius;           // surfaces closer than this occlude; metres, or the unit of your depths
	float second_radius;    // volumetric obscurance: a second radius whose result is combined with the first
	float third_radius;     // volumetric obscurance: a third radius
	float thickness;        // volumetric obscurance: how far a surface goes on behind what is seen, in the unit of the radius
	float second_thickness; // thickness for the second radius
	float third_thickness;  // thickness for the third radius
	float first_band_px;    // with bands: a radius of fewer pixels takes the samples of the first band only
	float second_band_px;   // with three bands: a radius of fewer pixels takes the samples of the first two
	float most_px;          // largest radius in the picture, pixels
	float least_px;         // smallest radius in the picture, pixels
	float sigma;            // Alchemy: intensity
	float contrast;         // Alchemy: exponent of the result
	float beta;             // Alchemy: bias against self-occlusion, as a share of the depth
	float epsilon;          // Alchemy: keeps the quotient finite, in squared radii
	float box_height;       // statistical volumetric obscurance: height of the box over the surface, in radii
	float slope;           // statistical volumetric obscurance: how fast surfaces in front of the box stop counting, per box height
	float largest_px;      // statistical volumetric obscurance: largest half side of the box, pixels
	float least_box_px;    // statistical volumetric obscurance: a box with a smaller half side, in pixels, reads as open
	float slice_thickness; // slices: thickness of a surface at a distance of one radius, in radii
	float strength;        // factor of the obscurance, which is 1 - visibility
	float power;           // exponent of the visibility, after the strength
	float frame;           // number of the frame, for tiles whose samples change from frame to frame
};
static_assert(sizeof(nook_block) == 192, "std140");
static_assert(offsetof(nook_block, size) == 0, "std140");
static_assert(offsetof(nook_block, pixel_size) == 8, "std140");
static_assert(offsetof(nook_block, across_x) == 16, "std140");
static_assert(offsetof(nook_block, across_y) == 24, "std140");
static_assert(offsetof(nook_block, aside) == 32, "std140");
static_assert(offsetof(nook_block, w_slope) == 40, "std140");
static_assert(offsetof(nook_block, w_start) == 44, "std140");
static_assert(offsetof(nook_block, first) == 48, "std140");
static_assert(offsetof(nook_block, last) == 56, "std140");
static_assert(offsetof(nook_block, depth) == 64, "std140");
static_assert(offsetof(nook_block, origin) == 80, "std140");
static_assert(offsetof(nook_block, far_end) == 88, "std140");
static_assert(offsetof(nook_block, depth_step) == 92, "std140");
static_assert(offsetof(nook_block, depth_share) == 96, "std140");
static_assert(offsetof(nook_block, normal_error) == 100, "std140");
static_assert(offsetof(nook_block, radius) == 104, "std140");
static_assert(offsetof(nook_block, second_radius) == 108, "std140");
static_assert(offsetof(nook_block, third_radius) == 112, "std140");
static_assert(offsetof(nook_block, thickness) == 116, "std140");
static_assert(offsetof(nook_block, second_thickness) == 120, "std140");
static_assert(offsetof(nook_block, third_thickness) == 124, "std140");
static_assert(offsetof(nook_block, first_band_px) == 128, "std140");
static_assert(offsetof(nook_block, second_band_px) == 132, "std140");
static_assert(offsetof(nook_block, most_px) == 136, "std140");
static_assert(offsetof(nook_block, least_px) == 140, "std140");
static_assert(offsetof(nook_block, sigma) == 144, "std140");
static_assert(offsetof(nook_block, contrast) == 148, "std140");
static_assert(offsetof(nook_block, beta) == 152, "std140");
static_assert(offsetof(nook_block, epsilon) == 156, "std140");
static_assert(offsetof(nook_block, box_height) == 160, "std140");
static_assert(offsetof(nook_block, slope) == 164, "std140");
static_assert(offsetof(nook_block, largest_px) == 168, "std140");
static_assert(offsetof(nook_block, least_box_px) == 172, "std140");
static_assert(offsetof(nook_block, slice_thickness) == 176, "std140");
static_assert(offsetof(nook_block, strength) == 180, "std140");
static_assert(offsetof(nook_block, power) == 184, "std140");
static_assert(offsetof(nook_block, frame) == 188, "std140");

struct nook_settings
{
	int width = 0; // of the picture that the projection makes, pixels
	int height = 0;
	int x = 0; // first pixel of the picture in the textures, as texelFetch counts
	int y = 0;
	int guard = 0; // pixels around the picture that hold depth and normals as well, for the neighbours of its border
	// The NDC y, by the projection that you pass, of the edge where row 0 of texelFetch lies. If the floor is black, flip this.
	// -1: OpenGL, OpenGL ES, WebGL; Vulkan.
	// 1: Direct3D, Metal, WebGPU; Vulkan with a viewport of negative height; OpenGL with GL_UPPER_LEFT (glClipControl); engines
	// that draw their OpenGL render targets upside down, as OGRE does, where you pass the projection that is not flipped.
	int first_row_ndc_y = -1;
	double radius = 0.5;        // surfaces closer than this occlude; metres, or the unit of your depths; > 0
	double most_pixels = 0.0;   // largest radius in the picture, near the camera; 0: the height of the picture
	double least_pixels = 0.0;  // smallest radius in the picture, far away
	bool device_depth = false;  // true for modules emitted with --depth device; nook_..._settings() sets it
	bool zero_to_one = false;   // device depth: NDC z runs from 0 to 1 (Vulkan, Direct3D, Metal, WebGPU), else from -1 to 1
	int depth_bits = 32;        // of the depth that the module reads; device depth of 16 and 24 bits: integers; all others: floats
	int normal_bits = 32;       // of each component: 8 to 16, or 32
	double second_radius = 0.0; // modules with two radii; 0: as radius
	double third_radius = 0.0;  // modules with three radii; 0: as radius
	double thickness = 0.0;     // modules with a thickness: how far surfaces go on behind what is seen, in the unit of the radius
	double second_thickness = 0.0; // for the second radius; 0: as thickness
	double third_thickness = 0.0;  // for the third radius; 0: as thickness
	double first_band = 16.0;      // modules with bands: a radius of fewer pixels takes the samples of the first band only
	double second_band = 48.0;     // modules with three bands: a radius of fewer pixels takes the samples of the first two
	double box_height = 1.0;       // statistical volumetric obscurance: height of the box over the surface, in radii
	double slope = 1.0;            // statistical volumetric obscurance: how fast surfaces in front of the box stop counting
	double largest_pixels = 127.0; // statistical volumetric obscurance: largest half side of the box, 1 to 255
	double sigma = 1.0;            // Alchemy: intensity, with lengths in radii
	double contrast = 1.0;         // Alchemy: exponent of the result
	double beta = 1e-4;            // Alchemy: bias against self-occlusion, as a share of the depth
	double epsilon = 1e-4;         // Alchemy: keeps the quotient finite, in squared radii
	double slice_thickness = 0.65; // slices: thickness of a surface at a distance of one radius, in radii
	double strength = 1.0;         // modules with strength or power: factor of the obscurance, which is 1 - visibility
	double power = 1.0;            // modules with strength or power: exponent of the visibility, after the strength
	int frame = 0;                 // modules with a tile of several frames: number of the frame, 0 to 16777216
};

// Turns NDC x (row 0) or y (row 1) back into view-space lengths, for a projection P[column][row] without a skew.
struct nook_row_numbers
{
	double scale = 0.0; // 1 / P[row][row]
	double shear = 0.0; // P[2][row] / P[row][row]
	double aside = 0.0; // -P[3][row] / P[row][row]
};
inline nook_row_numbers nook_row_of(const double (&p)[16], int row)
{
	const double own = p[5 * row];
	nook_row_numbers numbers;
	numbers.scale = 1.0 / own;
	numbers.shear = p[8 + row] / own;
	numbers.aside = -p[12 + row] / own;
	return numbers;
}

// Turns the numbers of a depth buffer back into depths, and says how exact those are.
struct nook_depth_numbers
{
	double terms[4] = {};   // depth = ([0] + [1] * t) / ([2] + [3] * t), where t = |stored value - far_end|
	double far_end = 0.0;   // stored value of the far plane, 0 or 1
	double half_step = 0.0; // rounding of the buffer, for w = 1
	double rounding = 0.0;  // rounding of the arithmetic, as a share of the depth
};

// Returns false and fills nothing where z depends on x or y, or not on depth.
inline bool nook_depth_of(nook_depth_numbers& depth, const double (&p)[16], bool zero_to_one, int bits)
{
	// With z_ndc = scale * device + least and clip z = w * z_ndc, depth = (a + b * device) / (c + e * device). The determinant of
	// the lower right 2 x 2 numbers decides which end is far (its sign) and how long a step of device depth is (w^2 / |det|).
	const double det = p[10] * p[15] - p[11] * p[14];
	const double scale = zero_to_one ? 1.0 : 2.0;
	const double least = zero_to_one ? 0.0 : -1.0;
	const double far_end = det < 0.0 ? 1.0 : 0.0;
	const double turn = det < 0.0 ? -scale : scale; // change of z_ndc away from the far plane
	const double end = least + far_end * scale;     // z_ndc of the far plane
	const double above = p[14] - p[15] * end;
	const double below = p[10] - p[11] * end;
	const double near_end = below - p[11] * turn; // the denominator at the near plane; dividing by it makes that denominator 1
	if (!std::isfinite(det) || det == 0.0 || near_end == 0.0 || p[2] != 0.0 || p[6] != 0.0)
	{
		return false;
	}
	const double terms[4] = {above / near_end, (0.0 - p[15] * turn) / near_end, below / near_end, (0.0 - p[11] * turn) / near_end};
	for (int i = 0; i < 4; ++i)
	{
		depth.terms[i] = terms[i];
	}
	depth.far_end = far_end;
	// Half a step of the format, and where the far plane is at 1 half a step of the 32-bit floats as which shaders read every
	// format. Orthographic projections subtract from the depth of the far plane, so the rounding of that depth stays in the
	// difference.
	const double steps = bits == 32 ? 0.0 : 0.5 / (std::ldexp(1.0, bits) - 1.0);
	const double sums = p[15] == 0.0 ? 0.0 : 0x1p-22 * std::fabs(terms[0]);
	depth.half_step = (steps + far_end * 0x1p-25) * scale / std::fabs(det) + sums;
	depth.rounding = 0x1.8p-22; // six roundings: the value, two coefficients, a product, the sum and the quotient
	return true;
}

// Sine of the angle by which rounding may turn a normal with `bits` bits per component: half a step in each of the three.
inline double nook_normal_error(int bits)
{
	return bits == 32 ? 0.0 : std::sqrt(3.0) / (std::ldexp(1.0, bits) - 1.0);
}

// Statistical volumetric obscurance: the smallest half side k of a box in the picture, in pixels, at which rounding positions to
// integers stays invisible, below 1/255 of the height h r of the box (r: the radius). In a picture of w pixels, positions at that
// depth span w r / k. Rounding leaves the mean of (2k + 1)^2 positions off by 0.29 steps / (2k + 1) in each axis; 5 times that is
// 1/255 of h r where k (2k + 1) steps = 382 w / h.
inline double nook_least_box(double longer, double largest_pixels, double box_height)
{
	const double side = 2.0 * largest_pixels + 2.0;
	const double steps = std::fmin(4294967295.0 / (side * side), 4194304.0);
	return std::fmax(0.5, std::sqrt(191.0 * longer / (steps * box_height)));
}

inline bool nook_is_positive(double value)
{
	return value > 0.0 && std::isfinite(value);
}
inline bool nook_is_not_negative(double value)
{
	return value >= 0.0 && std::isfinite(value);
}

// True if w, given by the factors of x, y, z and 1, is that of a usual engine projection.
inline bool nook_is_usual_w(double x, double y, double z, double one)
{
	const bool perspective = std::fabs(std::fabs(z) - 1.0) <= 1e-5 && one == 0.0;
	const bool orthographic = z == 0.0 && one != 0.0;
	return x == 0.0 && y == 0.0 && (perspective || orthographic);
}

// Returns the reason why nook_fill rejects a projection, or null.
inline const char* nook_projection_fault(const double (&p)[16])
{
	for (int i = 0; i < 16; ++i)
	{
		if (!std::isfinite(p[i]))
		{
			return "projection: found infinity or NaN, expected 16 finite numbers";
		}
	}
	if (!nook_is_usual_w(p[3], p[7], p[11], p[15]) && nook_is_usual_w(p[12], p[13], p[14], p[15]))
	{
		return "projection: looks row-major: transpose it";
	}
	if (p[1] != 0.0 || p[3] != 0.0 || p[4] != 0.0 || p[7] != 0.0)
	{
		return "projection: found a skew, expected 0 in numbers 1, 3, 4 and 7 (the projection alone, without the view)";
	}
	if (p[0] == 0.0 || p[5] == 0.0)
	{
		return "projection: found 0 for the scale of x or y, expected other numbers 0 and 5";
	}
	if (p[11] > 0.0)
	{
		return "projection: looks left-handed: w = +z; negate numbers 8 to 11, and z of the normals";
	}
	if (p[11] == 0.0 && p[15] <= 0.0)
	{
		return "projection: found w = 0 or less at every depth, expected w = -z, or 1 for an orthographic one";
	}
	// Depths on the view axis at NDC z = 0 and 1, which belong to both ranges of NDC z, are p[14] / p[10] and above / below. Only
	// their signs matter, and a denominator of 0 is an infinite depth.
	const double above = p[14] - p[15];
	const double below = p[10] - p[11];
	const bool behind = p[14] * p[10] <= 0.0 && above * below <= 0.0 && p[10] != 0.0 && below != 0.0;
	if (behind && p[2] == 0.0 && p[6] == 0.0)
	{
		if (p[11] == 0.0)
		{
			return "projection: looks left-handed: near and far are behind the camera; negate numbers 8 to 11, and z of the "
				   "normals";
		}
		return "projection: found near and far planes behind the camera, expected NDC z of 0 and 1 in front of it";
	}
	return nullptr;
}

// Returns the reason why nook_fill rejects settings, or null.
inline const char* nook_settings_fault(const nook_settings& settings)
{
	if (settings.width <= 0 || settings.height <= 0)
	{
		return "settings: width, height: expected 1 or more";
	}
	if (settings.guard < 0)
	{
		return "settings: guard: expected 0 or more";
	}
	if (settings.width > 16777216 || settings.height > 16777216 || settings.guard > 16777216)
	{
		return "settings: width, height, guard: expected at most 16777216";
	}
	if (settings.x > 16777216 || settings.y > 16777216 || settings.x < -16777216 || settings.y < -16777216)
	{
		return "settings: x, y: expected -16777216 to 16777216";
	}
	if (settings.first_row_ndc_y != -1 && settings.first_row_ndc_y != 1)
	{
		return "settings: first_row_ndc_y: expected -1 or 1";
	}
	if (!nook_is_positive(settings.radius))
	{
		return "settings: radius: expected a number above 0";
	}
	if (!nook_is_not_negative(settings.most_pixels) || !nook_is_not_negative(settings.least_pixels))
	{
		return "settings: most_pixels, least_pixels: expected 0 or more";
	}
	if (settings.least_pixels > (settings.most_pixels > 0.0 ? settings.most_pixels : settings.height))
	{
		return "settings: least_pixels: expected at most most_pixels, which is the height of the picture where it is 0";
	}
	if (settings.depth_bits != 16 && settings.depth_bits != 24 && settings.depth_bits != 32)
	{
		return "settings: depth_bits: expected 16, 24 or 32";
	}
	if ((settings.normal_bits < 8 || settings.normal_bits > 16) && settings.normal_bits != 32)
	{
		return "settings: normal_bits: expected 8 to 16, or 32";
	}
	if (!nook_is_not_negative(settings.second_radius) || !nook_is_not_negative(settings.third_radius))
	{
		return "settings: second_radius, third_radius: expected 0 or more";
	}
	if (!nook_is_not_negative(settings.thickness) || !nook_is_not_negative(settings.second_thickness) ||
		!nook_is_not_negative(settings.third_thickness))
	{
		return "settings: thickness, second_thickness, third_thickness: expected 0 or more";
	}
	if (!nook_is_not_negative(settings.first_band) || !nook_is_not_negative(settings.second_band))
	{
		return "settings: first_band, second_band: expected 0 or more";
	}
	if (!nook_is_positive(settings.box_height) || !nook_is_positive(settings.slope))
	{
		return "settings: box_height, slope: expected numbers above 0";
	}
	if (!(settings.largest_pixels >= 1.0 && settings.largest_pixels <= 255.0))
	{
		return "settings: largest_pixels: expected 1 to 255";
	}
	if (!nook_is_not_negative(settings.sigma) || !nook_is_not_negative(settings.beta))
	{
		return "settings: sigma, beta: expected 0 or more";
	}
	if (!nook_is_positive(settings.contrast) || !nook_is_positive(settings.epsilon))
	{
		return "settings: contrast, epsilon: expected numbers above 0";
	}
	if (!nook_is_positive(settings.slice_thickness))
	{
		return "settings: slice_thickness: expected a number above 0";
	}
	if (!nook_is_positive(settings.strength) || !nook_is_positive(settings.power))
	{
		return "settings: strength, power: expected numbers above 0";
	}
	if (settings.frame < 0 || settings.frame > 16777216)
	{
		return "settings: frame: expected 0 to 16777216";
	}
	return nullptr;
}

// Fills the block from settings and a projection: 16 numbers in column-major order, from view space (right-handed, looking down -z)
// to clip space; perspective or orthographic, reversed, infinite, off-centre, jittered. Returns null, or the reason why it filled
// nothing: a projection that looks row-major or left-handed, has a skew or numbers that are not finite, or with device depth a z
// that depends on x or y; a setting out of range.
template <class number>
[[nodiscard]] inline const char* nook_fill(nook_block& block, const number (&projection)[16], const nook_settings& settings)
{
	double p[16];
	for (int i = 0; i < 16; ++i)
	{
		p[i] = static_cast<double>(projection[i]);
	}
	const char* const wrong_projection = nook_projection_fault(p);
	if (wrong_projection != nullptr)
	{
		return wrong_projection;
	}
	const char* const wrong_settings = nook_settings_fault(settings);
	if (wrong_settings != nullptr)
	{
		return wrong_settings;
	}
	const double width = settings.width;
	const double height = settings.height;
	const double longer = (width > height ? width : height) + 2.0 * settings.guard;
	const double first_row = settings.first_row_ndc_y;
	const double most_pixels = settings.most_pixels > 0.0 ? settings.most_pixels : height;
	nook_depth_numbers depth;
	depth.rounding = settings.depth_bits == 16 ? 0x1p-11 : 0x1p-24;
	if (settings.device_depth && (p[2] != 0.0 || p[6] != 0.0))
	{
		return "projection: found a z that depends on x or y (an oblique near plane), expected none with device depth";
	}
	if (settings.device_depth && !nook_depth_of(depth, p, settings.zero_to_one, settings.depth_bits))
	{
		return "projection: found a z that does not depend on depth, expected another with device depth";
	}
	block.size[0] = static_cast<float>(width);
	block.size[1] = static_cast<float>(height);
	block.pixel_size[0] = static_cast<float>(1.0 / width);
	block.pixel_size[1] = static_cast<float>(1.0 / height);
	const double sign[2] = {1.0, first_row};
	for (int row = 0; row < 2; ++row)
	{
		const nook_row_numbers across = nook_row_of(p, row);
		float* const scale = row == 0 ? block.across_x : block.across_y;
		scale[0] = static_cast<float>(sign[row] * across.scale);
		scale[1] = static_cast<float>(across.shear);
		block.aside[row] = static_cast<float>(across.aside);
	}
	block.w_slope = static_cast<float>(-p[11]);
	block.w_start = static_cast<float>(p[15]);
	block.first[0] = settings.x - settings.guard;
	block.first[1] = settings.y - settings.guard;
	block.last[0] = settings.x + settings.width - 1 + settings.guard;
	block.last[1] = settings.y + settings.height - 1 + settings.guard;
	for (int i = 0; i < 4; ++i)
	{
		block.depth[i] = static_cast<float>(depth.terms[i]);
	}
	block.origin[0] = static_cast<float>(settings.x);
	block.origin[1] = static_cast<float>(settings.y);
	block.far_end = static_cast<float>(depth.far_end);
	block.depth_step = static_cast<float>(depth.half_step);
	block.depth_share = static_cast<float>(depth.rounding);
	block.normal_error = static_cast<float>(nook_normal_error(settings.normal_bits));
	block.radius = static_cast<float>(settings.radius);
	block.second_radius = static_cast<float>(settings.second_radius > 0.0 ? settings.second_radius : settings.radius);
	block.third_radius = static_cast<float>(settings.third_radius > 0.0 ? settings.third_radius : settings.radius);
	block.thickness = static_cast<float>(settings.thickness);
	block.second_thickness = static_cast<float>(settings.second_thickness > 0.0 ? settings.second_thickness : settings.thickness);
	block.third_thickness = static_cast<float>(settings.third_thickness > 0.0 ? settings.third_thickness : settings.thickness);
	block.first_band_px = static_cast<float>(settings.first_band);
	block.second_band_px = static_cast<float>(settings.second_band);
	block.most_px = static_cast<float>(most_pixels);
	block.least_px = static_cast<float>(settings.least_pixels);
	block.sigma = static_cast<float>(settings.sigma);
	block.contrast = static_cast<float>(settings.contrast);
	block.beta = static_cast<float>(settings.beta);
	block.epsilon = static_cast<float>(settings.epsilon);
	block.box_height = static_cast<float>(settings.box_height);
	block.slope = static_cast<float>(settings.slope);
	block.largest_px = static_cast<float>(settings.largest_pixels);
	block.least_box_px = static_cast<float>(nook_least_box(longer, settings.largest_pixels, settings.box_height));
	block.slice_thickness = static_cast<float>(settings.slice_thickness);
	block.strength = static_cast<float>(settings.strength);
	block.power = static_cast<float>(settings.power);
	block.frame = static_cast<float>(settings.frame);
	return nullptr;
}

#endif // NOOK_BLOCK_H

#ifndef NOOK_VO_AREA_SETTINGS // the first of several headers with this method defines it
#define NOOK_VO_AREA_SETTINGS 0
// Settings of nookVoArea with the radius `reach`, in the unit of your depths. Set width and height.
inline nook_settings nook_vo_area_settings(double reach)
{
	nook_settings settings;
	settings.radius = reach;
	return settings;
}
#endif

// Texels of the texture nook_vo_area_tile, row by row: RGBA, 32-bit floats, 16 x 9, without filtering.
inline constexpr int nook_vo_area_tile_width = 16;
inline constexpr int nook_vo_area_tile_height = 9;
inline constexpr float nook_vo_area_tile[144][4] = {
	{0.7773644f, -0.4663263f, -0.91542697f, 0.06854852f},
	{0.75059134f, -0.17328456f, -0.7386771f, 0.09730705f},
	{0.9212302f, -0.002708781f, -0.9855658f, 0.061450265f},
	{0.6976454f, 0.29326177f, -0.7306666f, 0.098123886f},
	{0.42419398f, 0.67409754f, -0.7862857f, 0.08749958f},
	{0.16175462f, 0.60555315f, -0.61227834f, 0.12959932f},
	{-0.1630573f, 0.9104897f, -1.075748f, 0.058637973f},
	{-0.36665025f, 0.83781934f, -0.9304337f, 0.06569224f},
	{-0.8533782f, 0.30151308f, -0.94043136f, 0.07195027f},
	{-0.677511f, 0.31518486f, -0.72721124f, 0.09961655f},
	{-0.9104352f, -0.012151152f, -0.93002915f, 0.06633853f},
	{-0.75578034f, -0.2691063f, -0.7709837f, 0.087665044f},
	{-0.5768286f, -0.51692027f, -0.7418173f, 0.09395269f},
	{-0.28818196f, -0.6152787f, -0.63148105f, 0.12216131f},
	{0.22947827f, -0.8677333f, -0.8917188f, 0.07453055f},
	{0.38030747f, -0.84332526f, -0.99849796f, 0.059693165f},
	{-0.16413373f, 0.23683941f, -0.7313432f, 0.16583149f},
	{-0.337897f, 0.14252594f, -0.76969695f, 0.15132831f},
	{-0.12329018f, -0.06146623f, -0.79971397f, 0.1540573f},
	{-0.37196076f, -0.13280448f, -0.7502116f, 0.14909737f},
	{-0.26856184f, -0.28182065f, -0.72487676f, 0.15454158f},
	{-0.10802964f, -0.5087202f, -0.6419295f, 0.13673492f},
	{-0.032147523f, -0.39903006f, -0.7934975f, 0.14079966f},
	{0.08343275f, -0.22329974f, -0.8147036f, 0.14664239f},
	{0.08469169f, -0.05679244f, -0.83302784f, 0.14528264f},
	{0.31772357f, -0.17291266f, -0.79182714f, 0.14737079f},
	{0.30606303f, -0.020215763f, -0.8061431f, 0.14759284f},
	{0.41391346f, 0.082012706f, -0.6739225f, 0.15103419f},
	{0.29264575f, 0.2964935f, -0.6809145f, 0.1534947f},
	{0.19418477f, 0.39912093f, -0.7587223f, 0.1358605f},
	{0.07932032f, 0.31841618f, -0.70587903f, 0.16682632f},
	{-0.0140626365f, 0.2121887f, -0.7928141f, 0.1532322f},
	{-0.37917838f, -0.3575287f, -0.6544109f, 0.13466677f},
	{-0.28473178f, -0.48071262f, -0.60787946f, 0.13980363f},
	{-0.15747838f, -0.7253857f, -0.6915897f, 0.11044317f},
	{0.06514597f, -0.5474733f, -0.64086777f, 0.13256301f},
	{0.32507604f, -0.3759921f, -0.6508087f, 0.13946068f},
	{0.4630523f, -0.09846147f, -0.6112832f, 0.15319607f},
	{0.69108814f, 0.06634365f, -0.6682639f, 0.11499974f},
	{0.54727244f, 0.04757705f, -0.66821504f, 0.12744613f},
	{0.46729636f, 0.31402147f, -0.6098616f, 0.1372437f},
	{0.35067496f, 0.4357938f, -0.63920736f, 0.132802f},
	{0.11576248f, 0.4975842f, -0.69592774f, 0.12609652f},
	{-0.024899954f, 0.5052699f, -0.61106324f, 0.1451875f},
	{-0.28955975f, 0.30789277f, -0.73069596f, 0.14100307f},
	{-0.42572948f, 0.2443164f, -0.6816787f, 0.13511896f},
	{-0.48825583f, 0.084817134f, -0.65013003f, 0.14145085f},
	{-0.51297885f, -0.058082607f, -0.6418859f, 0.1392575f},
	{0.56166327f, 0.19168802f, -0.60534394f, 0.13490628f},
	{0.5095224f, 0.46817806f, -0.6692575f, 0.116999134f},
	{0.39749277f, 0.816752f, -0.9445794f, 0.0658446f},
	{0.16038516f, 0.7507491f, -0.75203836f, 0.0971471f},
	{-0.23964664f, 0.65978444f, -0.72591704f, 0.10562216f},
	{-0.46532363f, 0.56923884f, -0.7239167f, 0.10486533f},
	{-0.45662472f, 0.37820733f, -0.6468489f, 0.12956218f},
	{-0.65084827f, 0.14343306f, -0.6333403f, 0.12227128f},
	{-0.47435266f, -0.2105206f, -0.6301713f, 0.1409741f},
	{-0.6476443f, -0.39143735f, -0.7164258f, 0.103655994f},
	{-0.41444445f, -0.53824586f, -0.6868025f, 0.11060521f},
	{-0.21771756f, -0.8658111f, -0.91486675f, 0.07012263f},
	{0.11425703f, -0.77052206f, -0.7702035f, 0.092164926f},
	{0.38912037f, -0.6635768f, -0.7329779f, 0.10096447f},
	{0.42255583f, -0.26068613f, -0.6105681f, 0.14802647f},
	{0.6141474f, -0.20246388f, -0.6658262f, 0.115561426f},
	{0.27940467f, 0.6808543f, -0.71201754f, 0.1037983f},
	{-0.028163215f, 0.6311802f, -0.65827155f, 0.11997171f},
	{-0.17713854f, 0.53895307f, -0.62597007f, 0.13537695f},
	{-0.3473128f, 0.48121735f, -0.6302499f, 0.13093905f},
	{-0.5645298f, 0.2387453f, -0.6402012f, 0.12431881f},
	{-0.63832444f, 1.8496169e-06f, -0.66574574f, 0.117671005f},
	{-0.6639773f, -0.1391692f, -0.6235581f, 0.12267145f},
	{-0.50301534f, -0.3935024f, -0.6578572f, 0.122887485f},
	{-0.31339952f, -0.7404326f, -0.8123465f, 0.08821787f},
	{-0.0756449f, -0.6240612f, -0.61495227f, 0.12913048f},
	{0.14587906f, -0.6372021f, -0.6367819f, 0.12453018f},
	{0.20129788f, -0.4719291f, -0.6497084f, 0.1371187f},
	{0.5386681f, -0.3167494f, -0.6085307f, 0.13028812f},
	{0.6156819f, -0.078695975f, -0.6137899f, 0.12931736f},
	{0.7473206f, 0.18128408f, -0.7150458f, 0.10143075f},
	{0.5994493f, 0.37795007f, -0.6833459f, 0.11311149f},
	{-0.08273607f, -0.8888219f, -0.8883531f, 0.07313602f},
	{0.26445314f, -0.7346953f, -0.74144185f, 0.0976144f},
	{0.42592767f, -0.46181348f, -0.59675944f, 0.13255762f},
	{0.62042314f, -0.4278858f, -0.718402f, 0.1041094f},
	{0.7937163f, -0.02042108f, -0.73775226f, 0.09779245f},
	{0.7928318f, 0.40801105f, -0.9346832f, 0.07240682f},
	{0.33386925f, 0.54724205f, -0.6843544f, 0.11603436f},
	{0.5185336f, 0.59904426f, -0.7583713f, 0.09334964f},
	{0.1306967f, 0.90447634f, -0.9667118f, 0.06918445f},
	{-0.12920432f, 0.7449603f, -0.7313184f, 0.10201029f},
	{-0.37819922f, 0.6569237f, -0.72113323f, 0.10266948f},
	{-0.5742887f, 0.44605452f, -0.6744929f, 0.11339287f},
	{-0.78246665f, 0.18026099f, -0.7795078f, 0.08927666f},
	{-0.8202457f, -0.12677981f, -0.8194962f, 0.08697945f},
	{-0.73149043f, -0.5179637f, -0.90536857f, 0.070948504f},
	{-0.48547804f, -0.6391476f, -0.7642652f, 0.09287371f},
	{0.2102839f, -0.2941339f, -0.73951626f, 0.15511867f},
	{0.20159823f, -0.09633758f, -0.78156674f, 0.15386836f},
	{0.36654326f, 0.18944873f, -0.74876744f, 0.14585696f},
	{0.20660275f, 0.08289271f, -0.7711105f, 0.15834896f},
	{0.16824202f, 0.19630615f, -0.77916783f, 0.15295859f},
	{-0.06922114f, 0.06834032f, -0.83978575f, 0.14672533f},
	{0.05469671f, 0.083572514f, -0.82594615f, 0.14716178f},
	{-0.07001083f, 0.36045352f, -0.7417229f, 0.15764622f},
	{-0.22706479f, 0.42011994f, -0.6313557f, 0.14504582f},
	{-0.19855015f, 0.07777508f, -0.7814123f, 0.15631284f},
	{-0.32610202f, 0.012502501f, -0.7585083f, 0.1562272f},
	{-0.24083687f, -0.1270935f, -0.7632658f, 0.15518463f},
	{-0.10552322f, -0.2323124f, -0.7977852f, 0.15120728f},
	{-0.0122299725f, -0.14681712f, -0.8106023f, 0.150276f},
	{-0.16185166f, -0.3700918f, -0.72128093f, 0.14533108f},
	{0.07752019f, -0.3650794f, -0.79623526f, 0.14279993f},
	{-0.48353156f, 0.74992114f, -0.8941238f, 0.07007646f},
	{-0.6969665f, 0.6232119f, -1.0211605f, 0.05625787f},
	{-0.7763436f, 0.40354973f, -0.8954752f, 0.07565991f},
	{-0.9024355f, 0.13245505f, -0.96263427f, 0.06361537f},
	{-0.8184483f, -0.4053444f, -0.9500819f, 0.064944655f},
	{-0.6510235f, -0.6466315f, -1.0616492f, 0.059983622f},
	{-0.3758614f, -0.83039063f, -0.937698f, 0.06713849f},
	{-0.01665265f, -0.76127565f, -0.78168994f, 0.09131758f},
	{0.30488634f, -0.55992186f, -0.6256034f, 0.12774509f},
	{0.6164113f, -0.67933506f, -0.9751344f, 0.06123402f},
	{0.7277172f, -0.33031213f, -0.792094f, 0.08668528f},
	{0.85545015f, -0.31443658f, -0.9352184f, 0.06910487f},
	{0.86533785f, 0.29161063f, -0.9607587f, 0.06598631f},
	{0.6996098f, 0.6066383f, -1.0230861f, 0.059197158f},
	{0.268293f, 0.8409787f, -0.8645802f, 0.07219133f},
	{0.024142127f, 0.7511486f, -0.7176434f, 0.10128064f},
	{-0.7783179f, 0.020725261f, -0.75894904f, 0.0939175f},
	{-0.8790165f, -0.24067995f, -0.9392007f, 0.06684954f},
	{-0.6062719f, -0.2586186f, -0.6556876f, 0.11875325f},
	{-0.5125807f, -0.7486841f, -0.9506617f, 0.06605585f},
	{0.05744259f, -0.9005255f, -0.8946093f, 0.072861485f},
	{0.49689248f, -0.7214609f, -0.88029075f, 0.0788176f},
	{0.5184779f, -0.5554754f, -0.6970707f, 0.10299436f},
	{0.6785595f, -0.55045795f, -0.90737134f, 0.07274704f},
	{0.8717545f, -0.16100478f, -0.90496415f, 0.074356064f},
	{0.8804149f, 0.14076003f, -0.9339322f, 0.06786705f},
	{0.6889337f, 0.5001163f, -0.85066545f, 0.07925477f},
	{0.55414355f, 0.7226815f, -0.9289683f, 0.07118958f},
	{-0.02221827f, 0.8740865f, -0.8139085f, 0.082626216f},
	{-0.25687578f, 0.80310273f, -0.8457024f, 0.08012479f},
	{-0.5655906f, 0.6412919f, -0.8343018f, 0.07926414f},
	{-0.68752176f, 0.4959916f, -0.8354153f, 0.08218993f},
};

#endif // NOOK_VO_AREA_H
