// Made by: nook emit --methods alchemy --patterns hemisphere_009_tile4.json --recipe paper --filter window --glsl vulkan
// Version: nook 0.1.0
// Base pattern: nook tile --pattern hemisphere_009.json --size 4
// SPDX-License-Identifier: MIT
//
// Visibility of the surface that a pixel shows, 1 where open, from a depth buffer:
//   float nookAlchemy(ivec2 pixel): Alchemy ambient obscurance, 9 samples, other ones in each pixel of 4 x 4
//       depth reads per pixel: at most 10; with all passes below: at most 26
// Passes, in this order. Each calls a function for the texel that it draws, into a picture of its own:
//   nookAlchemy(texel): visibility, R8 or better, size of the picture; at most 10 depth reads per texel
//   nookWindow(texel): visibility, R8 or better, same size; reads the picture of the pass before as nook_cells; at most 16 depth reads per texel
// Pixels count as in texelFetch. `nook emit -o FILE.h` writes the C++ that fills the uniform block, `-o FILE.js` the JavaScript.
// This file has no #version: include it after yours. All its names begin with nook or NOOK.
//
// Positions from depth, and sizes in the picture, for any projection without a skew.
//
// Depth buffers of any projection and format, and the radius at a depth.
//
// From noisy visibility to a clean picture: filters that stay on the surface of the pixel, and half resolution to full
// resolution.
// The two one-dimensional passes are after: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
//
// Alchemy ambient obscurance: the occlusion by points of the depth buffer, projected onto the normal.
// This work is based on: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient Obscurance
// Algorithm", HPG 2011 (ALC).
#ifndef NOOK_ALCHEMY_GLSL
#define NOOK_ALCHEMY_GLSL
#if !defined(VULKAN) || __VERSION__ < 450
#error nook: this module needs #version 450 or later, and Vulkan
#endif
#ifndef NOOK_SET
#define NOOK_SET 0 // descriptor set of every binding of this module
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// The uniform block that nook_fill fills. Lengths are in metres, or in the unit of your depths.
#ifndef NOOK_BLOCK_BINDING
#define NOOK_BLOCK_BINDING 0
#endif
layout(set = NOOK_SET, std140, binding = NOOK_BLOCK_BINDING) uniform nook_block
{
	vec2 size; // width and height of the picture, pixels
	vec2 pixel_size; // 1 / width, 1 / height
	vec2 across_x; // turns NDC x back into view-space x: 1 / P[0][0], P[2][0] / P[0][0] of the projection P[column][row]
	vec2 across_y; // the same for y: 1 / P[1][1], P[2][1] / P[1][1]; the first negated where row 0 is at NDC y = -1
	vec2 aside; // the shift of an off-centre orthographic projection: -P[3][0] / P[0][0], -P[3][1] / P[1][1]
	float w_slope; // clip-space w at a depth d is w_slope * d + w_start: perspective has 1 and 0, orthographic 0 and 1
	float w_start; // see w_slope
	ivec2 first; // first pixel whose depth may be read, guard band included
	ivec2 last; // last pixel whose depth may be read, guard band included
	vec4 depth; // device depth back to linear depth: (x + y * t) / (z + w * t), where t = abs(stored value - far_end)
	vec2 origin; // first pixel of the picture in its textures
	float far_end; // what the depth buffer holds at the far plane: 1, or 0 where depth is reversed
	float depth_step; // a stored depth may be off by depth_step * w * w + depth_share * depth, which is its rounding
	float depth_share; // see depth_step
	float normal_error; // sine of the angle by which rounding may turn a stored normal
	float radius; // surfaces closer than this occlude; metres, or the unit of your depths
	float second_radius; // volumetric obscurance: a second radius whose result is combined with the first
	float third_radius; // volumetric obscurance: a third radius
	float thickness; // volumetric obscurance: how far a surface goes on behind what is seen, in the unit of the radius
	float second_thickness; // thickness for the second radius
	float third_thickness; // thickness for the third radius
	float first_band_px; // with bands: a radius of fewer pixels takes the samples of the first band only
	float second_band_px; // with three bands: a radius of fewer pixels takes the samples of the first two
	float most_px; // largest radius in the picture, pixels
	float least_px; // smallest radius in the picture, pixels
	float sigma; // Alchemy: intensity
	float contrast; // Alchemy: exponent of the result
	float beta; // Alchemy: bias against self-occlusion, as a share of the depth
	float epsilon; // Alchemy: keeps the quotient finite, in squared radii
	float box_height; // statistical volumetric obscurance: height of the box over the surface, in radii
	float slope; // statistical volumetric obscurance: how fast surfaces in front of the box stop counting, per box height
	float largest_px; // statistical volumetric obscurance: largest half side of the box, pixels
	float least_box_px; // statistical volumetric obscurance: a box with a smaller half side, in pixels, reads as open
	float slice_thickness; // slices: thickness of a surface at a distance of one radius, in radii
	float strength; // factor of the obscurance, which is 1 - visibility
	float power; // exponent of the visibility, after the strength
	float frame; // number of the frame, for tiles whose samples change from frame to frame
} nook;

