// Made by: nook emit --methods statvo --recipe paper --glsl es300
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Visibility, 1 where open, of the pixel of a depth buffer:
//   float nookStatVo(ivec2 pixel): statistical volumetric obscurance
// Passes, in order, each a function of the texel that is drawn, into a picture of its own:
//   width, height: of all pixels that hold depth, those of a guard band included
//   nookStatRange(texel): RGBA32F, 2 ceil(width / 8) x ceil(height / 8)
//   nookStatRangeUp(texel), until 2 x 1 are left: RGBA32F, 2 ceil(w / 8) x ceil(h / 8); reads the one before as nook_levels;
//       nook_pass.xy = (w, h): half the width, and the height, of that
//   nookStatFrame(texel): RGBA32F, 2 x 1; reads the last one as nook_levels; nook_range from here on
//   for each table t from 0 to 3:
//       nookStatCells(texel): RGBA32UI, ceil(width / 1) + 1 x ceil(height / 1) + 1; nook_pass.z = t; reads the tables made so far
//       nookTableSum(texel): the same size, reads the one before as nook_tables; for axis 0, then 1, with strides 1, 8, 64, ...
//       below the side's length; nook_pass.xy = (stride, axis). The last one fills layer t of nook_tables
//   nookStatSlopes(texel): level 0 of a picture RGBA32F, ceil(width / 8) x ceil(height / 8), with all mip levels
//   nookStatSlopesUp(texel): its other levels, as nook_levels; nook_pass.x = level
//   nookStatFlags(texel): R32F, the size of its level 0, which is nook_levels here; nook_levels from here on
//   nookStatVo(texel): visibility, R8 or better, the picture's size
// Pixels count as texelFetch does. `nook emit -o FILE.h` writes the C++ that fills the block, `-o FILE.js` the JavaScript.
// Without #version, to be included after yours. All names begin with nook or NOOK.
//
// Any camera without a skew: positions from depth, and how large a length is in the picture.
//
// Depth buffers of any projection and format, and how far to look.
//
// Summed-area tables of unsigned integers, which wrap around: the sum over a rectangle is exact as long as it is itself below 2^32,
// whatever the tables' entries are.
// This work is based on: F. C. Crow, "Summed-Area Tables for Texture Mapping", SIGGRAPH 1984, and J. Hensley, T. Scheuermann,
// G. Coombe, M. Singh, A. Lastra, "Fast Summed-Area Table Generation and its Applications", Eurographics 2005 (recursive doubling).
//
// What the tables of statistical volumetric obscurance hold: positions in whole steps, of all pixels and of layers.
// This work is based on: Q. Hendrickx, L. Scandolo, M. Eisemann, E. Eisemann, "Adaptively Layered Statistical Volumetric Obscurance",
// HPG 2015 (SVO).
//
// Where statistical volumetric obscurance needs no layers: a surface without creases and edges around a tile of 8 x 8 pixels.
// A remark of nook's own; the paper evaluates all layers everywhere.
//
// Statistical volumetric obscurance: how much of a box over a pixel its neighbours' mean height fills, layer by layer.
// This work is based on: Q. Hendrickx, L. Scandolo, M. Eisemann, E. Eisemann, "Adaptively Layered Statistical Volumetric Obscurance",
// HPG 2015 (SVO).
#ifndef NOOK_STATVO_GLSL
#define NOOK_STATVO_GLSL
#if !defined(GL_ES) || __VERSION__ < 300
#error nook: this module needs #version 300 es or later
#endif
// Depths need them. What follows in your shader has them too, unless it says otherwise.
precision highp float;
precision highp int;
precision highp sampler2D;
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// Lengths are in metres, or whatever unit your depths have.
layout(std140) uniform nook_block
{
	vec2 size; // width and height of the picture in pixels
	vec2 pixel_size; // 1 / width, 1 / height
	vec2 across_x; // of the projection P: 1 / P00, P20 / P00 (P20: column 2, row 0)
	vec2 across_y; // 1 / P11 (negative where the first row of pixels is that of NDC y = -1), P21 / P11
	vec2 aside; // -P30 / P00, -P31 / P11
	float w_slope; // w after the projection, of a depth d: w_slope * d + w_start
	float w_start; // see w_slope
	ivec2 first; // first pixel with depth
	ivec2 last; // last pixel with depth
	vec4 depth; // depth at a device depth t away from the far end: (x + y * t) / (z + w * t)
	vec2 origin; // the picture's first pixel in the texture
	float far_end; // what device depth is at the far end, 0 or 1
	float depth_step; // a depth may be off by depth_step * w * w + depth_share * depth
	float depth_share; // see depth_step
	float normal_error; // sine of the angle by which a normal may be off
	float radius; // in metres, or in the unit of your depths
	float second_radius; // volumetric obscurance: in the unit of the radius
	float third_radius; // volumetric obscurance: in the unit of the radius
	float thickness; // volumetric obscurance: of surfaces, in the unit of the radius
	float second_thickness; // the same for the second radius
	float third_thickness; // the same for the third radius
	float first_band_px; // of the bands: below a radius of so many pixels the first one's samples are taken
	float second_band_px; // of three bands: below it the first two's
	float most_px; // most pixels of a radius in the picture
	float least_px; // least pixels of a radius in the picture
	float sigma; // Alchemy: intensity
	float contrast; // Alchemy: k
	float beta; // Alchemy: bias, a share of the depth
	float epsilon; // Alchemy: in squares of the radius
	float box_height; // statistical volumetric obscurance: height of the box in radii
	float slope; // statistical volumetric obscurance: slope of psi
	float largest_px; // statistical volumetric obscurance: largest half side of the box in pixels
	float least_box_px; // statistical volumetric obscurance: least half side of the box in pixels
	float slice_thickness; // slices: of surfaces at the reach, in radii
	float strength; // factor of the obscurance
	float power; // of visibility, after the strength
	float frame; // its number, for tiles of several frames
} nook;

