// Made by: nook emit --methods vo-area --patterns disk_009_tile4.json --recipe paper --filter bilateral --glsl es300
// Version: nook 0.1.0
// Base pattern: nook tile --pattern disk_009.json --size 4
// SPDX-License-Identifier: MIT
//
// Visibility, 1 where open, of the pixel of a depth buffer:
//   float nookVoArea(ivec2 pixel): volumetric obscurance by areas, 9 samples, others in each pixel of 4 x 4
// Passes, in order, each a function of the texel that is drawn, into a picture of its own:
//   nookMoments(texel): levels 0 to 5 of nook_levels, RGBA32F, of half the size of the texture of depths, rounded up so
//       that both sides are multiples of 32; nook_pass.x = level; level l > 0 reads level l - 1
//   nookVoAreaLinked(texel): visibility and what the filter needs, RGBA, 8 bits or better, the picture's size
//   nookBilateralX(texel): RGBA, 8 bits or better, as large; reads it as nook_packed
//   nookBilateralY(texel): visibility, R8 or better, as large; reads that as nook_packed
// Pixels count as texelFetch does. `nook emit -o FILE.h` writes the C++ that fills the block, `-o FILE.js` the JavaScript.
// Without #version, to be included after yours. All names begin with nook or NOOK.
//
// Any camera without a skew: positions from depth, and how large a length is in the picture.
//
// Depth buffers of any projection and format, and how far to look.
//
// Volumetric obscurance: the open share of the ball around a point, by lines along the view direction, by points, or by areas.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// Volumetric obscurance by areas: lines that see the depths of a whole piece of the picture, from moments filtered beforehand.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO 4.2).
//
// Noisy visibility → clean: filters that stay on the pixel's own surface, and half resolution back to full.
// The two one-dimensional passes are those of: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
#ifndef NOOK_VO_AREA_GLSL
#define NOOK_VO_AREA_GLSL
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

// Visibility as the pass before drew it, and what it wrote beside it.
uniform sampler2D nook_packed;
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

// x, y, log2 of the side of its area, weight of each sample, for a radius of 1: RGBA, 32-bit floats, 16 x 9 texels.
uniform sampler2D nook_vo_area_tile;
vec4 nookVoAreaSample(int row, int i)
{
	return texelFetch(nook_vo_area_tile, ivec2(row, i), 0);
}
int nookVoAreaVariant(ivec2 pixel)
{
	return (nookRow(pixel.y) % 4) * 4 + pixel.x % 4;
}

// A measure of depth that grows with it and is linear in the picture along any plane, so that the mean over a texel is that at its
// middle: -1 / depth in perspective, the depth itself in a parallel projection.
float nookEven(float depth)
{
	return (nook.w_start * depth - nook.w_slope) / (nook.w_slope * depth + nook.w_start);
}

// Two sets of depths in one: (mean, variance, pixels with a surface, pixels).
vec4 nookJoined(vec4 a, vec4 b)
{
	float count = a.z + b.z;
	if (count == 0.0f)
	{
		return vec4(0.0f, 0.0f, 0.0f, a.w + b.w);
	}
	float share = b.z / count;
	float apart = b.x - a.x;
	return vec4(a.x + share * apart, a.y + share * (b.y - a.y) + share * (1.0f - share) * apart * apart, count, a.w + b.w);
}

// One pixel, or one texel of the level before nook_pass.x.
vec4 nookMomentsOf(ivec2 at)
{
	if (nook_pass.x > 0)
	{
		return nookLevel(at, nook_pass.x - 1);
	}
	if (at.x < nook.first.x || at.y < nook.first.y || at.x > nook.last.x || at.y > nook.last.y)
	{
		return vec4(0.0f, 0.0f, 0.0f, 0.0f);
	}
	float depth = nookDepth(at);
	if (depth >= NOOK_SKY)
	{
		return vec4(0.0f, 0.0f, 0.0f, 1.0f);
	}
	return vec4(nookEven(depth), 0.0f, 1.0f, 1.0f);
}

