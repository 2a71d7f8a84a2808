// Made by: nook emit --methods vo-line --patterns disk_009_tile4.json --recipe paper --filter bilateral --resolution half --glsl 430
// Version: nook 0.1.0
// Base pattern: nook tile --pattern disk_009.json --size 4
// SPDX-License-Identifier: MIT
//
// Visibility of the surface that a pixel shows, 1 where open, from a depth buffer:
//   float nookVoLine(ivec2 pixel): volumetric obscurance by lines, 9 samples, other ones in each pixel of 4 x 4
//       depth reads per pixel: at most 10; with all passes below: at most 4.5
// Passes, in this order. Each calls a function for the texel that it draws, into a picture of its own:
//   nookVoLineLinked(texel): visibility and the links that the filter needs, RGBA8 or better, half the width and height of the picture, rounded up; at most 13 depth reads per texel
//   nookBilateralX(texel): RGBA8 or better, same size; reads the picture of the pass before as nook_packed
//   nookBilateralYOfSurface(texel): visibility and the surface that upsampling needs, RGBA32F, same size; reads the picture of nookBilateralX as nook_packed; at most 1 depth read per texel
//   nookVoLineFull(pixel): visibility, size of the picture; reads the picture of the pass before as nook_packed; at most 1 depth read per texel,
//       and those of the method where no cell shows the surface of the pixel. Or draw it as two passes:
//       nookUpsample(pixel), which is -1 there: discard, and write depth elsewhere;
//       then nookVoLineLeft(pixel) where nothing was drawn, by a depth test
// Pixels count as in texelFetch. `nook emit -o FILE.h` writes the C++ that fills the uniform block, `-o FILE.js` the JavaScript.
// This file has no #version: include it after yours. All its names begin with nook or NOOK.
//
// Positions from depth, and sizes in the picture, for any projection without a skew.
//
// Depth buffers of any projection and format, and the radius at a depth.
//
// Volumetric obscurance: the open share of the ball around a point, sampled by lines along the view direction, by points, or by
// areas.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// Volumetric obscurance by lines, by points and by areas: what the three share, from the sum over the samples to the visibility of
// a pixel.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// From noisy visibility to a clean picture: filters that stay on the surface of the pixel, and half resolution to full
// resolution.
// The two one-dimensional passes are after: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
#ifndef NOOK_VO_LINE_GLSL
#define NOOK_VO_LINE_GLSL
#if __VERSION__ < 430
#error nook: this module needs #version 430 or later
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// The uniform block that nook_fill fills. Lengths are in metres, or in the unit of your depths.
#ifndef NOOK_BLOCK_BINDING
#define NOOK_BLOCK_BINDING 0
#endif
layout(std140, binding = NOOK_BLOCK_BINDING) uniform nook_block
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
layout(binding = NOOK_DEPTHS_BINDING) uniform sampler2D nook_depths;
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
layout(binding = NOOK_NORMALS_BINDING) uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

// Picture of the pass before: visibility in the first channel, numbers for the filter or for upsampling in the others.
#ifndef NOOK_PACKED_BINDING
#define NOOK_PACKED_BINDING 11
#endif
layout(binding = NOOK_PACKED_BINDING) uniform sampler2D nook_packed;
vec4 nookPacked(ivec2 cell)
{
	return texelFetch(nook_packed, cell, 0);
}

// Row of a pixel, counted from the top of what the camera sees, whichever end of the picture row 0 is at. Tiles and windows so
// lie on a picture in the same way for both orders of rows.
int nookRow(int y)
{
	return nook.across_y.x < 0.0f ? int(2.0f * nook.origin.y + nook.size.y) - 1 - y : y;
}

// The samples: x,y,half_length,weight of each, for a radius of 1. A texture RGBA32F, 16 x 9, whose texels the header holds;
// a column is the variant of a pixel, a row is a sample.
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
	return (nookRow(pixel.y) / 2 % 4) * 4 + pixel.x / 2 % 4;
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

// Size in the picture of one metre across the view direction, at a depth: pixels along x (to the right) and y (downward).
vec2 nookScale(float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	return vec2(0.5f * nook.size.x / (w * nook.across_x.x), 0.5f * nook.size.y / (w * nook.across_y.x));
}

