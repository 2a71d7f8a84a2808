// Made by: nook emit --methods statvo --recipe paper --glsl es300
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Visibility of the surface that a pixel shows, 1 where open, from a depth buffer:
//   float nookStatVo(ivec2 pixel): statistical volumetric obscurance
//       depth reads per pixel: at most 1; with all passes below: at most 15
// Passes, in this order. Each calls a function for the texel that it draws, into a picture of its own:
//   width and height below are those of all pixels that hold depth, guard band included:
//   nookStatRange(texel): RGBA32F, 2 ceil(width / 8) x ceil(height / 8); 64 depth reads per texel
//   nookStatRangeUp(texel), again and again until the picture is 2 x 1: RGBA32F, 2 ceil(w / 8) x ceil(h / 8); reads the picture
//       before as nook_levels; nook_pass.xy = (w, h), where that picture has 2 w x h texels
//   nookStatFrame(texel): RGBA32F, 2 x 1; reads the last of these as nook_levels; later passes read it as nook_range
//   for each table t from 0 to 3:
//       nookStatCells(texel): RGBA32UI, ceil(width / 1) + 1 x ceil(height / 1) + 1; nook_pass.z = t; reads the tables so far as nook_tables;
//           1 depth read per pixel for t = 0, 2 for others
//       nookTableSum(texel): same size; reads the picture before as layer 0 of nook_tables; for axis 0, then for axis 1, with the
//           strides 1, 8, 64, ... below the length of that side; nook_pass.xy = (stride, axis); the last one is layer t of nook_tables
//   nookStatSlopes(texel): level 0 of a picture RGBA32F, ceil(width / 8) x ceil(height / 8), with all mip levels; 256 depth reads per texel
//   nookStatSlopesUp(texel): its other levels, each from the one before as nook_levels; nook_pass.x = level
//   nookStatFlags(texel): R32F, ceil(width / 8) x ceil(height / 8); reads that picture as nook_levels; 64 depth reads per texel;
//       the next pass reads this one as nook_levels
//   nookStatVo(texel): visibility, R8 or better, size of the picture; at most 1 depth read per texel
// Pixels count as in texelFetch. `nook emit -o FILE.h` writes the C++ that fills the uniform block, `-o FILE.js` the JavaScript.
// This file has no #version: include it after yours. All its names begin with nook or NOOK.
//
// Positions from depth, and sizes in the picture, for any projection without a skew.
//
// Depth buffers of any projection and format, and the radius at a depth.
//
// Summed-area tables of unsigned integers. Overflow wraps around, so the sum over a rectangle is exact as long as the sum
// itself is below 2^32, whatever the entries of the table are.
// This work is based on: F. C. Crow, "Summed-Area Tables for Texture Mapping", SIGGRAPH 1984, and J. Hensley, T. Scheuermann,
// G. Coombe, M. Singh, A. Lastra, "Fast Summed-Area Table Generation and its Applications", Eurographics 2005 (recursive
// doubling).
//
// The tables of statistical volumetric obscurance: sums of positions, as integers, of all pixels and of layers of them.
// This work is based on: Q. Hendrickx, L. Scandolo, M. Eisemann, E. Eisemann, "Adaptively Layered Statistical Volumetric
// Obscurance", HPG 2015 (SVO).
//
// Where statistical volumetric obscurance needs no layers: surfaces without creases and edges around a tile of 8 x 8 pixels.
// An addition of nook; the paper evaluates all layers everywhere.
//
// Statistical volumetric obscurance: how much of a box over a pixel the mean height of its neighbours fills, layer by layer.
// This work is based on: Q. Hendrickx, L. Scandolo, M. Eisemann, E. Eisemann, "Adaptively Layered Statistical Volumetric
// Obscurance", HPG 2015 (SVO).
#ifndef NOOK_STATVO_GLSL
#define NOOK_STATVO_GLSL
#if !defined(GL_ES) || __VERSION__ < 300
#error nook: this module needs #version 300 es or later
#endif
// Depths need high precision. The rest of your shader gets these defaults too, unless it sets others.
precision highp float;
precision highp int;
precision highp sampler2D;
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// The uniform block that nook_fill fills. Lengths are in metres, or in the unit of your depths.
layout(std140) uniform nook_block
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

