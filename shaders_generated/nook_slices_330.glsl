// Made by: nook emit --methods slices --filter bilateral --glsl 330
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Visibility of the surface that a pixel shows, 1 where open, from a depth buffer:
//   float nookSlices(ivec2 pixel): slices with bit masks, 1 slice of 8 samples
//       depth reads per pixel: at most 9; with all passes below: at most 12
//       preset for ray-traced occlusion with rays of the length reach: radius = 1.1 * reach, power = 1.55, slice_thickness = 0.769, strength = 0.8
// Passes, in this order. Each calls a function for the texel that it draws, into a picture of its own:
//   nookSlicesLinked(texel): visibility and the links that the filter needs, RGBA8 or better, size of the picture; at most 12 depth reads per texel
//   nookBilateralX(texel): RGBA8 or better, same size; reads the picture of the pass before as nook_packed
//   nookBilateralY(texel): visibility, R8 or better, same size; reads the picture of nookBilateralX as nook_packed
// Pixels count as in texelFetch. `nook emit -o FILE.h` writes the C++ that fills the uniform block, `-o FILE.js` the JavaScript.
// This file has no #version: include it after yours. All its names begin with nook or NOOK.
//
// Positions from depth, and sizes in the picture, for any projection without a skew.
//
// Depth buffers of any projection and format, and the radius at a depth.
//
// The final adjustment: strength of the obscurance, and an exponent of the visibility.
//
// Visibility by slices: planes that contain the view ray, each with a bit mask of the directions in it that are covered.
// This work is based on: O. Therrien, Y. Levesque, G. Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", The
// Visual Computer 39 (2023), for the masks and the thickness; J. Jimenez, X. Wu, A. Pesce, A. Jarabo, "Practical Real-Time
// Strategies for Accurate Indirect Occlusion", SIGGRAPH 2016 courses, for the slices. Additions of nook: bits of equal weight,
// the falloff, and slices spaced evenly around the view ray.
//
// From noisy visibility to a clean picture: filters that stay on the surface of the pixel, and half resolution to full
// resolution.
// The two one-dimensional passes are after: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
#ifndef NOOK_SLICES_GLSL
#define NOOK_SLICES_GLSL
#if __VERSION__ < 330
#error nook: this module needs #version 330 or later
#endif
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