// The tangent plane of a pixel for nookPlaneRise, with the clip-space w of the pixel. x, y: how far the line of sight one pixel to
// the right, or downward, lies above the plane at that w; z: product of the normal with the line of sight, above 0 because a normal
// that is turned away counts as perpendicular to it; w: nook.w_slope / w.
vec4 nookPlane(ivec2 pixel, vec3 n, float w)
{
	vec2 texel = nookTexel();
	return vec4(n.x * texel.x * w, n.y * texel.y * w, max(dot(n, nookSight(pixel)), 1e-5f), nook.w_slope / w);
}

// Follows another line of sight to the point `height` metres above a tangent plane (nookPlane), and returns how much deeper that
// point is than the pixel; far away where the plane does not face the camera there. `across`: offset of the line from the centre of
// the pixel, in pixels (x to the right, y downward). The result comes from that offset, because a difference of two depths would
// lose its digits far away.
float nookPlaneRise(vec4 plane, vec2 across, float height)
{
	float beside = plane.x * across.x + plane.y * across.y;
	return (beside - height) / max(plane.z - plane.w * beside, 1e-6f);
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

// The radius that is used at a depth.
float nookRadius(float radius, float depth)
{
	vec2 metre = nookScale(depth);
	return nookRadiusOf(radius, 1.0f / max(abs(metre.x), abs(metre.y)));
}

// Weight of a line of the ball as far as a position, as a share of the whole. The falloff is constant, so that volume alone counts
// (VO 3), or 1 - d^2 at a distance of d radii from the point.
float nookAlong(float place)
{
	return place;
}

// Covered share of a line, whose part above the tangent plane ends at `end`, by a surface from `front` to `back` (VO 4.3).
float nookCoveredShare(float end, float front, float back)
{
	return clamp(nookAlong(min(back, end)) - nookAlong(max(front, 0.0f)), 0.0f, 1.0f);
}

// The normal, where the method uses it; without it, no texture of normals is read.
vec3 nookVoNormal(ivec2 pixel)
{
	return nookNormal(pixel);
}

// Evaluates one line of the ball, given as (x, y, half length, weight). Returns the weight of its covered part, the weight of the
// whole line above the tangent plane, and for paired samples how certain it is that the surface seen there has nothing to do with
// the ball: 0 where that surface is no more than one radius in front of the point, rising to 1 where it is two radii in front.
// slack: nookSlack.
vec3 nookVoLineAt(ivec2 pixel, vec4 line, vec2 scale, vec4 plane, vec4 around, float depth, float radius, float slack, float thick)
{
	vec2 near = nookNear(around, vec2(line.x, line.y), scale);
	vec2 across = nookAcross(near);
	float share = 0.5f / max(line.z * radius, 1e-20f); // a line on the rim of the ball has no length and no weight
	float end = 1.0f;
	float away = nookDepth(nookThere(pixel, near)) - depth;
	end = clamp(0.5f + share * nookPlaneRise(plane, across, 0.0f), 0.0f, 1.0f);
	away += slack;
	float front = 0.5f + share * away;
	float back = 1.0f;
	float missing = 0.0f;
	return vec3(line.w * nookCoveredShare(end, front, back), line.w * nookAlong(end), missing);
}

// Visibility for one radius (VO 4, 4.1, 4.2 and 4.4). With the normal, samples end at the tangent plane, and the open part is
// divided by the part above the plane. Without it, an open surface that faces the camera reads 1/2. Paired samples: 2i and 2i + 1
// lie on opposite sides.
float nookVoIn(ivec2 pixel, vec3 n, vec4 plane, vec4 around, int row, vec2 metre, float depth, float radius, float thick)
{
	vec2 scale = metre * radius;
	float pixels = max(abs(scale.x), abs(scale.y));
	float flat_variance = 0.0f;
	if (pixels < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
	int count = nookCount(pixels);
	float slack = nookSlack(depth, radius);
	float covered = 0.0f;
	float whole = 0.0f;
	vec3 own = vec3(0.0f, 0.0f, 0.0f);
	vec3 before = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < count; ++i)
	{
		own = nookVoLineAt(pixel, nookVoLineSample(row, i), scale, plane, around, depth, radius, slack, thick);
		covered += own.x;
		whole += own.y;
	}
	return clamp(1.0f - covered / max(whole, 1e-20f), 0.0f, 1.0f); // 1 where the falloff is 0 at all samples
}

// Visibility of a pixel.
float nookVo(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 n = nookVoNormal(pixel); // fetched together with the depth
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec4 plane = nookPlane(pixel, n, nook.w_slope * depth + nook.w_start);
	vec4 around = nookAround(pixel);
	int row = nookVoLineVariant(pixel);
	vec2 metre = nookScale(depth);
	float open = nookVoIn(pixel, n, plane, around, row, metre, depth, nookRadius(nook.radius, depth), nook.thickness);
	return open;
}

// Visibility of a pixel by lines.
float nookVoLine(ivec2 pixel)
{
	return nookVo(pixel);
}

// The pixel at which a cell of visibility was evaluated.
ivec2 nookPixel(ivec2 cell)
{
	return cell * 2;
}

// The cell that holds a pixel of the picture. Without signs the division is a shift.
ivec2 nookCellOf(ivec2 pixel)
{
	return ivec2(int(uint(pixel.x) / uint(2)), int(uint(pixel.y) / uint(2)));
}

// Last cell of the picture.
ivec2 nookLastCell()
{
	return nookCellOf(ivec2(int(nook.origin.x + nook.size.x) - 1, int(nook.origin.y + nook.size.y) - 1));
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

// Everything that the bilateral filter reads of a cell, in one texel: visibility, and whether the next cell along x and the
// next one along y show the same surface. 8 bits per channel are enough.
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
		vec3 sight = nookSight(pixel);
		ivec2 last = nookLastCell();
		ivec2 right = nookPixel(ivec2(min(cell.x + 1, last.x), cell.y));
		ivec2 lower = nookPixel(ivec2(cell.x, min(cell.y + 1, last.y)));
		along_x = nookAlike(sight, depth, n, right, vec2(float(2), 0.0f));
		along_y = nookAlike(sight, depth, n, lower, vec2(0.0f, float(2)));
		along_x = cell.x < last.x ? along_x : 0.0f;
		along_y = cell.y < last.y ? along_y : 0.0f;
	}
	return vec4(open, along_x, along_y, 1.0f);
}