// Parameters of the pass that is drawn, as the list at the top says.
uniform ivec4 nook_pass;

// Linear depth: distance along the view direction, > 0; NOOK_SKY or more where there is no surface.
// Define NOOK_DEPTH(pixel) before this file to read your own in another way.
#ifndef NOOK_DEPTH
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}

// Unit normal in view space: x to the right, y up, z toward the camera.
// Define NOOK_NORMAL(pixel) before this file to read your own in another way.
#ifndef NOOK_NORMAL
uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

// Picture of an earlier pass, with its mip levels where it has some. While you draw into level l of it, restrict the texture
// to the levels before l (GL_TEXTURE_MAX_LEVEL, or an image view).
uniform sampler2D nook_levels;
vec4 nookLevel(ivec2 texel, int level)
{
	return texelFetch(nook_levels, texel, level);
}

// Summed-area tables: RGBA32UI, one table per layer.
uniform highp usampler2DArray nook_tables;
uvec4 nookTable(ivec2 texel, int table)
{
	return texelFetch(nook_tables, ivec3(texel, table), 0);
}

// Picture of nookStatFrame, two texels: the range of the positions in the tables.
uniform sampler2D nook_range;
vec4 nookRange(int i)
{
	return texelFetch(nook_range, ivec2(i, 0), 0);
}

// View-space position of the surface that a pixel shows, from its depth. With NDC x and y of the pixel and clip-space w at that
// depth, this is the inverse of the projection.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.aside.x,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.aside.y, -depth);
}

// Size in the picture of one metre across the view direction, at a depth: pixels along x (to the right) and y (downward).
vec2 nookScale(float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	return vec2(0.5f * nook.size.x / (w * nook.across_x.x), 0.5f * nook.size.y / (w * nook.across_y.x));
}

// The radius that is used where a pixel spans `pixel` metres: limited to nook.most_px pixels in the picture, and at least
// nook.least_px.
float nookRadiusOf(float radius, float pixel)
{
	return max(min(radius, nook.most_px * pixel), nook.least_px * pixel);
}

// The radius that is used at a depth.
float nookRadius(float radius, float depth)
{
	vec2 metre = nookScale(depth);
	return nookRadiusOf(radius, 1.0f / max(abs(metre.x), abs(metre.y)));
}

// Half side of the box in metres, limited to nook.largest_px pixels in the picture.
float nookStatRadius(float depth)
{
	vec2 scale = nookScale(depth);
	return min(nookRadius(nook.radius, depth), nook.largest_px / max(abs(scale.x), abs(scale.y)));
}

// Half sides of the box in pixels.
vec2 nookStatBox(float depth)
{
	vec2 scale = nookScale(depth);
	float radius = nookStatRadius(depth);
	return vec2(abs(scale.x) * radius, abs(scale.y) * radius);
}

// Does a pixel, at nook.first or after it, hold depth?
bool nookStatHolds(ivec2 pixel)
{
	return pixel.x <= nook.last.x && pixel.y <= nook.last.y;
}

// Is the surface of a pixel in the tables: 1 yes, 0 no.
int nookStatKept(float depth)
{
	if (depth >= NOOK_SKY)
	{
		return 0;
	}
	vec2 box = nookStatBox(depth);
	return max(box.x, box.y) < nook.least_box_px ? 0 : 1;
}

// The position that the tables hold for a pixel: view-space x and y, and depth, in metres.
vec3 nookStatPlace(ivec2 pixel, float depth)
{
	vec3 p = nookPosition(pixel, depth);
	return vec3(p.x, p.y, depth);
}