// Linear depth: distance along the view direction, > 0; NOOK_SKY or more where there is no surface.
// Define NOOK_DEPTH(pixel) before this file to read your own in another way.
#ifndef NOOK_DEPTH
#ifndef NOOK_DEPTHS_BINDING
#define NOOK_DEPTHS_BINDING 1
#endif
layout(set = NOOK_SET, binding = NOOK_DEPTHS_BINDING) uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}

// Unit normal in view space: x to the right, y up, z toward the camera.
// Define NOOK_NORMAL(pixel) before this file to read your own in another way.
#ifndef NOOK_NORMAL
#ifndef NOOK_NORMALS_BINDING
#define NOOK_NORMALS_BINDING 2
#endif
layout(set = NOOK_SET, binding = NOOK_NORMALS_BINDING) uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

// Visibility in the picture of the pass before.
// Define NOOK_VISIBILITY(pixel) before this file to read your own in another way.
#ifndef NOOK_VISIBILITY
#ifndef NOOK_CELLS_BINDING
#define NOOK_CELLS_BINDING 6
#endif
layout(set = NOOK_SET, binding = NOOK_CELLS_BINDING) uniform sampler2D nook_cells;
#define NOOK_VISIBILITY(pixel) texelFetch(nook_cells, pixel, 0).r
#endif
float nookVisibility(ivec2 pixel)
{
	return NOOK_VISIBILITY(pixel);
}

// Row of a pixel, counted from the top of what the camera sees, whichever end of the picture row 0 is at. Tiles and windows so
// lie on a picture in the same way for both orders of rows.
int nookRow(int y)
{
	return nook.across_y.x < 0.0f ? int(2.0f * nook.origin.y + nook.size.y) - 1 - y : y;
}

// The samples: x,y,z,weight of each, for a radius of 1. A texture RGBA32F, 16 x 9, whose texels the header holds;
// a column is the variant of a pixel, a row is a sample.
#ifndef NOOK_ALCHEMY_TILE_BINDING
#define NOOK_ALCHEMY_TILE_BINDING 5
#endif
layout(set = NOOK_SET, binding = NOOK_ALCHEMY_TILE_BINDING) uniform sampler2D nook_alchemy_tile;
vec4 nookAlchemySample(int row, int i)
{
	return texelFetch(nook_alchemy_tile, ivec2(row, i), 0);
}
int nookAlchemyVariant(ivec2 pixel)
{
	return (nookRow(pixel.y) % 4) * 4 + pixel.x % 4;
}

// Size of a pixel in view space at a clip-space w of 1: to the right, and downward.
vec2 nookTexel()
{
	return vec2(2.0f * nook.pixel_size.x * nook.across_x.x, -2.0f * nook.pixel_size.y * nook.across_y.x);
}

// By how much a point on the line of sight of a pixel moves per metre of depth toward the eye.
vec3 nookSight(ivec2 pixel)
{
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(-nook.w_slope * ndc_x * nook.across_x.x - nook.across_x.y, -nook.w_slope * ndc_y * nook.across_y.x - nook.across_y.y,
				1.0f);
}