vec4 nookVoLineLinked(ivec2 cell)
{
	return nookLinked(cell, nookVoLine(nookPixel(cell)));
}

// First cell of the picture; the guard band around it is not drawn.
ivec2 nookFirstCell()
{
	return nookCellOf(ivec2(int(nook.origin.x) + 2 - 1, int(nook.origin.y) + 2 - 1));
}

// The values of a cell that the filter takes the mean of: visibility, or a mean of open directions and visibility.
vec4 nookFiltered(ivec2 cell)
{
	return nookPacked(cell);
}

// A cell, moved along an axis (1, 0 or 0, 1) to another column or row.
ivec2 nookMovedTo(ivec2 cell, ivec2 axis, int place)
{
	return ivec2(axis.x > 0 ? place : cell.x, axis.y > 0 ? place : cell.y);
}

// Mean over 2 cells on either side of a cell, along x (axis 1, 0) or y (axis 0, 1). A cell has weight only as far as
// all cells between show the same surface. The outermost ones count half, so that on one surface all cells of a window of
// 2 2 have the same weight, and patterns that repeat with the window vanish.
vec4 nookMeanAlong(ivec2 cell, ivec2 axis)
{
	ivec2 first_cell = nookFirstCell();
	ivec2 last_cell = nookLastCell();
	int first = axis.x > 0 ? first_cell.x : first_cell.y;
	int last = axis.x > 0 ? last_cell.x : last_cell.y;
	int own = axis.x > 0 ? cell.x : cell.y;
	vec4 links = nookPacked(cell);
	vec4 sum = nookFiltered(cell);
	float weights = 1.0f;
	float before = 1.0f;
	float after = axis.x > 0 ? links.y : links.z;
	for (int i = 1; i <= 2; ++i)
	{
		float falls = i < 2 ? 1.0f : 0.5f;
		ivec2 one = nookMovedTo(cell, axis, max(own - i, first));
		ivec2 other = nookMovedTo(cell, axis, min(own + i, last));
		links = nookPacked(one);
		before *= own - i < first ? 0.0f : axis.x > 0 ? links.y : links.z;
		sum = sum + nookFiltered(one) * (falls * before) + nookFiltered(other) * (falls * after);
		weights += falls * before + falls * after;
		links = nookPacked(other);
		after *= axis.x > 0 ? links.y : links.z;
	}
	return sum / weights;
}