// For 8 x 8 pixels: the smallest x, y and depth in texel (2i, j), and the smallest negated ones in texel (2i + 1, j).
vec4 nookStatRange(ivec2 texel)
{
	float side = texel.x % 2 == 0 ? 1.0f : -1.0f;
	vec3 least = vec3(NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pixel = ivec2(nook.first.x + (texel.x / 2) * 8 + i % 8, nook.first.y + texel.y * 8 + i / 8);
		if (nookStatHolds(pixel))
		{
			float depth = nookDepth(pixel);
			if (nookStatKept(depth) != 0)
			{
				least = min(least, nookStatPlace(pixel, depth) * side);
			}
		}
	}
	return vec4(least.x, least.y, least.z, 0.0f);
}

// Does the same for 8 x 8 of these pairs, of which there are nook_pass.x x nook_pass.y.
vec4 nookStatRangeUp(ivec2 texel)
{
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, 0.0f);
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pair = ivec2((texel.x / 2) * 8 + i % 8, texel.y * 8 + i / 8);
		if (pair.x < nook_pass.x && pair.y < nook_pass.y)
		{
			least = min(least, nookLevel(ivec2(pair.x * 2 + texel.x % 2, pair.y), 0));
		}
	}
	return least;
}

// The range in the form that later passes read. Texel 0: the smallest x, y and depth in the tables, and the number of steps
// that each range is divided into. Texel 1: the length of a step along each; ranges are at least a millionth of the radius.
// The number of steps is so small that the sum over the largest rectangle, that of the nearest pixel, stays below 2^32, and at
// most what a 32-bit float holds with two bits to spare.
vec4 nookStatFrame(ivec2 texel)
{
	vec4 least = nookLevel(ivec2(0, 0), 0);
	vec4 greatest = nookLevel(ivec2(1, 0), 0);
	vec2 box = vec2(0.0f, 0.0f);
	if (least.z < NOOK_SKY) // otherwise the tables stay empty
	{
		box = nookStatBox(least.z);
	}
	int more = 2 * 1;
	int area = (2 * int(box.x + 0.5f) + more) * (2 * int(box.y + 0.5f) + more);
	float steps = float(min(4294967295u / uint(area), 4194304u));
	if (texel.x == 0)
	{
		return vec4(least.x, least.y, least.z, steps);
	}
	float smallest = 1e-6f * nook.radius;
	return vec4(max(-greatest.x - least.x, smallest), max(-greatest.y - least.y, smallest), max(-greatest.z - least.z, smallest),
				0.0f) / steps;
}

// Sum over the cells from (box.x, box.y) up to, but without, (box.z, box.w).
uvec4 nookTableBox(ivec4 box, int table)
{
	return nookTable(ivec2(box.z, box.w), table) - nookTable(ivec2(box.x, box.w), table) - nookTable(ivec2(box.z, box.y), table) +
		   nookTable(ivec2(box.x, box.y), table);
}

// Number of pixels that hold depth, on each side. Cells and tiles are counted from nook.first.
ivec2 nookStatSize()
{
	return ivec2(nook.last.x - nook.first.x + 1, nook.last.y - nook.first.y + 1);
}

// The position of a pixel in steps, and 1; zeros for a pixel in no table.
uvec4 nookStatPoint(ivec2 pixel)
{
	if (!nookStatHolds(pixel))
	{
		return uvec4(0u, 0u, 0u, 0u);
	}
	float depth = nookDepth(pixel);
	if (nookStatKept(depth) == 0)
	{
		return uvec4(0u, 0u, 0u, 0u);
	}
	vec4 least = nookRange(0);
	vec4 step = nookRange(1);
	vec3 place = nookStatPlace(pixel, depth);
	return uvec4(uint(clamp((place.x - least.x) / step.x, 0.0f, least.w) + 0.5f),
				 uint(clamp((place.y - least.y) / step.y, 0.0f, least.w) + 0.5f),
				 uint(clamp((place.z - least.z) / step.z, 0.0f, least.w) + 0.5f), 1u);
}

