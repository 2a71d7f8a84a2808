// Made by: nook emit --methods slices --filter bilateral --glsl vulkan
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Visibility, 1 where open, of the pixel of a depth buffer:
//   float nookSlices(ivec2 pixel): slices with bit masks
//       fitted to rays that reach so far: radius 1.1, --power 1.55 --slice-thickness 0.769 --strength 0.8
// Passes, in order, each a function of the texel that is drawn, into a picture of its own:
//   nookSlicesLinked(texel): visibility and what the filter needs, RGBA, 8 bits or better, the picture's size
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
// Visibility on slices: planes that hold the view ray, each with a mask of bits for the directions of it that are covered.
// This work is based on: O. Therrien, Y. Levesque, G. Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", The Visual
// Computer 39 (2023), for the masks and the thickness; J. Jimenez, X. Wu, A. Pesce, A. Jarabo, "Practical Real-Time Strategies for
// Accurate Indirect Occlusion", SIGGRAPH 2016 courses, for the slices; bits worth the same, falloff and slices even around the view
// ray are our own.
//
// Noisy visibility → clean: filters that stay on the pixel's own surface, and half resolution back to full.
// The two one-dimensional passes are those of: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
#ifndef NOOK_SLICES_GLSL
#define NOOK_SLICES_GLSL
#if !defined(VULKAN) || __VERSION__ < 450
#error nook: this module needs #version 450 or later, and Vulkan
#endif
#ifndef NOOK_SET
#define NOOK_SET 0 // descriptor set of all that the module binds
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// Lengths are in metres, or whatever unit your depths have.
#ifndef NOOK_BLOCK_BINDING
#define NOOK_BLOCK_BINDING 0
#endif
layout(set = NOOK_SET, std140, binding = NOOK_BLOCK_BINDING) uniform nook_block
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
layout(set = NOOK_SET, binding = NOOK_DEPTHS_BINDING) uniform sampler2D nook_depths;
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
layout(set = NOOK_SET, binding = NOOK_NORMALS_BINDING) uniform sampler2D nook_normals;
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
layout(set = NOOK_SET, binding = NOOK_PACKED_BINDING) uniform sampler2D nook_packed;
vec4 nookPacked(ivec2 cell)
{
	return texelFetch(nook_packed, cell, 0);
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

// Row of a pixel as it counts from the top of what the camera sees, whichever row is first: so tiles and windows lie on a picture the
// same way for both orders of rows.
int nookRow(int y)
{
	return nook.across_y.x < 0.0f ? int(2.0f * nook.origin.y + nook.size.y) - 1 - y : y;
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

// A radius as it is used at a depth: in the picture at most nook.most_px pixels, and at least nook.least_px.
float nookRadius(float radius, float depth)
{
	vec2 scale = nookScale(depth);
	float pixels = max(abs(scale.x), abs(scale.y));
	return max(min(radius, nook.most_px / pixels), nook.least_px / pixels);
}

// Without a tile: which of the sixteen variants of a window of 4 x 4 cells a pixel has. The place of its cell in a Bayer matrix, so
// that neighbours differ most.
int nookSliceVariant(ivec2 pixel)
{
	ivec2 cell = ivec2(pixel.x / 1, nookRow(pixel.y) / 1);
	int own = ((cell.y % 4) * 4 + cell.x % 4 + 0) % 16;
	int x = own % 4;
	int y = own / 4;
	return 4 * (2 * ((x + y) % 2) + y % 2) + 2 * ((x / 2 + y / 2) % 2) + y / 2;
}

// The same number with its four bits in reverse: the two together are even in both (Hammersley).
int nookSliceReverse(int variant)
{
	return 8 * (variant % 2) + 4 * ((variant / 2) % 2) + 2 * ((variant / 4) % 2) + variant / 8;
}

// Angle from the axis of y towards x, -pi to pi; at most 1e-5 off, the same on every renderer.
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

// The measure of a direction of a slice at the angle t from the eye is cos(t - angle) |sin t|, with (sine, cosine and angle of the
// normal within the slice) as turn; this is its integral from the eye to the direction (x, y), negative where x is: sign(t) / 4
// (cos(angle) - cos(2 t - angle)) + |t| / 2 sin(angle). y points to the eye.
float nookSliceMeasure(float x, float y, vec3 turn)
{
	float square = x * x + y * y;
	float sign = x < 0.0f ? -1.0f : 1.0f;
	float doubled = ((y * y - x * x) * turn.y + 2.0f * x * y * turn.x) / square;
	return 0.25f * sign * (turn.y - doubled) + 0.5f * abs(nookSliceAngle(x, y)) * turn.x;
}

// Which share of a slice's open directions, by their cosine to the normal, lies before the direction (x, y).
// side: 1 for what lies that way along the slice, -1 for the other.
float nookSliceShare(float x, float y, float side, vec3 turn)
{
	if (x * turn.x + y * turn.y <= 0.0f)
	{
		return side < 0.0f ? 0.0f : 1.0f; // under the tangent plane
	}
	float first = 0.5f * (turn.y - (1.57079633f - turn.z) * turn.x);
	return clamp((nookSliceMeasure(x, y, turn) + first) / (turn.y + turn.z * turn.x), 0.0f, 1.0f);
}

uint nookSliceBitsBelow(int end)
{
	if (end > 31)
	{
		return 4294967295u;
	}
	return (1u << uint(end)) - 1u;
}

int nookSliceBitCount(uint bits)
{
	uint pairs = bits - ((bits >> 1u) & 1431655765u);
	uint fours = (pairs & 858993459u) + ((pairs >> 2u) & 858993459u);
	uint eights = (fours + (fours >> 4u)) & 252645135u;
	return int((eights * 16843009u) >> 24u);
}

// Where a step reads depth, as a part of a slice's way in the picture, which is `pixels` long: `part` of what is left beyond 1.3
// pixels, within which half a pixel beside the slice tilts what is seen most (XeGTAO). part: [0, 1).
float nookSliceStep(float part, float pixels)
{
	float first = 1.3f / max(pixels, 1.3f);
	return first + (1.0f - first) * part;
}

// What one slice leaves open, and what it is worth, by the cosine: x the open part, y all; with bent normals, z and w the sum of the
// directions that are closed, along the slice and to the eye. o: the slice's direction across the view,
// a unit vector like v, which points to the eye. jitter: [0, 1).
// A surface at q covers what lies between the direction to it and the one to what is its thickness behind it on its line of sight:
// nook.slice_thickness at the reach, 1/32 of it close by, since what is near is mostly thin. Beyond the picture the border's pixel is
// read, and counts half of what it would in the picture. Steps lie at the cube of even shares, so that near ones are dense.
// These numbers were tried on the levels of docs/reference/recipes.md.
// What covers a bit first counts 1 - distance / radius, at a distance two thirds of the way back from what is seen there to where the
// step before would have seen it: the surface between the two steps is what covers it. Off the slice, by up to half a pixel or because the
// picture ends there, a surface keeps its height over the tangent plane, so that planes cover nothing.
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
		// Kept at its height, a depth half a pixel beside a grazing slice may come to lie on the other side: then it says nothing.
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

// Slices are even around v, which points to the eye: the first of two axes across it, the other is cross(v, this).
vec3 nookSliceAcross(vec3 v)
{
	return vec3(v.z, 0.0f, -v.x) / sqrt(v.x * v.x + v.z * v.z);
}

// The azimuth of a slice as x, in parts of a half turn of which there are 1, and the jitter of its steps as y.
vec2 nookSliceSample(ivec2 pixel, int i)
{
	int variant = nookSliceVariant(pixel);
	return vec2(float(i) + (float(variant) + 0.5f) / 16.0f, (float(nookSliceReverse(variant)) + 0.5f) / 16.0f);
}

// 1 slices, each with 4 depths on either side, near ones dense; slices are even around the view ray. w: what is
// open; with bent normals, xyz: the mean of the closed directions, by the cosine, each as long as it is closed.
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

vec4 nookSlicesLinked(ivec2 cell)
{
	return nookLinked(cell, nookSlices(nookPixel(cell)));
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

#endif // NOOK_SLICES_GLSL