// First pass of the bilateral filter.
vec4 nookBilateralX(ivec2 cell)
{
	vec4 own = nookPacked(cell);
	return vec4(nookMeanAlong(cell, ivec2(1, 0)).x, own.y, own.z, 1.0f);
}

// Second pass of the bilateral filter.
float nookBilateralY(ivec2 cell)
{
	float open = nookMeanAlong(cell, ivec2(0, 1)).x;
	return open;
}

// A unit vector as two numbers: its stereographic projection from (0, 0, -1), the direction of surfaces that face away.
vec2 nookFlattened(vec3 n)
{
	return n.z < -0.9999f ? vec2(1e4f, 0.0f) : vec2(n.x / (1.0f + n.z), n.y / (1.0f + n.z));
}

// Everything that upsampling reads of a cell, in one texel of 32-bit floats: visibility, depth, and the normal as
// nookFlattened stores it.
vec4 nookOfSurface(ivec2 cell, float visibility)
{
	ivec2 pixel = nookPixel(cell);
	vec2 normal = nookFlattened(nookNormal(pixel));
	return vec4(visibility, nookDepth(pixel), normal.x, normal.y);
}

vec4 nookBilateralYOfSurface(ivec2 cell)
{
	return nookOfSurface(cell, nookBilateralY(cell));
}

// The unit vector that nookFlattened stored.
vec3 nookUnflattened(vec2 at)
{
	float size = 2.0f / (1.0f + dot(at, at));
	return vec3(at.x * size, at.y * size, size - 1.0f);
}

// Visibility of a pixel at full resolution, from cells of 2 x 2 pixels: the mean of the one, two or four cells around it that
// show its surface. Returns -1 where none does, for a pass that evaluates these pixels by themselves. They are thin objects and
// edges, about 4 % of a picture; taking the nearest cell there instead would nearly double the difference to full resolution.
float nookUpsample(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 sight = nookSight(pixel);
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	ivec2 cell = nookCellOf(pixel);
	float sum = 0.0f;
	float weights = 0.0f;
	int corners = 2 * 2;
	for (int i = 0; i < corners; ++i)
	{
		int x = i % 2;
		int y = i / 2;
		ivec2 there = ivec2(clamp(cell.x + x, first.x, last.x), clamp(cell.y + y, first.y, last.y));
		vec4 one = nookPacked(there);
		ivec2 at = nookPixel(there);
		vec2 across = vec2(float(at.x - pixel.x), float(at.y - pixel.y));
		float weight = nookAlikeThere(sight, depth, n, across, one.y, nookUnflattened(vec2(one.z, one.w)));
		weight = x <= pixel.x - 2 * cell.x && y <= pixel.y - 2 * cell.y ? weight : 0.0f;
		sum += weight * one.x;
		weights += weight;
	}
	if (weights < 0.5f)
	{
		return -1.0f;
	}
	float open = sum / weights;
	return open;
}

// Visibility of a pixel for which upsampling found no surface, evaluated for this pixel alone.
float nookVoLineLeft(ivec2 pixel)
{
	return nookVoLine(pixel);
}

// Visibility of a pixel at full resolution: upsampled, or evaluated for this pixel where none of the cells around it shows its
// surface.
float nookVoLineFull(ivec2 pixel)
{
	float visibility = nookUpsample(pixel);
	if (visibility < 0.0)
	{
		return nookVoLineLeft(pixel);
	}
	return visibility;
}

#endif // NOOK_VO_LINE_GLSL