// The cells around one whose depth is a mean of depths, about as far as the box at that depth extends: left, upper, right,
// lower.
ivec4 nookStatAround(ivec2 cell, float depth)
{
	vec2 box = nookStatBox(depth);
	int side = 1;
	int x = int(box.x / float(side) + 0.5f);
	int y = int(box.y / float(side) + 0.5f);
	ivec2 size = nookStatSize();
	return ivec4(max(cell.x - x, 0), max(cell.y - y, 0), min(cell.x + x + 1, (size.x + side - 1) / side),
				 min(cell.y + y + 1, (size.y + side - 1) / side));
}

// For a cell with the given sum over all its pixels: the sum over those in table nook_pass.z, 1 or more, of adaptive layers.
uvec4 nookStatNearer(ivec2 cell, uvec4 sum)
{
	int side = 1;
	float depth = nookRange(0).z + nookRange(1).z * (float(sum.z) / float(sum.w));
	ivec4 around = nookStatAround(cell, depth);
	uvec4 all = nookTableBox(around, 0);
	uvec4 near = uvec4(0u, 0u, 0u, 0u);
	if (nook_pass.z > 1)
	{
		near = nookTableBox(around, 1);
	}
	sum = uvec4(0u, 0u, 0u, 0u);
	for (int i = 0; i < side * side; ++i)
	{
		uvec4 point = nookStatPoint(ivec2(nook.first.x + cell.x * side + i % side, nook.first.y + cell.y * side + i / side));
		bool nearer = point.z * all.w < all.z;
		bool mine = nearer;
		if (nook_pass.z == 2)
		{
			mine = nearer && point.z * near.w < near.z;
		}
		if (nook_pass.z == 3)
		{
			mine = !nearer && point.z * (all.w - near.w) < all.z - near.z;
		}
		if (mine)
		{
			sum += point;
		}
	}
	return sum;
}

// A cell of a table before summing: the sum over its pixels that belong to the table (SVO 5, 7 and algorithm 1). Entries (0, y)
// and (x, 0) are 0.
// Adaptive layers: table 0 has all pixels; table 1 those nearer than the mean depth around them; table 2 those of table 1 that
// are nearer than the mean of table 1; table 3 those of the others that are nearer than the mean of the others. The remaining
// layers are differences. The comparison is exact, in integers: depth * n < sum.
// Uniform layers: table i has the layers 0 to i, the nearest first, so that single layers are differences.
uvec4 nookStatCells(ivec2 texel)
{
	uvec4 sum = uvec4(0u, 0u, 0u, 0u);
	if (texel.x == 0 || texel.y == 0)
	{
		return sum;
	}
	int side = 1;
	ivec2 cell = ivec2(texel.x - 1, texel.y - 1);
	for (int i = 0; i < side * side; ++i)
	{
		uvec4 point = nookStatPoint(ivec2(nook.first.x + cell.x * side + i % side, nook.first.y + cell.y * side + i / side));
		sum += point;
	}
	if (nook_pass.z > 0 && sum.w > 0u)
	{
		sum = nookStatNearer(cell, sum);
	}
	return sum;
}