// Of the pass that is drawn; the list above says what.
uniform ivec4 nook_pass;

// Depth along the view direction, > 0, linear; NOOK_SKY or more where there is no surface.
// Define NOOK_DEPTH(pixel) first to read yours in another way.
#ifndef NOOK_DEPTH
uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}

// Unit normal in view space: x right, y up, z toward the camera.
// Define NOOK_NORMAL(pixel) first to read yours in another way.
#ifndef NOOK_NORMAL
uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

// What a pass before drew, with mip levels where there are some. Drawing a level, allow reads of those below it alone.
uniform sampler2D nook_levels;
vec4 nookLevel(ivec2 texel, int level)
{
	return texelFetch(nook_levels, texel, level);
}

// Sums: RGBA, unsigned 32-bit integers, a layer a table.
uniform highp usampler2DArray nook_tables;
uvec4 nookTable(ivec2 texel, int table)
{
	return texelFetch(nook_tables, ivec3(texel, table), 0);
}

// The two texels that the last range pass drew.
uniform sampler2D nook_range;
vec4 nookRange(int i)
{
	return texelFetch(nook_range, ivec2(i, 0), 0);
}

// View-space position of what a pixel shows at a depth. nook.across_x = (1/P00, P20/P00) and nook.across_y = (1/P11, P21/P11),
// nook.aside = (-P30/P00, -P31/P11); w after the projection is nook.w_slope * depth + nook.w_start, of -P23 and P33.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.pixel_size.x * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.pixel_size.y * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.aside.x,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.aside.y, -depth);
}

// Pixels per metre across the view direction at a depth: x to the right, y downward.
vec2 nookScale(float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	return vec2(0.5f * nook.size.x / (w * nook.across_x.x), 0.5f * nook.size.y / (w * nook.across_y.x));
}

