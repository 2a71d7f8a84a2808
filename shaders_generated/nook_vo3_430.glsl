// Made by: nook emit --methods vo-line --patterns disk_003_tile4.json --filter bilateral --glsl 430
// Version: nook 0.1.0
// Base pattern: nook tile --pattern disk_003.json --size 4
// SPDX-License-Identifier: MIT
//
// Visibility, 1 where open, of the pixel of a depth buffer:
//   float nookVoLine(ivec2 pixel): volumetric obscurance by lines, 3 samples, others in each pixel of 4 x 4
//       fitted to rays that reach so far: radius 0.522, --combine product --power 1.15 --radius2 0.138 --radius3 0.034 --strength 0.8 --thickness 0.769 --thickness2 0.256 --thickness3 0.0828
// Passes, in order, each a function of the texel that is drawn, into a picture of its own:
//   nookVoLineLinked(texel): visibility and what the filter needs, RGBA, 8 bits or better, the picture's size
//   nookBilateralX(texel): RGBA, 8 bits or better, as large; reads it as nook_packed
//   nookBilateralY(texel): visibility, R8 or better, as large; reads that as nook_packed
// Pixels count as texelFetch does. `nook emit -o FILE.h` writes the C++ that fills the block, `-o FILE.js` the JavaScript.
// Without #version, to be included after yours. All names begin with nook or NOOK.
//
// Any camera without a skew: positions from depth, and how large a length is in the picture.
//
// Depth buffers of any projection and format, and how far to look.
//
// What artists turn last: how strong obscurance is, and a power of visibility. Fitted to rays by `nook fit`.
//
// Volumetric obscurance: the open share of the ball around a point, by lines along the view direction, by points, or by areas.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// Noisy visibility → clean: filters that stay on the pixel's own surface, and half resolution back to full.
// The two one-dimensional passes are those of: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
#ifndef NOOK_VO_LINE_GLSL
#define NOOK_VO_LINE_GLSL
#if __VERSION__ < 430
#error nook: this module needs #version 430 or later
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// Lengths are in metres, or whatever unit your depths have.
#ifndef NOOK_BLOCK_BINDING
#define NOOK_BLOCK_BINDING 0
#endif
layout(std140, binding = NOOK_BLOCK_BINDING) uniform nook_block
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

// Depth along the view direction, > 0, linear; NOOK_SKY or more where there is no surface.
// Define NOOK_DEPTH(pixel) first to read yours in another way.
#ifndef NOOK_DEPTH
#ifndef NOOK_DEPTHS_BINDING
#define NOOK_DEPTHS_BINDING 1
#endif
layout(binding = NOOK_DEPTHS_BINDING) uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}

// Unit normal in view space: x right, y up, z toward the camera.
// Define NOOK_NORMAL(pixel) first to read yours in another way.
#ifndef NOOK_NORMAL
#ifndef NOOK_NORMALS_BINDING
#define NOOK_NORMALS_BINDING 2
#endif
layout(binding = NOOK_NORMALS_BINDING) uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

// Visibility as the pass before drew it, and what it wrote beside it.
#ifndef NOOK_PACKED_BINDING
#define NOOK_PACKED_BINDING 11
#endif
layout(binding = NOOK_PACKED_BINDING) uniform sampler2D nook_packed;
vec4 nookPacked(ivec2 cell)
{
	return texelFetch(nook_packed, cell, 0);
}

// Row of a pixel as it counts from the top of what the camera sees, whichever row is first: so tiles and windows lie on a picture the
// same way for both orders of rows.
int nookRow(int y)
{
	return nook.across_y.x < 0.0f ? int(2.0f * nook.origin.y + nook.size.y) - 1 - y : y;
}