// A pass that sums along x (axis nook_pass.y = 0) or y (1): adds eight entries that are nook_pass.x apart. After passes with
// strides 1, 8, 64, ... each entry is the sum of itself and all entries before it.
uvec4 nookTableSum(ivec2 texel)
{
	uvec4 sum = uvec4(0u, 0u, 0u, 0u);
	for (int i = 0; i < 8; ++i)
	{
		ivec2 there = ivec2(texel.x - i * nook_pass.x * (1 - nook_pass.y), texel.y - i * nook_pass.x * nook_pass.y);
		if (there.x >= 0 && there.y >= 0)
		{
			sum += nookTable(there, 0);
		}
	}
	return sum;
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

// Slope between two depths that differ by `rise`, of a function of depth that is affine in the picture on every plane.
float nookStatSlope(float depth, float rise)
{
	float near = nook.w_slope * depth + nook.w_start;
	float far = nook.w_slope * (depth + rise) + nook.w_start;
	return rise * (nook.w_slope * nook.w_slope + nook.w_start * nook.w_start) / (near * far);
}

// How much deeper than a pixel its tangent plane is `across` pixels away (x to the right, y downward); NOOK_SKY where the plane
// does not face the camera there. w: clip-space w of the pixel.
float nookStatRise(ivec2 pixel, vec2 across, float w)
{
	vec3 n = nookNormal(pixel);
	vec2 texel = nookTexel();
	float beside = n.x * texel.x * across.x + n.y * texel.y * across.y;
	float fall = nook.w_slope * beside - dot(n, nookSight(pixel));
	return fall > -1e-6f ? NOOK_SKY : -w * beside / fall;
}

// From a pixel to its neighbour: the smallest slope as x and the smallest negated slope as y, of the surface between them
// and of the tangent plane of the pixel. No bound where both pixels are in no table; an infinite slope where only one of them
// is.
vec2 nookStatStep(ivec2 pixel, ivec2 there)
{
	if (!nookStatHolds(there))
	{
		return vec2(NOOK_SKY, NOOK_SKY);
	}
	float depth = nookDepth(pixel);
	float beside = nookDepth(there);
	int kept = nookStatKept(depth);
	if (kept != nookStatKept(beside))
	{
		return vec2(-NOOK_SKY, -NOOK_SKY);
	}
	if (kept == 0)
	{
		return vec2(NOOK_SKY, NOOK_SKY);
	}
	float slope = nookStatSlope(depth, beside - depth);
	vec2 result = vec2(slope, -slope);
	vec2 across = vec2(float(there.x - pixel.x), float(there.y - pixel.y));
	float w = nook.w_slope * depth + nook.w_start;
	float rise = nookStatRise(pixel, across, w);
	if (rise >= NOOK_SKY || nook.w_slope * (depth + rise) + nook.w_start <= 0.0f)
	{
		return vec2(-NOOK_SKY, -NOOK_SKY);
	}
	float own = nookStatSlope(depth, rise);
	result = min(result, vec2(own, -own));
	return result;
}

// A texel for 8 x 8 pixels: bounds of nookStatStep along x (x, y) and along y (z, w).
vec4 nookStatSlopes(ivec2 tile)
{
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pixel = ivec2(nook.first.x + tile.x * 8 + i % 8, nook.first.y + tile.y * 8 + i / 8);
		if (nookStatHolds(pixel))
		{
			vec2 across = nookStatStep(pixel, ivec2(pixel.x + 1, pixel.y));
			vec2 down = nookStatStep(pixel, ivec2(pixel.x, pixel.y + 1));
			least = min(least, vec4(across.x, across.y, down.x, down.y));
		}
	}
	return least;
}

// Last texel of a level of the slopes.
ivec2 nookStatLast(int level)
{
	ivec2 size = nookStatSize();
	return ivec2(max(((size.x + 7) / 8) >> level, 1) - 1, max(((size.y + 7) / 8) >> level, 1) - 1);
}

// A texel of the next level, nook_pass.x, from 2 x 2 texels; from 3 on a side where the last one would be left over.
vec4 nookStatSlopesUp(ivec2 texel)
{
	int level = nook_pass.x;
	ivec2 last = nookStatLast(level);
	ivec2 source = nookStatLast(level - 1);
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int i = 0; i < 9; ++i)
	{
		ivec2 there = ivec2(texel.x * 2 + i % 3, texel.y * 2 + i / 3);
		bool mine = (i % 3 < 2 || texel.x == last.x) && (i / 3 < 2 || texel.y == last.y);
		if (mine && there.x <= source.x && there.y <= source.y)
		{
			least = min(least, nookLevel(there, level - 1));
		}
	}
	return least;
}