// A texel of level nook_pass.x.
vec4 nookMoments(ivec2 texel)
{
	ivec2 at = texel * 2;
	vec4 upper = nookJoined(nookMomentsOf(at), nookMomentsOf(ivec2(at.x + 1, at.y)));
	vec4 lower = nookJoined(nookMomentsOf(ivec2(at.x, at.y + 1)), nookMomentsOf(ivec2(at.x + 1, at.y + 1)));
	return nookJoined(upper, lower);
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
	return 9;
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

// Back to depth; NOOK_SKY from infinity on.
float nookUneven(float even)
{
	float below = nook.w_start - even * nook.w_slope;
	if (below <= 0.0f)
	{
		return NOOK_SKY;
	}
	return (nook.w_slope + even * nook.w_start) / below;
}

// The open part of a line whose surfaces are spread evenly over even - spread to even + spread (VO 4.2's ramp): the mean of
// nookOpen's first part over them, by two points of Gauss. `back` is how far behind the surfaces it is asked for, in metres.
float nookOpenRamp(float reach, float end, float even, float spread, float depth, float radius, float back)
{
	float first = clamp((nookUneven(even - spread) + back - depth) / radius, -reach, end);
	float last = clamp((nookUneven(even + spread) + back - depth) / radius, -reach, end);
	float middle = 0.5f * (first + last);
	float offset = 0.28867513f * (last - first);
	float low = clamp(0.5f + 0.5f * (even - nookEven(depth + radius * (middle - offset) - back)) / spread, 0.0f, 1.0f);
	float high = clamp(0.5f + 0.5f * (even - nookEven(depth + radius * (middle + offset) - back)) / spread, 0.0f, 1.0f);
	return nookAlong(reach, first) + 0.5f * (low + high) * (last - first);
}

// The level that a sample reads, from 1; 0: the picture itself. Texels have 0.3 to 0.6 of the area's side: larger ones lie too far
// from where the sample is (builtin:courtyard and suburb). `lod`: log2 of the radius in pixels.
int nookAreaLevel(float lod, vec4 area)
{
	return clamp(int(floor(lod + area.z - 0.75f)), 0, 6);
}

// A sample: (x, y, log2 of its area's side in radii, weight) -> as nookVoLineAt.
vec3 nookVoAreaAt(ivec2 pixel, vec4 area, vec2 scale, vec3 n, float depth, float radius, float thick, float lod)
{
	float reach = sqrt(max(0.0f, 1.0f - area.x * area.x - area.y * area.y));
	ivec2 there = nookNeighbour(pixel, vec2(area.x, area.y), scale * radius);
	int level = nookAreaLevel(lod, area) - 1;
	if (level < 0)
	{
		return nookVoLineAt(pixel, vec4(area.x, area.y, reach, area.w), scale, n, depth, radius, thick);
	}
	int side = 2 << level;
	ivec2 texel = ivec2(there.x / side, there.y / side);
	vec4 moments = nookLevel(texel, level);
	float even = moments.x;
	float variance = moments.y;
	float end = reach;
	// The middle of the texel's pixels with depth, from the middle of the pixel.
	int x_ends = max(texel.x * side, nook.first.x) + min((texel.x + 1) * side, nook.last.x + 1);
	int y_ends = max(texel.y * side, nook.first.y) + min((texel.y + 1) * side, nook.last.y + 1);
	float x = 0.5f * float(x_ends) - 0.5f - float(pixel.x);
	float y = 0.5f * float(y_ends) - 0.5f - float(pixel.y);
	float rise = nookPlaneRiseAt(pixel, vec2(x, y), n, depth, 0.0f);
	end = clamp(rise / radius, -reach, reach);
	// What a surface along the tangent plane varies by within the texel says nothing of what is in front of it.
	float plane = nookEven(depth + rise);
	float across = nookEven(depth + nookPlaneRiseAt(pixel, vec2(x + 1.0f, y), n, depth, 0.0f)) - plane;
	float down = nookEven(depth + nookPlaneRiseAt(pixel, vec2(x, y + 1.0f), n, depth, 0.0f)) - plane;
	variance = max(0.0f, variance - (across * across + down * down) * float(side * side - 1) / 12.0f);
	// An even spread with the texel's variance. The paper's, of one standard deviation to each side, has a third of it, and 2 to 10 %
	// more error.
	float spread = max(sqrt(3.0f * variance), max(1e-6f * abs(even), 1e-30f)); // the last: of sky alone
	float whole = nookAlong(reach, end);
	float open = nookOpenRamp(reach, end, even, spread, depth, radius, 0.0f);
	open = whole + (open - whole) * moments.z / max(moments.w, 1.0f); // sky is open
	float share = area.w / max(nookAlong(reach, reach), 1e-20f);
	float missing = clamp(-1.0f - (nookUneven(even + spread) - depth) / radius, 0.0f, 1.0f);
	return vec3(share * open, share * whole, missing);
}

// As nookVoLineIn.
float nookVoAreaIn(ivec2 pixel, vec3 n, float depth, float radius, float thick)
{
	vec2 scale = nookScale(depth);
	float pixels = sqrt(abs(scale.x * scale.y)) * radius;
	if (pixels < 0.5f)
	{
		return 1.0f;
	}
	float lod = log2(pixels);
	int count = nookCount(pixels);
	int row = nookVoAreaVariant(pixel);
	float open = 0.0f;
	float whole = 0.0f;
	vec3 before = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < count; ++i)
	{
		vec3 own = nookVoAreaAt(pixel, nookVoAreaSample(row, i), scale, n, depth, radius, thick, lod);
		open += own.x;
		whole += own.y;
	}
	if (whole > 0.0f)
	{
		return clamp(open / whole, 0.0f, 1.0f);
	}
	return 1.0f;
}

float nookVoArea(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookVoNormal(pixel);
	float open = nookVoAreaIn(pixel, n, depth, nookRadius(nook.radius, depth), nook.thickness);
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

vec4 nookVoAreaLinked(ivec2 cell)
{
	return nookLinked(cell, nookVoArea(nookPixel(cell)));
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

float nookBilateralY(ivec2 cell)
{
	float open = nookMeanAlong(cell, ivec2(0, 1));
	return open;
}

#endif // NOOK_VO_AREA_GLSL