// A radius as it is used at a depth: in the picture at most nook.most_px pixels, and at least nook.least_px.
float nookRadius(float radius, float depth)
{
	vec2 scale = nookScale(depth);
	float pixels = max(abs(scale.x), abs(scale.y));
	return max(min(radius, nook.most_px / pixels), nook.least_px / pixels);
}

// Half side of the box in metres: so that in the picture it is at most nook.largest_px pixels.
float nookStatRadius(float depth)
{
	vec2 scale = nookScale(depth);
	return min(nookRadius(nook.radius, depth), nook.largest_px / max(abs(scale.x), abs(scale.y)));
}

// In pixels.
vec2 nookStatBox(float depth)
{
	vec2 scale = nookScale(depth);
	float radius = nookStatRadius(depth);
	return vec2(abs(scale.x) * radius, abs(scale.y) * radius);
}

bool nookStatHolds(ivec2 pixel)
{
	return pixel.x <= nook.last.x && pixel.y <= nook.last.y;
}

// Is a pixel's surface in the tables: 1 yes, 0 no.
int nookStatKept(float depth)
{
	if (depth >= NOOK_SKY)
	{
		return 0;
	}
	vec2 box = nookStatBox(depth);
	return max(box.x, box.y) < nook.least_box_px ? 0 : 1;
}

// What the tables hold of a pixel, in metres.
vec3 nookStatPlace(ivec2 pixel, float depth)
{
	vec3 p = nookPosition(pixel, depth);
	return vec3(p.x, p.y, depth);
}

// Of 8 x 8 pixels, the least x, y and depth in texel (2i, j), and in (2i + 1, j) the least of them negated.
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

// The same of 8 x 8 of these pairs; there are nook_pass.x times nook_pass.y of them.
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

// What every later pass asks of the last pair: texel 0: the least x, y and depth in the tables, and into how many steps the spans to the
// greatest are divided; texel 1: a step's length (of spans of at least a millionth of the radius).
// So many steps that the largest rectangle, the nearest pixel's, still sums to below 2^32; at most what a 32-bit float holds with two
// bits to spare.
vec4 nookStatFrame(ivec2 texel)
{
	vec4 least = nookLevel(ivec2(0, 0), 0);
	vec4 greatest = nookLevel(ivec2(1, 0), 0);
	vec2 box = vec2(0.0f, 0.0f);
	if (least.z < NOOK_SKY) // else the tables stay empty
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

// Over the cells from (box.x, box.y) up to, without it, (box.z, box.w).
uvec4 nookTableBox(ivec4 box, int table)
{
	return nookTable(ivec2(box.z, box.w), table) - nookTable(ivec2(box.x, box.w), table) - nookTable(ivec2(box.z, box.y), table) +
		   nookTable(ivec2(box.x, box.y), table);
}

// How many pixels hold depth. Cells and tiles are counted from nook.first.
ivec2 nookStatSize()
{
	return ivec2(nook.last.x - nook.first.x + 1, nook.last.y - nook.first.y + 1);
}

// What the tables hold of a pixel, in steps, and 1; zeros where it is in none.
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

// The cells around one whose depth is a mean of depths, about as far as the box of that depth reaches: left, upper, right, lower.
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

// Of a cell whose sum is given, what is in table nook_pass.z, 1 or more, of adaptive layers.
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

// A cell of a table before it is summed up: the sum over its pixels that are in the table (SVO 5, 7 and algorithm 1). Entry (0, y)
// and (x, 0) are 0.
// Adaptive layers: table 0 has all; 1 what is nearer than the mean depth around it; 2 what of that is nearer than the mean of these;
// 3 what of the others is nearer than their mean. The rest are differences. Integers decide: depth * n < sum.
// Uniform layers: table i has the layers 0 to i, the nearest first, so that layers are differences as well.
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

// One of the passes that sum along x (nook_pass.y = 0) or y (1): eight entries, nook_pass.x apart. With strides 1, 8, 64, ... each
// entry becomes the sum of all before it and itself.
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

// Depth at which a line of sight is `height` metres above the tangent plane of a pixel, less the depth of that pixel; NOOK_SKY where
// the plane does not face the camera there. `across`: from the pixel's middle to the line, in pixels (x right, y down): from the
// distance alone, since the depths themselves would leave nothing of it far away.
float nookPlaneRiseAt(ivec2 pixel, vec2 across, vec3 n, float depth, float height)
{
	float w = nook.w_slope * depth + nook.w_start;
	float x = 2.0f * across.x * nook.pixel_size.x * nook.across_x.x;
	float y = -2.0f * across.y * nook.pixel_size.y * nook.across_y.x;
	vec3 sight = nookPosition(pixel, 1.0f) - nookPosition(pixel, 0.0f);
	float fall = dot(n, vec3(sight.x + nook.w_slope * x, sight.y + nook.w_slope * y, sight.z));
	if (fall > -1e-6f)
	{
		return NOOK_SKY;
	}
	return (height - w * (n.x * x + n.y * y)) / fall;
}

// On the line of sight of another pixel's middle.
float nookPlaneRise(ivec2 pixel, ivec2 there, vec3 n, float depth, float height)
{
	return nookPlaneRiseAt(pixel, vec2(float(there.x - pixel.x), float(there.y - pixel.y)), n, depth, height);
}

// A function of depth that is linear in x and y of the picture along any plane: the slope between two depths that are `rise` apart.
float nookStatSlope(float depth, float rise)
{
	float near = nook.w_slope * depth + nook.w_start;
	float far = nook.w_slope * (depth + rise) + nook.w_start;
	return rise * (nook.w_slope * nook.w_slope + nook.w_start * nook.w_start) / (near * far);
}

// From a pixel to the one beside it: the least slope, and the least of them negated, of the surface and of the pixel's own plane;
// none where both are in no table, any where one is.
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
	float rise = nookPlaneRise(pixel, there, nookNormal(pixel), depth, 0.0f);
	if (rise >= NOOK_SKY || nook.w_slope * (depth + rise) + nook.w_start <= 0.0f)
	{
		return vec2(-NOOK_SKY, -NOOK_SKY);
	}
	float own = nookStatSlope(depth, rise);
	result = min(result, vec2(own, -own));
	return result;
}