// For a tile of 8 x 8 pixels: 0 where layers would make no visible difference, else 1.
// With normals: 0 where everything that the box of these pixels reaches lies so close to the tangent plane of each pixel that
// no mean of a layer can be off it by more than 1/512 of the height of the box. Any path from one pixel to the other has slopes
// within their bounds. Without normals: 0 where all of it lies between the near and the far face of the box, since psi is
// linear there.
float nookStatFlags(ivec2 tile)
{
	float near = NOOK_SKY;
	float far = 0.0f;
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pixel = ivec2(nook.first.x + tile.x * 8 + i % 8, nook.first.y + tile.y * 8 + i / 8);
		if (nookStatHolds(pixel))
		{
			float depth = nookDepth(pixel);
			if (nookStatKept(depth) != 0)
			{
				near = min(near, depth);
				far = max(far, depth);
			}
		}
	}
	if (near >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec2 box = nookStatBox(near);
	vec2 reach = vec2(floor(box.x) + float(1), floor(box.y) + float(1));
	int level = 0;
	while (float(24 << level) < 2.0f * max(reach.x, reach.y) + 8.0f && nookStatLast(level) != ivec2(0, 0))
	{
		level = level + 1;
	}
	ivec2 last = nookStatLast(level);
	int left = max(tile.x * 8 - int(reach.x), 0) / 8;
	int upper = max(tile.y * 8 - int(reach.y), 0) / 8;
	ivec2 first = ivec2(min(left >> level, last.x), min(upper >> level, last.y));
	ivec2 end = ivec2(min(((tile.x * 8 + 7 + int(reach.x)) / 8) >> level, last.x),
					  min(((tile.y * 8 + 7 + int(reach.y)) / 8) >> level, last.y));
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int y = first.y; y <= end.y; ++y)
	{
		for (int x = first.x; x <= end.x; ++x)
		{
			least = min(least, nookLevel(ivec2(x, y), level));
		}
	}
	if (min(min(least.x, least.y), min(least.z, least.w)) <= -NOOK_SKY)
	{
		return 1.0f;
	}
	// Spread of the slopes, and their largest size; 0 where only one pixel is in the tables.
	vec2 spread = max(vec2(-least.x - least.y, -least.z - least.w), vec2(0.0f, 0.0f));
	vec2 steepest = max(-min(vec2(least.x, least.z), vec2(least.y, least.w)), vec2(0.0f, 0.0f));
	float total = nook.w_slope * nook.w_slope + nook.w_start * nook.w_start;
	float w = nook.w_slope * far + nook.w_start;
	// 1 / w decreases by slope * distance / total.
	float rest = 1.0f / w - nook.w_slope * dot(steepest, reach) / total;
	if (rest <= 0.0f)
	{
		return 1.0f;
	}
	float height = nook.box_height * nookStatRadius(near);
	float ray_x = abs(nook.w_slope * nook.across_x.x) + abs(nook.across_x.y);
	float ray_y = abs(nook.w_slope * nook.across_y.x) + abs(nook.across_y.y);
	float away = dot(spread, reach) / (rest * rest * total) * sqrt(1.0f + ray_x * ray_x + ray_y * ray_y);
	return away * 512.0f <= height ? 0.0f : 1.0f;
}

// Entry of one table minus those of up to two others, -1 for none: the sums of a layer that has no table of its own (SVO 7.2).
uvec4 nookStatEntry(int x, int y, ivec3 which)
{
	uvec4 entry = nookTable(ivec2(x, y), which.x);
	if (which.y >= 0)
	{
		entry = entry - nookTable(ivec2(x, y), which.y);
	}
	if (which.z >= 0)
	{
		entry = entry - nookTable(ivec2(x, y), which.z);
	}
	return entry;
}