// Picture of the pass before: visibility in the first channel, numbers for the filter or for upsampling in the others.
uniform sampler2D nook_packed;
vec4 nookPacked(ivec2 cell)
{
	return texelFetch(nook_packed, cell, 0);
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

// Row of a pixel, counted from the top of what the camera sees, whichever end of the picture row 0 is at. Tiles and windows so
// lie on a picture in the same way for both orders of rows.
int nookRow(int y)
{
	return nook.across_y.x < 0.0f ? int(2.0f * nook.origin.y + nook.size.y) - 1 - y : y;
}

// The nearest pixel that holds depth.
ivec2 nookInside(ivec2 pixel)
{
	return ivec2(clamp(pixel.x, nook.first.x, nook.last.x), clamp(pixel.y, nook.first.y, nook.last.y));
}

// The pixel at `offset` (x to the right, y up, in the unit of `scale`) from the centre of a pixel; it may lie outside the
// picture.
ivec2 nookBeside(ivec2 pixel, vec2 offset, vec2 scale)
{
	float x = float(pixel.x) + 0.5f + offset.x * scale.x;
	float y = float(pixel.y) + 0.5f - offset.y * scale.y;
	return ivec2(int(floor(x)), int(floor(y)));
}

// The radius that is used at a depth: limited to nook.most_px pixels in the picture, and at least nook.least_px.
float nookRadius(float radius, float depth)
{
	vec2 scale = nookScale(depth);
	float pixels = max(abs(scale.x), abs(scale.y));
	return max(min(radius, nook.most_px / pixels), nook.least_px / pixels);
}

// Without a tile: number of a pixel in its window of 4 x 4 cells, 0 to 15, which selects the azimuth of its slices. The numbers
// form a Bayer matrix, so that neighbours differ as much as possible.
int nookSliceVariant(ivec2 pixel)
{
	ivec2 cell = ivec2(pixel.x / 1, nookRow(pixel.y) / 1);
	int own = ((cell.y % 4) * 4 + cell.x % 4 + 0) % 16;
	int x = own % 4;
	int y = own / 4;
	return 4 * (2 * ((x + y) % 2) + y % 2) + 2 * ((x / 2 + y / 2) % 2) + y / 2;
}

// Reverses the four bits of that number. Both together are evenly distributed in two dimensions (Hammersley); the
// reversed one selects the jitter of the steps.
int nookSliceReverse(int variant)
{
	return 8 * (variant % 2) + 4 * ((variant / 2) % 2) + 2 * ((variant / 4) % 2) + variant / 8;
}

// Angle from the y axis toward the x axis, -pi to pi. It is off by at most 1e-5, and the same on every renderer, unlike atan.
float nookSliceAngle(float x, float y)
{
	float longer = max(abs(x), abs(y));
	float t = min(abs(x), abs(y)) / max(longer, 1e-30f);
	float s = t * t;
	float angle =
		t * (0.99997726f + s * (-0.33262347f + s * (0.19354346f + s * (-0.11643287f + s * (0.05265332f - s * 0.0117212f)))));
	if (abs(x) > abs(y))
	{
		angle = 1.57079633f - angle;
	}
	if (y < 0.0f)
	{
		angle = 3.14159265f - angle;
	}
	return x < 0.0f ? -angle : angle;
}

// Integral of the weight of the directions in a slice, from the direction to the eye as far as the direction (x, y); y points
// to the eye. It is negative where x is.
// The weight of a direction at angle t from the eye is cos(t - angle) |sin t|, where turn = (sine, cosine, value of `angle`)
// and `angle` is that of the normal within the slice. The integral is sign(t) / 4 (cos(angle) - cos(2 t - angle)) + |t| / 2
// sin(angle).
float nookSliceMeasure(float x, float y, vec3 turn)
{
	float square = x * x + y * y;
	float sign = x < 0.0f ? -1.0f : 1.0f;
	float doubled = ((y * y - x * x) * turn.y + 2.0f * x * y * turn.x) / square;
	return 0.25f * sign * (turn.y - doubled) + 0.5f * abs(nookSliceAngle(x, y)) * turn.x;
}

// Share of the open directions of a slice, weighted by their cosine to the normal, that come before the direction (x, y). side:
// 1 for a direction on the positive half of the slice, -1 for the other.
float nookSliceShare(float x, float y, float side, vec3 turn)
{
	if (x * turn.x + y * turn.y <= 0.0f)
	{
		return side < 0.0f ? 0.0f : 1.0f; // below the tangent plane
	}
	float first = 0.5f * (turn.y - (1.57079633f - turn.z) * turn.x);
	return clamp((nookSliceMeasure(x, y, turn) + first) / (turn.y + turn.z * turn.x), 0.0f, 1.0f);
}

// The lowest `end` bits, set.
uint nookSliceBitsBelow(int end)
{
	if (end > 31)
	{
		return 4294967295u;
	}
	return (1u << uint(end)) - 1u;
}

// Number of bits that are set.
int nookSliceBitCount(uint bits)
{
	uint pairs = bits - ((bits >> 1u) & 1431655765u);
	uint fours = (pairs & 858993459u) + ((pairs >> 2u) & 858993459u);
	uint eights = (fours + (fours >> 4u)) & 252645135u;
	return int((eights * 16843009u) >> 24u);
}

// Where a step reads depth, as a share of the length of a slice in the picture, `pixels`. `part`, in [0, 1), is a share of the
// way that remains after the first 1.3 pixels: closer than that, the half pixel by which a sample may miss the slice would tilt
// what it sees too much (a remedy of XeGTAO).
float nookSliceStep(float part, float pixels)
{
	float first = 1.3f / max(pixels, 1.3f);
	return first + (1.0f - first) * part;
}

// Evaluates one slice. Returns x: the weight of its open directions, y: the weight of all its directions; for bent normals also
// z and w: the sum of the covered directions, along the slice and to the eye. o: direction of the slice across the view ray, a
// unit vector; v: unit vector to the eye; jitter: in [0, 1).
// A surface at q covers the directions between q and the point behind it, on its line of sight, at the distance of its
// thickness. The thickness is nook.slice_thickness at one radius and 1/32 of that close by, since near surfaces mostly are
// thin. Outside the picture the nearest pixel is read, and has half the weight. Steps are placed at the cubes of evenly spaced
// numbers, so that they are dense near the pixel.
// A surface that covers a bit first has the weight 1 - distance / radius. The part of it that covers the bit lies between this
// step and the previous one, so the distance is 1/3 of that at this step plus 2/3 of that at the previous step. Where a sample
// lies beside the slice, by up to half a pixel or because the picture ends there, it keeps its height above the tangent plane,
// so that planes cover nothing.
vec4 nookSlice(ivec2 pixel, vec3 n, vec3 centre, float radius, vec2 scale, vec3 sight, vec3 v, vec3 o, float jitter)
{
	vec3 beside = cross(o, v);
	vec2 within = vec2(dot(n, o), dot(n, v));
	float square = max(dot(within, within), 1e-4f);
	float aside = dot(n, beside) / square;
	float facing = max(within.y, 0.0f);
	float size = max(sqrt(within.x * within.x + facing * facing), 1e-6f);
	vec3 turn = vec3(within.x / size, facing / size, nookSliceAngle(within.x, facing));
	vec2 way = vec2(o.x - o.z * sight.x, o.y - o.z * sight.y) * radius;
	vec2 across = way * scale;
	float pixels = sqrt(dot(across, across));
	uint covered = 0u;
	float closed = 0.0f;
	vec2 lost = vec2(0.0f, 0.0f);
	for (int k = 0; k < 2 * 4; ++k)
	{
		float side = k % 2 == 0 ? 1.0f : -1.0f;
		float moved = jitter + 0.5f * float(k % 2);
		float share = (float(k / 2) + moved - floor(moved)) / float(4);
		float place = nookSliceStep(share * share * share, pixels);
		ivec2 wanted = nookBeside(pixel, way * (side * place), scale);
		ivec2 there = nookInside(wanted);
		float surface = nookDepth(there);
		vec3 d = (nookPosition(there, surface) - centre) / radius;
		float apart = dot(d, d);
		float slide = dot(d, beside) * aside;
		float x = dot(d, o) + slide * within.x;
		float y = dot(d, v) + slide * within.y;
		// Moved into the slice at its height, a sample beside a grazing slice may end up on the other side: then it is ignored.
		if (surface < NOOK_SKY && apart < 1.0f && x * side > 0.0f)
		{
			vec3 away = nookPosition(there, 1.0f) - nookPosition(there, 0.0f);
			float thick = nook.slice_thickness * (0.03125f + 0.96875f * sqrt(apart)) / sqrt(dot(away, away));
			float front = nookSliceShare(x, y, side, turn);
			float back = nookSliceShare(x + thick * dot(away, o), y + thick * dot(away, v), side, turn);
			int first = int(floor(32.0f * min(front, back) + 0.5f));
			int end = int(floor(32.0f * max(front, back) + 0.5f));
			uint fresh = nookSliceBitsBelow(end) & ~nookSliceBitsBelow(first) & ~covered;
			covered = covered | fresh;
			float last = max(share - 1.0f / float(4), 0.0f);
			float before = nookSliceStep(last * last * last, pixels) / place;
			float known = there == wanted ? 1.0f : 0.5f;
			float counts = known * (1.0f - (1.0f + 2.0f * before) / 3.0f * sqrt(apart));
			closed += float(nookSliceBitCount(fresh)) * counts;
		}
	}
	float whole = sqrt(square) * (turn.y + turn.z * turn.x);
	return vec4(whole * (1.0f - closed / 32.0f), whole, lost.x * sqrt(square), lost.y * sqrt(square));
}

// First of two axes across v, the direction to the eye, around which slices are evenly spaced; the other one is cross(v, this).
vec3 nookSliceAcross(vec3 v)
{
	return vec3(v.z, 0.0f, -v.x) / sqrt(v.x * v.x + v.z * v.z);
}

// Azimuth of a slice as x, in units of half a turn divided by the number of slices, 1; jitter of its steps as y.
vec2 nookSliceSample(ivec2 pixel, int i)
{
	int variant = nookSliceVariant(pixel);
	return vec2(float(i) + (float(variant) + 0.5f) / 16.0f, (float(nookSliceReverse(variant)) + 0.5f) / 16.0f);
}

// Mean over the slices of a pixel, 1 slices with 4 depths on either side. w: visibility; for bent normals
// xyz: the mean of the covered directions, weighted by their cosine.
vec4 nookSliceMean(ivec2 pixel, float depth)
{
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth);
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec3 sight = nookPosition(pixel, 0.0f) - nookPosition(pixel, 1.0f);
	vec3 v = sight / sqrt(dot(sight, sight));
	vec3 across = nookSliceAcross(v);
	vec3 up = cross(v, across);
	vec2 sum = vec2(0.0f, 0.0f);
	vec3 lost = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < 1; ++i)
	{
		vec2 own = nookSliceSample(pixel, i);
		float angle = own.x * 3.14159265f / float(1);
		vec3 o = across * cos(angle) + up * sin(angle);
		vec4 slice = nookSlice(pixel, n, centre, radius, scale, sight, v, o, own.y);
		sum = sum + vec2(slice.x, slice.y);
		lost = lost + o * slice.z + v * slice.w;
	}
	float open = sum.y > 0.0f ? sum.x / sum.y : 1.0f;
	lost = lost / max(sum.y, 1e-12f);
	return vec4(lost.x, lost.y, lost.z, open);
}