// First and last pixel that hold depth, near a pixel.
vec4 nookAround(ivec2 pixel)
{
	return vec4(uintBitsToFloat(uint(nook.first.x + 0x4b400000 - pixel.x)), uintBitsToFloat(uint(nook.first.y + 0x4b400000 - pixel.y)),
				uintBitsToFloat(uint(nook.last.x + 0x4b400000 - pixel.x)), uintBitsToFloat(uint(nook.last.y + 0x4b400000 - pixel.y)));
}

// The pixel at `offset` (x to the right, y up, in the unit of `scale`) from the centre of a pixel, moved to the nearest one that
// holds depth. around: nookAround.
vec2 nookNear(vec4 around, vec2 offset, vec2 scale)
{
	float x = 12582912.0f + offset.x * scale.x;
	float y = 12582912.0f - offset.y * scale.y;
	return vec2(clamp(x, around.x, around.z), clamp(y, around.y, around.w));
}

// Distance of a pixel near another one: pixels to the right and downward.
vec2 nookAcross(vec2 near)
{
	return vec2(near.x - 12582912.0f, near.y - 12582912.0f);
}

// A pixel near another one, as in texelFetch.
ivec2 nookThere(ivec2 pixel, vec2 near)
{
	return ivec2(pixel.x - 0x4b400000 + int(floatBitsToUint(near.x)), pixel.y - 0x4b400000 + int(floatBitsToUint(near.y)));
}

// Number of samples that a pixel takes, from its radius in pixels: those of the first band, of the first two bands, or all.
int nookCount(float pixels)
{
	return 9;
}

// By how much the difference of two depths within a radius may be off. Samples are moved back by it; otherwise surfaces would
// occlude themselves where depths are coarse.
float nookSlack(float depth, float radius)
{
	float near = nook.w_slope * depth + nook.w_start;
	float far = nook.w_slope * radius + near;
	return nook.depth_step * (near * near + far * far) + nook.depth_share * (2.0f * abs(depth) + radius);
}

// The radius that is used where a pixel spans `pixel` metres: limited to nook.most_px pixels in the picture, and at least
// nook.least_px.
float nookRadiusOf(float radius, float pixel)
{
	return max(min(radius, nook.most_px * pixel), nook.least_px * pixel);
}

// Visibility of a pixel: ALC eq. 10 with lengths in radii, so that the picture does not depend on the unit of length. With the
// radius r, the paper's sigma is sigma * r here, its epsilon epsilon * r^2, its beta beta. Samples are (x, y, unused, weight),
// uniform on the disk, with a sum of weights of 1. Emitted with --cut, surfaces farther away than the radius do not count (H in
// eq. 9). The rounding of depths and normals is subtracted from v.n together with beta, for normals as if v were longer by epsilon.
float nookAlchemy(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 n = nookNormal(pixel); // fetched together with the depth
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec2 texel = nookTexel();
	vec2 step_of = texel * (nook.w_slope * depth + nook.w_start); // size of a pixel at this depth
	vec2 metre = vec2(1.0f / step_of.x, -1.0f / step_of.y);
	float radius = nookRadiusOf(nook.radius, min(abs(step_of.x), abs(step_of.y)));
	vec2 scale = metre * radius;
	vec2 turn = texel * nook.w_slope; // by how much the line of sight changes from pixel to pixel
	vec3 sight = nookSight(pixel);
	float facing = max(0.0f, dot(n, sight));
	float bias = nook.beta * depth + nookSlack(depth, radius) * facing;
	float least = nook.epsilon * radius * radius;
	int row = nookAlchemyVariant(pixel);
	vec4 around = nookAround(pixel);
	float pixels = max(abs(scale.x), abs(scale.y));
	int count = nookCount(pixels);
	float sum = 0.0f;
	float weights = 0.0f;
	for (int i = 0; i < count; ++i)
	{
		vec4 point = nookAlchemySample(row, i);
		vec2 near = nookNear(around, vec2(point.x, point.y), scale);
		vec2 across = nookAcross(near);
		ivec2 there = nookThere(pixel, near);
		float surface = 0.0f;
		surface = nookDepth(there);
		// The surface lies at (x, y, -deeper). Sky does not occlude: it is so far away that it adds nothing.
		float deeper = min(surface, 1e15f) - depth;
		float x = across.x * step_of.x + deeper * (across.x * turn.x - sight.x);
		float y = across.y * step_of.y + deeper * (across.y * turn.y - sight.y);
		float square = x * x + (y * y + (deeper * deeper + least));
		float inverse = 1.0f / sqrt(square);
		float height = x * n.x + y * n.y - (deeper * n.z + bias);
		float adds = point.w * inverse * clamp(height * inverse - nook.normal_error, 0.0f, 1.0f);
		sum += adds;
	}
	float open = pow(max(0.0f, 1.0f - nook.sigma * radius * (sum + sum)), nook.contrast);
	return open;
}