// Sum over a rectangle of whole cells.
vec4 nookStatBetween(int x0, int y0, int x1, int y1, ivec3 which)
{
	uvec4 sum = nookStatEntry(x1, y1, which) - nookStatEntry(x0, y1, which) - nookStatEntry(x1, y0, which) +
				nookStatEntry(x0, y0, which);
	return vec4(float(sum.x), float(sum.y), float(sum.z), float(sum.w));
}

// Sum over a rectangle (left, upper, right, lower), in fractions of cells. Tables are interpolated linearly between entries
// (SVO 7.1): the cells cut at the four sides are added by their shares, from exact sums.
vec4 nookStatSum(vec4 box, ivec3 which)
{
	ivec4 whole = ivec4(int(floor(box.x)), int(floor(box.y)), int(floor(box.z)), int(floor(box.w)));
	return nookStatBetween(whole.x, whole.y, whole.z, whole.w, which);
}

// One layer (SVO eqs. 4, 6, 7 and psi): n * StatVO_i, and how many of its n pixels are left out of eq. 5, because they are so
// far in front of the box that they say nothing of what is in it. They fade out where psi has fallen to 0. `fill` turns a mean
// minus `centre` into the filled share: n / h of eq. 7 for x, y and depth in steps, and the share that is filled at height 0.
vec2 nookStatLayer(vec4 sum, vec3 centre, vec4 fill)
{
	vec3 mean = vec3(sum.x, sum.y, sum.z) / max(sum.w, 1e-3f);
	float t = dot(mean - centre, vec3(fill.x, fill.y, fill.z)) + fill.w;
	float over = max(t - 1.0f, 0.0f) * nook.slope;
	return sum.w * vec2(clamp(t, 0.0f, 1.0f) * max(1.0f - over, 0.0f), clamp(over - 1.0f, 0.0f, 1.0f));
}