// x,y,half_length,weight of each sample, for a radius of 1: RGBA, 32-bit floats, 16 x 3 texels.
#ifndef NOOK_VO_LINE_TILE_BINDING
#define NOOK_VO_LINE_TILE_BINDING 3
#endif
layout(binding = NOOK_VO_LINE_TILE_BINDING) uniform sampler2D nook_vo_line_tile;
vec4 nookVoLineSample(int row, int i)
{
	return texelFetch(nook_vo_line_tile, ivec2(row, i), 0);
}
int nookVoLineVariant(ivec2 pixel)
{
	return (nookRow(pixel.y) % 4) * 4 + pixel.x % 4;
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

ivec2 nookInside(ivec2 pixel)
{
	return ivec2(clamp(pixel.x, nook.first.x, nook.last.x), clamp(pixel.y, nook.first.y, nook.last.y));
}

// The pixel that lies `offset` metres (x right, y up) from the middle of a pixel, also beyond the picture.
ivec2 nookBeside(ivec2 pixel, vec2 offset, vec2 scale)
{
	float x = float(pixel.x) + 0.5f + offset.x * scale.x;
	float y = float(pixel.y) + 0.5f - offset.y * scale.y;
	return ivec2(int(floor(x)), int(floor(y)));
}

// The same, or the nearest one that holds depth.
ivec2 nookNeighbour(ivec2 pixel, vec2 offset, vec2 scale)
{
	return nookInside(nookBeside(pixel, offset, scale));
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

// How many samples a pixel takes whose radius is that many pixels: those of the first band, of the first two, or all.
int nookCount(float pixels)
{
	return 3;
}

// By how much a depth may be off, in its unit: a step of a depth buffer stands for a length that grows with the square of w.
// nook.depth_step = half a step for w = 1, nook.depth_share = rounding as a share of the depth.
float nookDepthError(float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	return nook.depth_step * w * w + nook.depth_share * abs(depth);
}

// What two depths of one ball may differ by though their surfaces do not: without it coarse depths make surfaces occlude themselves.
float nookSlack(float depth, float radius)
{
	return nookDepthError(depth) + nookDepthError(depth + radius);
}

// A radius as it is used at a depth: in the picture at most nook.most_px pixels, and at least nook.least_px.
float nookRadius(float radius, float depth)
{
	vec2 scale = nookScale(depth);
	float pixels = max(abs(scale.x), abs(scale.y));
	return max(min(radius, nook.most_px / pixels), nook.least_px / pixels);
}

// Integral of the falloff along a line, from its beginning at -reach to `end` <= reach. Constant (VO 3: volume alone), or 1 - d^2
// at a distance of d radii.
float nookAlong(float reach, float end)
{
	return end + reach;
}

// The open part of a line that ends at `end`, where the surface is at `front` and `thick` (VO 4.3).
float nookOpen(float reach, float end, float front, float thick)
{
	float open = nookAlong(reach, clamp(front, -reach, end));
	open += nookAlong(reach, end) - nookAlong(reach, clamp(front + thick, -reach, end));
	return open;
}

// The normal where it is used, so that without it no picture of normals is needed.
vec3 nookVoNormal(ivec2 pixel)
{
	return nookNormal(pixel);
}

// A line of the disk: (x, y, half length, weight) -> its open part, all of it (as far as the tangent plane), and how far out of
// range its surface is: 0 in the ball's slab, 1 from a radius in front of the ball on.
vec3 nookVoLineAt(ivec2 pixel, vec4 line, vec2 scale, vec3 n, float depth, float radius, float thick)
{
	ivec2 there = nookNeighbour(pixel, vec2(line.x, line.y), scale * radius);
	float end = line.z;
	end = clamp(nookPlaneRise(pixel, there, n, depth, 0.0f) / radius, -line.z, line.z);
	float front = nookDepth(there) - depth;
	front += nookSlack(depth, radius);
	front = front / radius;
	float share = line.w / max(nookAlong(line.z, line.z), 1e-20f); // a line on the rim has no length, and counts for nothing
	float open = share * nookOpen(line.z, end, front, thick / radius);
	return vec3(open, share * nookAlong(line.z, end), clamp(-1.0f - front, 0.0f, 1.0f));
}

// VO 4.1 and 4.4. With the normal the lines end at the tangent plane, and the sum is divided by what it would be with nothing in the
// way. Without it an open surface that faces the camera reads 1/2. Of paired samples 2i and 2i + 1 are opposite.
float nookVoLineIn(ivec2 pixel, vec3 n, float depth, float radius, float thick)
{
	vec2 scale = nookScale(depth);
	float pixels = max(abs(scale.x), abs(scale.y)) * radius;
	if (pixels < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
	int count = nookCount(pixels);
	int row = nookVoLineVariant(pixel);
	float open = 0.0f;
	float whole = 0.0f;
	vec3 before = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < count; ++i)
	{
		vec3 own = nookVoLineAt(pixel, nookVoLineSample(row, i), scale, n, depth, radius, thick);
		open += own.x;
		whole += own.y;
	}
	if (whole > 0.0f)
	{
		return clamp(open / whole, 0.0f, 1.0f); // both are rounded
	}
	return 1.0f;
}

// Two radii (VO 5): both results multiplied (1), or the lesser (2). A third one is our own.
float nookBoth(float open, float other)
{
	return open * other;
}

float nookVoLine(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookVoNormal(pixel);
	float open = nookVoLineIn(pixel, n, depth, nookRadius(nook.radius, depth), nook.thickness);
	open = nookBoth(open, nookVoLineIn(pixel, n, depth, nookRadius(nook.second_radius, depth), nook.second_thickness));
	open = nookBoth(open, nookVoLineIn(pixel, n, depth, nookRadius(nook.third_radius, depth), nook.third_thickness));
	return open;
}

ivec2 nookPixel(ivec2 cell)
{
	return cell * 1;
}

ivec2 nookLastCell()
{
	return ivec2((int(nook.origin.x + nook.size.x) - 1) / 1, (int(nook.origin.y + nook.size.y) - 1) / 1);
}

// How far, as a share of the radius, two positions are from the tangent plane that they share: the plane between the two normals
// holds both ends of any arc of a circle, so that columns are as smooth as walls. Unlike a difference of depths it is 0 along a plane
// at any slope; and visibility can change by no more than about its size.
float nookApartFrom(vec3 centre, vec3 n, vec3 there, vec3 n_there)
{
	return abs(dot(n + n_there, there - centre)) / (2.0f * nook.radius);
}

// Of a pixel's position from a pixel; NOOK_SKY for sky.
float nookApart(vec3 centre, vec3 n, ivec2 there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return nookApartFrom(centre, n, nookPosition(there, depth), nookNormal(there));
}

// Do two show the same surface: 1 yes, 0 no. Flat at both ends, so that on a smooth surface all pixels count alike, which is what
// makes the mean of a window of variants exact. Chosen by eye on builtin:courtyard, not swept.
float nookAlikeOf(float apart, vec3 n, vec3 n_there)
{
	float beside = clamp(2.0f - apart * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, n_there) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

float nookAlike(vec3 centre, vec3 n, ivec2 there)
{
	return nookAlikeOf(nookApart(centre, n, there), n, nookNormal(there));
}

// What the bilateral filter reads of a cell, all in one texel: visibility, and whether the next cell along x and the next one along y
// show the same surface. 8 bits each are enough.
vec4 nookLinked(ivec2 cell, float visibility)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	float open = 1.0f;
	float along_x = 0.0f;
	float along_y = 0.0f;
	if (depth < NOOK_SKY)
	{
		open = visibility;
		vec3 n = nookNormal(pixel);
		vec3 centre = nookPosition(pixel, depth);
		ivec2 last = nookLastCell();
		if (cell.x < last.x)
		{
			along_x = nookAlike(centre, n, nookPixel(ivec2(cell.x + 1, cell.y)));
		}
		if (cell.y < last.y)
		{
			along_y = nookAlike(centre, n, nookPixel(ivec2(cell.x, cell.y + 1)));
		}
	}
	return vec4(open, along_x, along_y, 1.0f);
}

vec4 nookVoLineLinked(ivec2 cell)
{
	return nookLinked(cell, nookVoLine(nookPixel(cell)));
}

// Of the picture, as far as it is drawn: a guard band is not.
ivec2 nookFirstCell()
{
	return ivec2((int(nook.origin.x) + 1 - 1) / 1, (int(nook.origin.y) + 1 - 1) / 1);
}

// The mean over 2 cells to either side of a cell, along x (axis 1, 0) or y (0, 1). A cell counts as far as all cells up to it
// show the same surface.
float nookMeanAlong(ivec2 cell, ivec2 axis)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	vec4 own = nookPacked(cell);
	float width = 0.5f * float(2 + 1);
	float link_x = float(axis.x);
	float link_y = float(axis.y);
	float sum = own.x;
	float weights = 1.0f;
	float before = 1.0f;
	float after = link_x * own.y + link_y * own.z;
	for (int i = 1; i <= 2; ++i)
	{
		float falls = exp(-0.5f * float(i * i) / (width * width));
		ivec2 there = ivec2(cell.x - i * axis.x, cell.y - i * axis.y);
		if (there.x < first.x || there.y < first.y)
		{
			before = 0.0f;
		}
		vec4 one = nookPacked(ivec2(max(there.x, first.x), max(there.y, first.y)));
		before *= link_x * one.y + link_y * one.z;
		vec4 other = nookPacked(ivec2(min(cell.x + i * axis.x, last.x), min(cell.y + i * axis.y, last.y)));
		sum += falls * (before * one.x + after * other.x);
		weights += falls * (before + after);
		after *= link_x * other.y + link_y * other.z;
	}
	return sum / weights;
}

// The two passes, in this order.
vec4 nookBilateralX(ivec2 cell)
{
	vec4 own = nookPacked(cell);
	return vec4(nookMeanAlong(cell, ivec2(1, 0)), own.y, own.z, 1.0f);
}

// Of the last pass, where nook.strength or nook.power is not 1. Open surfaces stay at 1.
float nookShaped(float open)
{
	return pow(max(0.0f, 1.0f - nook.strength * (1.0f - open)), nook.power);
}

float nookBilateralY(ivec2 cell)
{
	float open = nookMeanAlong(cell, ivec2(0, 1));
	open = nookShaped(open);
	return open;
}

#endif // NOOK_VO_LINE_GLSL