// Visibility of a pixel by slices.
float nookSlices(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float open = nookSliceMean(pixel, depth).w;
	return open;
}

// The pixel at which a cell of visibility was evaluated.
ivec2 nookPixel(ivec2 cell)
{
	return cell * 1;
}

// Last cell of the picture.
ivec2 nookLastCell()
{
	return ivec2((int(nook.origin.x + nook.size.x) - 1) / 1, (int(nook.origin.y + nook.size.y) - 1) / 1);
}

// Distance of two positions from a common tangent plane, as a share of the radius. The plane lies midway between the two
// normals, so it contains both ends of any circular arc and columns count as smooth as walls. Unlike a difference of depths,
// the distance is 0 along a plane at any slope. Visibility cannot change by much more than it.
float nookApartFrom(vec3 centre, vec3 n, vec3 there, vec3 n_there)
{
	return abs(dot(n + n_there, there - centre)) / (2.0f * nook.radius);
}

// nookApartFrom for the surface of another pixel; NOOK_SKY where that is sky.
float nookApart(vec3 centre, vec3 n, ivec2 there, vec3 n_there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return nookApartFrom(centre, n, nookPosition(there, depth), n_there);
}

// Do two pixels show the same surface: 1 yes, 0 no, with a ramp between. The ramp is flat at both ends, so that all pixels of a
// smooth surface have the same weight and the mean over a window of variants is exact. The thresholds were chosen by eye.
float nookAlikeOf(float apart, vec3 n, vec3 n_there)
{
	float beside = clamp(2.0f - apart * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, n_there) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

// nookAlikeOf for another pixel.
float nookAlike(vec3 centre, vec3 n, ivec2 there)
{
	vec3 n_there = nookNormal(there);
	return nookAlikeOf(nookApart(centre, n, there, n_there), n, n_there);
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

vec4 nookSlicesLinked(ivec2 cell)
{
	return nookLinked(cell, nookSlices(nookPixel(cell)));
}

// First cell of the picture; the guard band around it is not drawn.
ivec2 nookFirstCell()
{
	return ivec2((int(nook.origin.x) + 1 - 1) / 1, (int(nook.origin.y) + 1 - 1) / 1);
}

// The values of a cell that the filter takes the mean of: visibility, or a mean of open directions and visibility.
vec4 nookFiltered(ivec2 cell)
{
	return nookPacked(cell);
}

// Mean over 2 cells on either side of a cell, along x (axis 1, 0) or y (axis 0, 1). A cell has weight only as far as
// all cells between show the same surface.
vec4 nookMeanAlong(ivec2 cell, ivec2 axis)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	vec4 own = nookPacked(cell);
	float width = 0.5f * float(2 + 1);
	float link_x = float(axis.x);
	float link_y = float(axis.y);
	vec4 sum = nookFiltered(cell);
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
		ivec2 one = ivec2(max(there.x, first.x), max(there.y, first.y));
		vec4 links = nookPacked(one);
		before *= link_x * links.y + link_y * links.z;
		ivec2 other = ivec2(min(cell.x + i * axis.x, last.x), min(cell.y + i * axis.y, last.y));
		sum = sum + (nookFiltered(one) * before + nookFiltered(other) * after) * falls;
		weights += falls * (before + after);
		links = nookPacked(other);
		after *= link_x * links.y + link_y * links.z;
	}
	return sum / weights;
}

// First pass of the bilateral filter.
vec4 nookBilateralX(ivec2 cell)
{
	vec4 own = nookPacked(cell);
	return vec4(nookMeanAlong(cell, ivec2(1, 0)).x, own.y, own.z, 1.0f);
}

// Applies nook.strength to the obscurance, which is 1 - open, then nook.power to the visibility. Fully open surfaces stay at 1.
float nookShaped(float open)
{
	return pow(max(0.0f, 1.0f - nook.strength * (1.0f - open)), nook.power);
}

// Second pass of the bilateral filter.
float nookBilateralY(ivec2 cell)
{
	float open = nookMeanAlong(cell, ivec2(0, 1)).x;
	open = nookShaped(open);
	return open;
}

#endif // NOOK_SLICES_GLSL
