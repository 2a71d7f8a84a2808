// Made by: nook emit --methods statvo --recipe paper
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Fills the uniform block of a GLSL module that nook emitted: C++17 and later, no dependencies. All modules of one version of
// nook share nook_block, nook_settings and nook_fill.
#if defined(NOOK_STATVO_SETTINGS) && NOOK_STATVO_SETTINGS != 0
#error nook: another header with this method reads depth in another way, emit one of them with --namespace
#endif
#ifndef NOOK_STATVO_H
#define NOOK_STATVO_H

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

#ifndef NOOK_STATVO_SETTINGS // the first of several headers with this method defines it
#define NOOK_STATVO_SETTINGS 0
// Settings of nookStatVo with the radius `reach`, in the unit of your depths. Set width and height.
inline nook_settings nook_statvo_settings(double reach)
{
	nook_settings settings;
	settings.radius = reach;
	return settings;
}
#endif

#endif // NOOK_STATVO_H