// Of 8 x 8 pixels: nookStatStep to the right in x and y, downward in z and w.
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

// The next level, nook_pass.x, of 2 x 2; of 3 where the last one would be left over.
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

// Of a tile of 8 x 8 pixels: 0 where layers change nothing that can be seen, else 1.
// With the normal: where all that a box of these pixels reaches lies so close to every pixel's tangent plane that no layer's mean
// can be more than 1/512 of the height away from it. Every path over slopes between their bounds leads from one pixel to the other.
// Without: where all of it lies between the near and the far face of the box, for there psi is linear.
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
	// The slopes' own spread, and how far they can lead; nothing where there is but one pixel in the tables.
	vec2 spread = max(vec2(-least.x - least.y, -least.z - least.w), vec2(0.0f, 0.0f));
	vec2 steepest = max(-min(vec2(least.x, least.z), vec2(least.y, least.w)), vec2(0.0f, 0.0f));
	float total = nook.w_slope * nook.w_slope + nook.w_start * nook.w_start;
	float w = nook.w_slope * far + nook.w_start;
	// 1 / w falls by the slope times x / total of it.
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

// An entry of one table less those of two others, -1 for none: of a layer that has no table of its own (SVO 7.2).
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

vec4 nookStatBetween(int x0, int y0, int x1, int y1, ivec3 which)
{
	uvec4 sum = nookStatEntry(x1, y1, which) - nookStatEntry(x0, y1, which) - nookStatEntry(x1, y0, which) +
				nookStatEntry(x0, y0, which);
	return vec4(float(sum.x), float(sum.y), float(sum.z), float(sum.w));
}

