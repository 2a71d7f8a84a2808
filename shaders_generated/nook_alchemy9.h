// Made by: nook emit --methods alchemy --patterns hemisphere_009_tile4.json --recipe paper
// Version: nook 0.1.0
// Base pattern: nook tile --pattern hemisphere_009.json --size 4
// SPDX-License-Identifier: MIT
//
// Fills the uniform block of a GLSL module that nook emitted: C++17 and later, no dependencies. All modules of one version of
// nook share nook_block, nook_settings and nook_fill.
#if defined(NOOK_ALCHEMY_SETTINGS) && NOOK_ALCHEMY_SETTINGS != 0
#error nook: another header with this method reads depth in another way, emit one of them with --namespace
#endif
#ifndef NOOK_ALCHEMY_H
#define NOOK_ALCHEMY_H

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

#ifndef NOOK_ALCHEMY_SETTINGS // the first of several headers with this method defines it
#define NOOK_ALCHEMY_SETTINGS 0
// Settings of nookAlchemy with the radius `reach`, in the unit of your depths. Set width and height.
inline nook_settings nook_alchemy_settings(double reach)
{
	nook_settings settings;
	settings.radius = reach;
	return settings;
}
#endif

// Texels of the texture nook_alchemy_tile, row by row: RGBA, 32-bit floats, 16 x 9, without filtering.
inline constexpr int nook_alchemy_tile_width = 16;
inline constexpr int nook_alchemy_tile_height = 9;
inline constexpr float nook_alchemy_tile[144][4] = {
	{-0.18464856f, -0.15441443f, 0.97059834f, 0.12391787f},
	{-0.1696531f, -0.42960572f, 0.8869367f, 0.12055081f},
	{0.38816217f, -0.44341415f, 0.8079072f, 0.11429684f},
	{0.07895885f, -0.5719218f, 0.8164992f, 0.12087399f},
	{0.4078688f, -0.12787634f, 0.9040413f, 0.12142416f},
	{0.2664146f, -0.15149562f, 0.9518783f, 0.13217793f},
	{0.5100921f, 0.1794684f, 0.84118795f, 0.118185565f},
	{0.4321165f, 0.037627958f, 0.90103245f, 0.113292865f},
	{0.22789092f, 0.3447878f, 0.9105971f, 0.12201755f},
	{0.52634645f, 0.37318352f, 0.7639984f, 0.121468075f},
	{0.05356646f, 0.22476082f, 0.9729405f, 0.11610343f},
	{-0.2544256f, 0.2548057f, 0.93292105f, 0.12115094f},
	{-0.21380983f, 0.095026284f, 0.9722424f, 0.12556313f},
	{-0.05366899f, 0.03657269f, 0.9978888f, 0.13272868f},
	{-0.39328188f, 0.059559647f, 0.9174868f, 0.1194868f},
	{-0.54158306f, 0.1446293f, 0.8281124f, 0.13016523f},
	{-0.0696884f, 0.969538f, 0.2348184f, 0.094957694f},
	{0.084041685f, 0.67142016f, 0.7362961f, 0.12286725f},
	{-0.50723207f, 0.8426265f, 0.18082099f, 0.081519514f},
	{-0.52832717f, 0.49484745f, 0.68992496f, 0.10780885f},
	{-0.74785656f, 0.039069586f, 0.66270965f, 0.11690337f},
	{-0.8531302f, -0.47474995f, 0.2162898f, 0.08062377f},
	{-0.6177221f, -0.31062314f, 0.72244906f, 0.12776038f},
	{-0.5082825f, -0.8363752f, 0.20524512f, 0.08662023f},
	{-0.3130049f, -0.8407178f, 0.44183874f, 0.0996442f},
	{0.1706848f, -0.6886032f, 0.704764f, 0.122281335f},
	{0.45970193f, -0.75788635f, 0.4629065f, 0.095780954f},
	{0.9747118f, -0.019915408f, 0.22257654f, 0.08580665f},
	{0.7823714f, -0.20583329f, 0.58781594f, 0.10950926f},
	{0.64592314f, 0.0511307f, 0.76168823f, 0.118528344f},
	{0.63576025f, 0.65969944f, 0.40075627f, 0.10059575f},
	{0.68760824f, 0.5122649f, 0.5145674f, 0.10302774f},
	{-0.5757166f, 0.3171229f, 0.7536468f, 0.12747161f},
	{-0.6608628f, 0.6856868f, 0.3051129f, 0.093215995f},
	{-0.73284453f, -0.16482365f, 0.6601303f, 0.119486764f},
	{-0.8421784f, -0.13496096f, 0.5220355f, 0.10724181f},
	{-0.5209899f, -0.7462919f, 0.414268f, 0.09313447f},
	{0.013281152f, -0.7420579f, 0.6702042f, 0.11181585f},
	{-0.12172312f, -0.8383731f, 0.53133225f, 0.11414073f},
	{0.28608042f, -0.5776007f, 0.76454914f, 0.117947154f},
	{0.4241287f, -0.63335735f, 0.64728147f, 0.11261378f},
	{0.82863384f, -0.32242197f, 0.4576134f, 0.1094239f},
	{0.8915703f, 0.13547331f, 0.43214503f, 0.10361503f},
	{0.36811957f, 0.4699113f, 0.80229133f, 0.12591998f},
	{0.4974404f, 0.82521003f, 0.26754704f, 0.0865778f},
	{0.71667635f, 0.67432815f, 0.17792301f, 0.07686736f},
	{-0.08293745f, 0.67466766f, 0.7334473f, 0.108589344f},
	{-0.3018127f, 0.8955979f, 0.32682335f, 0.08554172f},
	{-0.8570339f, -0.32390454f, 0.40072277f, 0.098090984f},
	{-0.7568232f, -0.32946452f, 0.5645102f, 0.10289144f},
	{-0.25214002f, -0.5667592f, 0.78435284f, 0.123755194f},
	{-0.23148376f, -0.9395422f, 0.25234067f, 0.09012094f},
	{0.2918328f, -0.75154614f, 0.5916181f, 0.1052371f},
	{0.7529613f, -0.50363f, 0.42356363f, 0.10258807f},
	{0.51213187f, -0.4832895f, 0.71003675f, 0.1189877f},
	{0.9208529f, -0.30196005f, 0.246678f, 0.086913474f},
	{0.8009754f, -0.0018541503f, 0.5986944f, 0.11648849f},
	{0.24701194f, 0.94580793f, 0.21079013f, 0.080692f},
	{0.3968885f, 0.6055562f, 0.68976897f, 0.11667686f},
	{-0.08401769f, 0.8885775f, 0.45096675f, 0.09960006f},
	{-0.24227768f, 0.6818769f, 0.6901778f, 0.117103234f},
	{-0.5733567f, 0.6228294f, 0.5323022f, 0.112431824f},
	{-0.7402023f, 0.50778097f, 0.44074824f, 0.09874398f},
	{-0.95333827f, -0.19633289f, 0.22934598f, 0.07842927f},
	{0.43214002f, -0.31495345f, 0.8450203f, 0.11330714f},
	{0.2807063f, 0.02890387f, 0.9593584f, 0.12922293f},
	{0.097398125f, 0.07434917f, 0.9924645f, 0.1286346f},
	{0.34381533f, 0.19554235f, 0.9184521f, 0.12578987f},
	{0.019305445f, 0.35624993f, 0.9341912f, 0.13029f},
	{-0.13031293f, 0.37540624f, 0.9176539f, 0.12619308f},
	{-0.2912068f, 0.41405997f, 0.8624111f, 0.12436557f},
	{-0.104058675f, 0.20306611f, 0.97362f, 0.120993614f},
	{-0.5593198f, -0.17826708f, 0.8095568f, 0.12292384f},
	{-0.49667916f, -0.032401692f, 0.8673292f, 0.115328446f},
	{-0.39020917f, -0.14466015f, 0.9092911f, 0.119969435f},
	{-0.08050361f, -0.29968074f, 0.9506369f, 0.11931006f},
	{0.20922245f, -0.45177257f, 0.8672529f, 0.12564656f},
	{-0.0804714f, -0.59751755f, 0.7978077f, 0.12544693f},
	{-0.011630531f, -0.454944f, 0.8904441f, 0.12468076f},
	{0.1087076f, -0.34329906f, 0.93291396f, 0.13120401f},
	{-0.16707405f, -0.71816397f, 0.67551965f, 0.11714528f},
	{-0.01673879f, -0.9196806f, 0.3923104f, 0.09139809f},
	{0.40940955f, -0.8934969f, 0.1845188f, 0.085123785f},
	{0.6358606f, -0.32096973f, 0.7018972f, 0.11547909f},
	{0.8985677f, -0.09357344f, 0.4287425f, 0.09599781f},
	{0.65806955f, 0.3726264f, 0.65428895f, 0.11969215f},
	{0.9434548f, 0.24327148f, 0.22519341f, 0.0796547f},
	{0.54428357f, 0.55666494f, 0.6275982f, 0.110634714f},
	{0.34474316f, 0.8354138f, 0.42806062f, 0.10111097f},
	{-0.1837524f, 0.5471974f, 0.8165844f, 0.12218338f},
	{-0.40267897f, 0.677823f, 0.6151468f, 0.123709306f},
	{-0.786871f, 0.30774418f, 0.5349089f, 0.10542449f},
	{-0.8530544f, 0.1178763f, 0.5083339f, 0.10849131f},
	{-0.63418716f, -0.011070363f, 0.7731003f, 0.11695825f},
	{-0.7134701f, -0.5252162f, 0.46379775f, 0.1073337f},
	{-0.38327828f, -0.6013883f, 0.7010206f, 0.12004784f},
	{0.6531507f, 0.22493389f, 0.7230484f, 0.11488471f},
	{0.8032512f, 0.3522744f, 0.4803022f, 0.108299196f},
	{0.27156776f, 0.70015544f, 0.6603282f, 0.113188244f},
	{-0.00846604f, 0.7898104f, 0.6132926f, 0.11053767f},
	{-0.45609093f, 0.7722008f, 0.44236517f, 0.10437717f},
	{-0.6655724f, 0.42391834f, 0.6142529f, 0.10831935f},
	{-0.8419702f, 0.48741224f, 0.23133415f, 0.08938109f},
	{-0.7053208f, 0.19918375f, 0.6803297f, 0.12532552f},
	{-0.9682244f, 0.15951557f, 0.19260392f, 0.07881727f},
	{-0.5257522f, -0.6386849f, 0.5618418f, 0.10980964f},
	{-0.34115732f, -0.7327626f, 0.58878744f, 0.10463836f},
	{0.122796156f, -0.8441051f, 0.5219268f, 0.108691424f},
	{0.08675327f, -0.97111815f, 0.22226883f, 0.08597721f},
	{0.58234644f, -0.6116f, 0.535554f, 0.10886134f},
	{0.6882654f, -0.13331054f, 0.71310526f, 0.12453029f},
	{0.54844594f, -0.035863563f, 0.83541656f, 0.12168168f},
	{0.7895524f, -0.58070713f, 0.19845977f, 0.08370869f},
	{0.6643425f, -0.44222802f, 0.60256404f, 0.10946164f},
	{0.7781943f, 0.17374973f, 0.60351026f, 0.11692814f},
	{0.835782f, 0.46039817f, 0.29916883f, 0.09332048f},
	{0.4602721f, 0.7114493f, 0.5310268f, 0.1068239f},
	{0.123999685f, 0.90140194f, 0.4148477f, 0.09701602f},
	{0.17145292f, 0.80119455f, 0.573316f, 0.10218211f},
	{-0.2364198f, 0.8116621f, 0.53414446f, 0.1147848f},
	{-0.37355745f, 0.5360712f, 0.75702214f, 0.12213249f},
	{-0.8838622f, 0.29626998f, 0.36195534f, 0.08880983f},
	{-0.9278759f, -0.010996361f, 0.37272698f, 0.098710865f},
	{-0.6236545f, -0.47851068f, 0.6181283f, 0.11317115f},
	{-0.4869001f, -0.4587818f, 0.74326813f, 0.11910914f},
	{-0.69762516f, -0.65833974f, 0.28267998f, 0.08823324f},
	{0.2941011f, -0.87016636f, 0.39536703f, 0.10165404f},
	{0.60850966f, -0.72351736f, 0.32594267f, 0.10095287f},
	{0.13772456f, 0.4690723f, 0.8723549f, 0.12651604f},
	{-0.39817354f, 0.2163825f, 0.8914238f, 0.12209266f},
	{-0.4332994f, 0.3638425f, 0.82454246f, 0.11706693f},
	{-0.26657656f, -0.043866485f, 0.962815f, 0.12882732f},
	{-0.25677446f, -0.28228882f, 0.9243267f, 0.12581202f},
	{-0.4353635f, -0.2861116f, 0.85357994f, 0.121573776f},
	{-0.04498305f, -0.114977024f, 0.99234915f, 0.12534216f},
	{-0.3467275f, -0.416755f, 0.8402948f, 0.12348764f},
	{0.065092675f, -0.21764094f, 0.9738559f, 0.1242514f},
	{0.13783112f, -0.07929571f, 0.98727643f, 0.1300034f},
	{0.28940448f, -0.2998825f, 0.909019f, 0.12079576f},
	{0.5417229f, -0.21407717f, 0.81283903f, 0.12092523f},
	{0.39786673f, 0.3217147f, 0.85918665f, 0.12202235f},
	{0.20261821f, 0.5741816f, 0.79326f, 0.11994403f},
	{0.20564383f, 0.18688388f, 0.960617f, 0.11438534f},
	{-0.018389722f, 0.51297194f, 0.8582084f, 0.12894964f},
};

#endif // NOOK_ALCHEMY_H