// Share of the box that is filled by the pixels in one rectangle of cells, which has `area` pixels; 0 where it has none. Pixels
// in no table are open, and so is everything behind the box. `ends`: the uniform layers that contain the near and the far end
// of the box; layered = 0: all layers as one.
float nookStatFilled(vec4 box, float area, vec3 centre, vec4 fill, vec2 ends, int layered)
{
	vec2 sum = vec2(0.0f, 0.0f);
	if (layered == 0)
	{
		sum = nookStatLayer(nookStatSum(box, ivec3((4 - 1) * 0, -1, -1)), centre, fill);
	}
	else
	{
		// SVO algorithm 2: A2,0; A2,1 = A1,0 - A2,0; A2,2; A2,3 = A0 - A1,0 - A2,2
		sum = nookStatLayer(nookStatSum(box, ivec3(2, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(1, 2, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(3, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(0, 1, 3)), centre, fill);
	}
	return sum.x / max(area - sum.y, 1e-3f); // eq. 5
}

// An edge in pixels, converted to cells; the last cell may have fewer pixels than the others.
float nookStatEdge(float edge, int size)
{
	int side = 1;
	float full = float(size - size % side);
	if (edge > full)
	{
		return full / float(side) + (edge - full) / float(size % side);
	}
	return edge / float(side);
}

// Edges of a rectangle in pixels, converted to cells.
vec4 nookStatCellsOf(vec4 edges)
{
	ivec2 size = nookStatSize();
	return vec4(nookStatEdge(edges.x, size.x), nookStatEdge(edges.y, size.y), nookStatEdge(edges.z, size.x),
				nookStatEdge(edges.w, size.y));
}

// Area of a rectangle.
float nookStatArea(vec4 edges)
{
	return (edges.z - edges.x) * (edges.w - edges.y);
}

// The filled share for the whole rectangle, or the mean of those of its non-empty quadrants (SVO 6), which need nine look-ups
// per table instead of four where equal ones are shared. Edges and middle are in pixels.
float nookStatAll(vec4 edges, vec2 middle, vec3 centre, vec4 fill, vec2 ends, int layered)
{
	return nookStatFilled(nookStatCellsOf(edges), nookStatArea(edges), centre, fill, ends, layered);
}

// Does a pixel need layers: 1 yes; 0 no, all layers as one give the same result. `at` counts from the first pixel that holds
// depth.
int nookStatLayered(ivec2 at)
{
	return nookLevel(ivec2(at.x / 8, at.y / 8), 0).x > 0.5f ? 1 : 0;
}

// The uniform layers whose mean can have an effect: those of the box, and those in front of it until they are left out of eq.
// 5. They are limited to the existing layers as floats, because where all depths are alike the number of layers in a box
// exceeds every integer.
vec2 nookStatEnds(float depth, vec3 n)
{
	vec4 least = nookRange(0);
	float radius = nookStatRadius(depth);
	float height = nook.box_height * radius;
	float over = height * (1.0f + 2.0f / nook.slope);
	float aside = 0.0f;
	aside = 1.4143f * radius * sqrt(max(1.0f - n.z * n.z, 0.0f));
	float layers = float(4) / (nookRange(1).z * least.w);
	vec2 last = vec2(float(4 - 1), float(4 - 1));
	return clamp(vec2((depth - over - aside - least.z) * layers, (depth + height + aside - least.z) * layers), vec2(0.0f, 0.0f),
				 last);
}

// Visibility of a pixel, 1 - StatVO. With the normal, the box stands on the tangent plane (SVO 6). Without it, the box is
// aligned with the view direction and extends as far behind the pixel as in front of it (SVO 3), so that an open surface across
// the view reads 1/2.
float nookStatVo(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (nookStatKept(depth) == 0)
	{
		return 1.0f;
	}
	vec4 least = nookRange(0);
	vec4 step = nookRange(1);
	vec3 place = nookStatPlace(pixel, depth);
	vec3 centre = vec3((place.x - least.x) / step.x, (place.y - least.y) / step.y, (place.z - least.z) / step.z);
	float radius = nookStatRadius(depth);
	float height = nook.box_height * radius;
	vec3 n = vec3(0.0f, 0.0f, 0.5f);
	float ground = 0.5f;
	n = nookNormal(pixel);
	ground = 0.0f;
	vec4 fill = vec4(step.x * n.x / height, step.y * n.y / height, -step.z * n.z / height, ground);

	ivec2 at = ivec2(pixel.x - nook.first.x, pixel.y - nook.first.y);
	int layered = nookStatLayered(at);
	vec2 ends = nookStatEnds(depth, n);

	vec2 box = nookStatBox(depth);
	float fade = clamp(max(box.x, box.y) / nook.least_box_px - 1.0f, 0.0f, 1.0f); // fades to open before the box is too small for the tables
	vec2 middle = vec2(float(at.x) + 0.5f, float(at.y) + 0.5f);
	vec4 edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x, middle.y + box.y);
	middle = vec2(float(at.x), float(at.y));
	box = floor(box + vec2(0.5f, 0.5f));
	edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x + 1.0f, middle.y + box.y + 1.0f);
	vec2 size = vec2(nookStatSize());
	edges = clamp(edges, vec4(0.0f, 0.0f, 0.0f, 0.0f), vec4(size.x, size.y, size.x, size.y));
	// Two branches, so that the look-ups of each have no further branches.
	float filled = 0.0f;
	if (layered == 0)
	{
		filled = nookStatAll(edges, middle, centre, fill, ends, 0);
	}
	else
	{
		filled = nookStatAll(edges, middle, centre, fill, ends, 1);
	}
	float open = 1.0f - filled * fade;
	return open;
}

#endif // NOOK_STATVO_GLSL
