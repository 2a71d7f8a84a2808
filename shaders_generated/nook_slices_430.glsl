// Made by: nook emit --methods slices --filter bilateral --glsl 430
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

// Row of a pixel, counted from the top of what the camera sees, whichever end of the picture row 0 is at. Tiles and windows so
// lie on a picture in the same way for both orders of rows.
int nookRow(int y)
{
	return nook.across_y.x < 0.0f ? int(2.0f * nook.origin.y + nook.size.y) - 1 - y : y;
}

// First and last pixel that hold depth, near a pixel.
vec4 nookAround(ivec2 pixel)
{
	return vec4(uintBitsToFloat(uint(nook.first.x + 0x4b400000 - pixel.x)), uintBitsToFloat(uint(nook.first.y + 0x4b400000 - pixel.y)),
				uintBitsToFloat(uint(nook.last.x + 0x4b400000 - pixel.x)), uintBitsToFloat(uint(nook.last.y + 0x4b400000 - pixel.y)));
}

// A pixel near another one, as in texelFetch.
ivec2 nookThere(ivec2 pixel, vec2 near)
{
	return ivec2(pixel.x - 0x4b400000 + int(floatBitsToUint(near.x)), pixel.y - 0x4b400000 + int(floatBitsToUint(near.y)));
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

// Without a tile: number of a pixel in its window of 4 x 4 cells, 0 to 15, which selects the azimuth of its slices. The numbers
// form a Bayer matrix, so that neighbours differ as much as possible.
int nookSliceVariant(ivec2 pixel)
{
	ivec2 cell = ivec2(pixel.x / 1, nookRow(pixel.y) / 1);
	int own = ((cell.y & 3) * 4 + (cell.x & 3) + 0) & 15;
	int y = own >> 2;
	int either = own ^ y;
	return (either & 1) * 8 + (y & 1) * 4 + (either & 2) + (y >> 1);
}

// Reverses the four bits of that number. Both together are evenly distributed in two dimensions (Hammersley); the
// reversed one selects the jitter of the steps.
int nookSliceReverse(int variant)
{
	return (variant & 1) * 8 + (variant & 2) * 2 + ((variant >> 1) & 2) + (variant >> 3);
}

// Coefficients of t - sin(t) cos(t), the area that a chord cuts off the unit circle, divided by (1 - cos(t))^1.5, as a quadratic in
// 1 - cos(t). A minimax fit: the area is off by at most 0.012.
vec3 nookSliceSegment()
{
	return vec3(1.7659278f, -0.0540733f, -0.1357357f);
}

// Constants of a slice for nookSliceSector, from the sine and cosine of the angle of the normal from the eye. x: sectors per unit
// of the integral of the weight; y: 1/2 plus the number of sectors on the lower side of the direction to the eye; z: weight of all
// directions.
// The weight of a direction at the angle t from the eye is cos(t - angle) |sin t|. Its integral from the eye to t is
// sign(t) / 2 sin(t)^2 cos(angle) + (|t| - sin |t| cos t) / 2 sin(angle).
vec3 nookSliceSectors(float sine, float cosine)
{
	vec3 fit = nookSliceSegment();
	float below = 1.0f - sine;
	float above = 1.0f + sine;
	float plane = 0.5f * cosine * cosine * cosine;
	float lower = plane - 0.5f * sine * below * sqrt(below) * (fit.x + below * (fit.y + below * fit.z));
	float upper = plane + 0.5f * sine * above * sqrt(above) * (fit.x + above * (fit.y + above * fit.z));
	float whole = max(lower + upper, 1e-6f);
	float each = 31.0f / whole;
	return vec3(each, 0.5f + each * lower, whole);
}

// Numbers of the sectors of a slice, 31 of equal weight, that come before four directions, rounded: x and z on the positive side, y
// and w on the negative one. cosine: of their angles t to the eye; edge: 1 - cos(t) of the tangent plane; tilt: sectors.x times half
// the cosine of the normal's angle, negative on the negative side; fit: nookSliceSegment times sectors.x times half the sine;
// start: sectors.y.
ivec4 nookSliceSector(vec4 cosine, vec4 edge, vec4 tilt, vec3 fit, float start)
{
	vec4 less = min(1.0f - cosine, edge);
	vec4 curve = sqrt(abs(less)) * (fit.x + less * (fit.y + less * fit.z));
	return ivec4(start + less * (2.0f * tilt - tilt * less + curve));
}

// Number of bits that are set.
int nookSliceBitCount(uint bits)
{
	return bitCount(bits);
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
// z and w: the sum of the covered directions, along the slice and to the eye. across, up, v: a frame, with v the unit vector to
// the eye; facing: the normal in that frame; azimuth: cosine and sine of the angle of the slice from `across`; sight: what a
// point on the line of sight moves by per metre toward the eye; jitter: in [0, 1).
// A surface covers the directions between it and a point behind it. The thickness is nook.slice_thickness at one radius and 1/32
// of that close by, since near surfaces mostly are thin. Outside the picture the nearest pixel is read, and has half the weight.
// Steps are placed at the cubes of evenly spaced numbers, so that they are dense near the pixel.
// A surface that covers a sector first has the weight 1 - distance / radius. The part of it that covers the sector lies between
// this step and the previous one, so the distance is 1/3 of that at this step plus 2/3 of that at the previous step. Where a
// sample lies beside the slice, by up to half a pixel or because the picture ends there, it keeps its height above the tangent
// plane, so that planes cover nothing. Moved into the slice at that height, a sample beside a grazing slice may end up on the
// other side: then it is ignored.
// Both sides are computed together, as x and y of vectors, and do not wait for each other.
vec4 nookSlice(ivec2 pixel, float depth, float radius, vec2 scale, vec3 sight, vec3 across, vec3 up, vec3 v, vec3 facing,
			   vec2 azimuth, float jitter)
{
	vec3 o = across * azimuth.x + up * azimuth.y;
	vec3 beside = across * azimuth.y - up * azimuth.x;
	vec2 within = vec2(facing.x * azimuth.x + facing.y * azimuth.y, facing.z);
	float square = max(dot(within, within), 1e-4f);
	float aside = (facing.x * azimuth.y - facing.y * azimuth.x) / square;
	float front = max(within.y, 0.0f);
	float size = max(sqrt(within.x * within.x + front * front), 1e-6f);
	float sine = within.x / size;
	float cosine = front / size;
	vec3 sectors = nookSliceSectors(sine, cosine);
	vec3 fit = nookSliceSegment() * (0.5f * sine * sectors.x);
	float tilted = 0.5f * cosine * sectors.x;
	vec3 bent = vec3(sine, cosine, 0.0f);
	// A depth z seen (i, j) pixels away lies at -sight (z - depth) + radius w (texel.x i, texel.y j, 0) from the surface, with the
	// clip-space w at z. Its parts along the slice and to the eye, in radii, are linear in (i, j).
	vec2 texel = nookTexel() / radius;
	vec3 along = o + beside * (aside * within.x);
	vec3 toward = v + beside * (aside * within.y);
	vec2 x_of = vec2(along.x * texel.x, along.y * texel.y);
	vec2 y_of = vec2(toward.x * texel.x, toward.y * texel.y);
	vec4 around = nookAround(pixel);
	float deeper = sqrt(dot(sight, sight)) / radius;
	float level = deeper * depth;
	float deepest = min(depth + 8.0f * radius, NOOK_SKY);
	vec2 way = vec2((o.x - o.z * sight.x) * radius * scale.x, (o.z * sight.y - o.y) * radius * scale.y);
	float pixels = sqrt(dot(way, way));
	float behind = 0.03125f * nook.slice_thickness;
	float thicker = 0.96875f * nook.slice_thickness;
	vec2 start = vec2(jitter / float(4), (jitter + (jitter < 0.5f ? 0.5f : -0.5f)) / float(4));
	vec2 side = vec2(1.0f, -1.0f);
	vec4 edge = vec4(1.0f + sine, 1.0f - sine, 1.0f + sine, 1.0f - sine);
	vec4 tilt = vec4(tilted, -tilted, tilted, -tilted);
	// The surfaces of a step lie evenly between the previous step and itself. With up to four steps, which are far apart, rays agree
	// better where more of them lie at the previous one.
	float nearer = 4 > 4 ? 0.5f : 2.0f / 3.0f;
	float farther = 4 > 4 ? 0.5f : 1.0f / 3.0f;
	uint open = 2147483647u;
	float closed = 0.0f;
	float nearest = nookSliceStep(0.0f, pixels);
	vec2 before = vec2(nearest, nearest); // places of the previous steps
	vec2 lost = vec2(0.0f, 0.0f);
	for (int k = 0; k < 4; ++k)
	{
		vec2 share = start + float(k) / float(4);
		vec2 place = nearest + (1.0f - nearest) * (share * share * share); // nookSliceStep
		vec2 wanted_x = 12582912.0f + way.x * (side * place); // as in nookNear
		vec2 wanted_y = 12582912.0f + way.y * (side * place);
		vec2 near_x = clamp(wanted_x, vec2(around.x, around.x), vec2(around.z, around.z));
		vec2 near_y = clamp(wanted_y, vec2(around.y, around.y), vec2(around.w, around.w));
		vec2 i = near_x - 12582912.0f;
		vec2 j = near_y - 12582912.0f;
		float positive = nookDepth(nookThere(pixel, vec2(near_x.x, near_y.x)));
		float negative = nookDepth(nookThere(pixel, vec2(near_x.y, near_y.y)));
		vec2 z = vec2(min(positive, deepest), min(negative, deepest));
		vec2 at = nook.w_slope * z + nook.w_start;
		vec2 x = at * (x_of.x * i + x_of.y * j); // exactly 0 for the pixel itself
		vec2 y = at * (y_of.x * i + y_of.y * j) + (level - deeper * z);
		vec2 squared = x * x + 1e-12f;
		vec2 apart = y * y + squared;
		vec2 inverse = 1.0f / sqrt(apart);
		vec2 distance = apart * inverse;
		vec2 back = y - (behind + thicker * distance);
		vec2 near = y * inverse;
		vec2 far = back / sqrt(back * back + squared);
		ivec4 sector = nookSliceSector(vec4(near.x, near.y, far.x, far.y), edge, tilt, fit, sectors.y);
		ivec2 first = ivec2(sector.x, min(sector.y, sector.w));
		ivec2 end = ivec2(max(sector.x, sector.z), sector.y);
		uint ahead = ((1u << uint(end.x)) - (1u << uint(first.x))) & open;
		ahead = z.x < deepest && apart.x < 1.0f && x.x > 0.0f ? ahead : 0u;
		open = open - ahead;
		uint opposite = ((1u << uint(end.y)) - (1u << uint(first.y))) & open;
		opposite = z.y < deepest && apart.y < 1.0f && x.y < 0.0f ? opposite : 0u;
		open = open - opposite;
		vec2 known = vec2(near_x.x == wanted_x.x && near_y.x == wanted_y.x ? 1.0f : 0.5f,
						  near_x.y == wanted_x.y && near_y.y == wanted_y.y ? 1.0f : 0.5f);
		vec2 counts = known * (1.0f - (farther + nearer * before / place) * distance);
		before = place;
		closed += float(nookSliceBitCount(ahead)) * counts.x;
		closed += float(nookSliceBitCount(opposite)) * counts.y;
	}
	float whole = sqrt(square) * sectors.z;
	return vec4(whole * (1.0f - closed / 31.0f), whole, lost.x * sqrt(square), lost.y * sqrt(square));
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
vec4 nookSliceMean(ivec2 pixel, float depth, vec3 n)
{
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth);
	vec3 sight = nookSight(pixel);
	vec3 v = sight / sqrt(dot(sight, sight));
	vec3 across = nookSliceAcross(v);
	vec3 up = cross(v, across);
	vec3 facing = vec3(dot(n, across), dot(n, up), dot(n, v));
	vec2 sum = vec2(0.0f, 0.0f);
	vec3 lost = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < 1; ++i)
	{
		vec2 own = nookSliceSample(pixel, i);
		float angle = own.x * 3.14159265f / float(1);
		vec2 azimuth = vec2(cos(angle), sin(angle));
		vec4 slice = nookSlice(pixel, depth, radius, scale, sight, across, up, v, facing, azimuth, own.y);
		sum = sum + vec2(slice.x, slice.y);
		lost = lost + (across * azimuth.x + up * azimuth.y) * slice.z + v * slice.w;
	}
	float open = sum.y > 0.0f ? sum.x / sum.y : 1.0f;
	lost = lost / max(sum.y, 1e-12f);
	return vec4(lost.x, lost.y, lost.z, open);
}

// Visibility of a pixel by slices.
float nookSlices(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 n = nookNormal(pixel); // fetched together with the depth
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float open = nookSliceMean(pixel, depth, n).w;
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
		along_x = nookAlike(sight, depth, n, right, vec2(float(1), 0.0f));
		along_y = nookAlike(sight, depth, n, lower, vec2(0.0f, float(1)));
		along_x = cell.x < last.x ? along_x : 0.0f;
		along_y = cell.y < last.y ? along_y : 0.0f;
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
	return nookCellOf(ivec2(int(nook.origin.x) + 1 - 1, int(nook.origin.y) + 1 - 1));
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