// The pixel at which a cell of visibility was evaluated.
ivec2 nookPixel(ivec2 cell)
{
	return cell * 1;
}

// The cell that holds a pixel of the picture. Without signs the division is a shift.
ivec2 nookCellOf(ivec2 pixel)
{
	return ivec2(int(uint(pixel.x) / uint(1)), int(uint(pixel.y) / uint(1)));
}

// First cell of the picture; the guard band around it is not drawn.
ivec2 nookFirstCell()
{
	return nookCellOf(ivec2(int(nook.origin.x) + 1 - 1, int(nook.origin.y) + 1 - 1));
}

// Last cell of the picture.
ivec2 nookLastCell()
{
	return nookCellOf(ivec2(int(nook.origin.x + nook.size.x) - 1, int(nook.origin.y + nook.size.y) - 1));
}

// Is a cell in the picture?
bool nookDrawn(ivec2 cell)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	return cell.x >= first.x && cell.y >= first.y && cell.x <= last.x && cell.y <= last.y;
}

// Do two pixels show the same surface: 1 yes, 0 no, with a ramp between. The ramp is flat at both ends, so that all pixels of a
// smooth surface have the same weight and the mean over a window of variants is exact. The thresholds were chosen by eye.
float nookAlikeOf(float apart, vec3 n, vec3 n_there)
{
	float beside = clamp(2.0f - apart * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, n_there) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

// nookAlikeOf for the surface of a pixel, with the normal n and the line of sight `sight`, and a surface at depth `there`, `across`
// pixels away; 0 where that is sky.
float nookAlikeThere(vec3 sight, float depth, vec3 n, vec2 across, float there, vec3 n_there)
{
	vec2 texel = nookTexel();
	vec3 both = n + n_there;
	float w = nook.w_slope * there + nook.w_start;
	float apart = w * (both.x * (texel.x * across.x) + both.y * (texel.y * across.y)) - dot(both, sight) * (there - depth);
	float alike = nookAlikeOf(abs(apart) / (2.0f * nook.radius), n, n_there);
	return there < NOOK_SKY ? alike : 0.0f;
}

// nookAlikeThere for the pixel `there`.
float nookAlike(vec3 sight, float depth, vec3 n, ivec2 there, vec2 across)
{
	return nookAlikeThere(sight, depth, n, across, nookDepth(there), nookNormal(there));
}

// Mean over the window of the tile, which holds every variant of the samples once. All cells that show the same surface have
// the same weight.
float nookWindow(ivec2 cell)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 sight = nookSight(pixel);
	int first = -((4 - 1) / 2);
	int down = nook.across_y.x < 0.0f ? -1 : 1; // rows count as in nookRow
	float sum = nookVisibility(cell);
	float weights = 1.0f;
	for (int y = first; y < first + 4; ++y)
	{
		for (int x = first; x < first + 4; ++x)
		{
			ivec2 there = ivec2(cell.x + x, cell.y + down * y);
			bool other = x != 0 || y != 0;
			if (other && nookDrawn(there))
			{
				vec2 across = vec2(float(1 * x), float(1 * down * y));
				float weight = nookAlike(sight, depth, n, nookPixel(there), across);
				sum += weight * nookVisibility(there);
				weights += weight;
			}
		}
	}
	float open = sum / weights;
	return open;
}

#endif // NOOK_ALCHEMY_GLSL