// Sum over a rectangle of cells (left, upper, right, lower, as parts of cells). Between entries tables are linear (SVO 7.1): what is cut
// off at the four sides is taken out by parts, of exact sums.
vec4 nookStatSum(vec4 box, ivec3 which)
{
	ivec4 whole = ivec4(int(floor(box.x)), int(floor(box.y)), int(floor(box.z)), int(floor(box.w)));
	return nookStatBetween(whole.x, whole.y, whole.z, whole.w, which);
}

// One layer (SVO eqs. 4, 6, 7 and psi): n * StatVO_i, and how many of its n pixels do not count in eq. 5, for they lie so far in front
// of the box that they say nothing of what is in it. They fade out where psi has come down to 0.
// `fill` turns a mean, less `centre`, into the filled share: eq. 7's n / h for x, y, depth in steps; and what is filled at height 0.
vec2 nookStatLayer(vec4 sum, vec3 centre, vec4 fill)
{
	vec3 mean = vec3(sum.x, sum.y, sum.z) / max(sum.w, 1e-3f);
	float t = dot(mean - centre, vec3(fill.x, fill.y, fill.z)) + fill.w;
	float over = max(t - 1.0f, 0.0f) * nook.slope;
	return sum.w * vec2(clamp(t, 0.0f, 1.0f) * max(1.0f - over, 0.0f), clamp(over - 1.0f, 0.0f, 1.0f));
}

// Filled share of the box by what is in one rectangle of cells, which has `area` pixels; 0 where it has none. Pixels in no table are
// open, as is what lies behind the box. `ends`: the uniform layers that the box's near and far end lie in; layered = 0: all layers as
// one.
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

// An edge, in pixels, as cells; the last cell may have fewer pixels than others.
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

vec4 nookStatCellsOf(vec4 edges)
{
	ivec2 size = nookStatSize();
	return vec4(nookStatEdge(edges.x, size.x), nookStatEdge(edges.y, size.y), nookStatEdge(edges.z, size.x),
				nookStatEdge(edges.w, size.y));
}

float nookStatArea(vec4 edges)
{
	return (edges.z - edges.x) * (edges.w - edges.y);
}

// Of the whole rectangle, or the mean of its quadrants that are not empty (SVO 6), with nine look-ups a table instead of four where
// equal ones are done once. Edges and middle in pixels.
float nookStatAll(vec4 edges, vec2 middle, vec3 centre, vec4 fill, vec2 ends, int layered)
{
	return nookStatFilled(nookStatCellsOf(edges), nookStatArea(edges), centre, fill, ends, layered);
}

// Does a pixel look at layers: 1 yes, 0: at all of them as one. From the picture's first pixel.
int nookStatLayered(ivec2 at)
{
	return nookLevel(ivec2(at.x / 8, at.y / 8), 0).x > 0.5f ? 1 : 0;
}

// The uniform layers between which a mean can count: those of the box, and of what lies before it until it does not count in eq. 5.
// Held between the first and the last as floats: where all depths are alike, no integer counts the layers of a box.
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

// Visibility of a pixel: 1 - StatVO. With the normal, the box stands on the tangent plane (SVO 6). Without, it is aligned with the view
// direction and reaches as far behind the pixel as before it (SVO 3), so that an open surface across the view reads 1/2.
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
	float fade = clamp(max(box.x, box.y) / nook.least_box_px - 1.0f, 0.0f, 1.0f); // toward what is in no table
	vec2 middle = vec2(float(at.x) + 0.5f, float(at.y) + 0.5f);
	vec4 edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x, middle.y + box.y);
	middle = vec2(float(at.x), float(at.y));
	box = floor(box + vec2(0.5f, 0.5f));
	edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x + 1.0f, middle.y + box.y + 1.0f);
	vec2 size = vec2(nookStatSize());
	edges = clamp(edges, vec4(0.0f, 0.0f, 0.0f, 0.0f), vec4(size.x, size.y, size.x, size.y));
	// Apart, so that look-ups are straight on in both.
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
