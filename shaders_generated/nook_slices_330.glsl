// Made by: nook emit --methods slices --filter bilateral --glsl 330
// Version: nook 0.1.0
// SPDX-License-Identifier: MIT
//
// Visibility, 1 where open, of the pixel of a depth buffer:
//   float nookSlices(ivec2 pixel): slices with bit masks
// Passes, in order, each a function of the texel that is drawn, into a picture of its own:
//   nookSlices(pixel): visibility, R8 or better, the picture's size
//   nookBilateral(pixel), twice: as large; each reads the one before as nook_cells; nook_pass.x = 0, then 1
// Pixels count as texelFetch does. `nook emit -o FILE.h` writes the C++ that fills the block.
// Without #version, to be included after yours. All names begin with nook or NOOK.
//
// Any camera without a skew: positions from depth, and how large a length is in the picture.
//
// Depth buffers of any projection and format, and how far to look.
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
#if __VERSION__ < 330
#error nook: this module needs #version 330 or later
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// Lengths are in metres, or whatever unit your depths have.
layout(std140) uniform nook_block
{
	vec4 size; // width and height of the picture in pixels, 1 / width, 1 / height
	vec4 across_x; // of the projection P: 1 / P00, P20 / P00, -P30 / P00 (P20: column 2, row 0)
	vec4 across_y; // 1 / P11 (negative where the first row of pixels is that of NDC y = -1), P21 / P11, -P31 / P11
	vec4 w; // w after the projection, of a depth d: x * d + y; z: what device depth is at the far end
	vec4 origin; // the picture's first pixel in the texture
	ivec4 rect; // first and last pixel with depth: x, y, x, y
	vec4 depth; // depth at a device depth t away from the far end: (x + y * t) / (z + w * t)
	vec4 error; // of a depth: x * w * w + y * depth; z: sine of the angle by which a normal may be off
	vec4 radius; // x: radius in metres, or in the unit of your depths
	vec4 alchemy; // Alchemy: sigma, contrast k, beta, epsilon
	vec4 volume; // volumetric obscurance: x thickness of surfaces, y second radius, in the unit of the radius
	vec4 limits; // of the bands: below a radius of x pixels the first one's samples, below y the first two's; z, w: most, least pixels
	vec4 statvo; // statistical volumetric obscurance: height of the box in radii, slope of psi, its largest and least half side in pixels
	vec4 slices; // slices: x thickness of surfaces, in radii
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

// Visibility as the pass before drew it.
// Define NOOK_VISIBILITY(pixel) first to read yours in another way.
#ifndef NOOK_VISIBILITY
uniform sampler2D nook_cells;
#define NOOK_VISIBILITY(pixel) texelFetch(nook_cells, pixel, 0).r
#endif
float nookVisibility(ivec2 pixel)
{
	return NOOK_VISIBILITY(pixel);
}

// View-space position of what a pixel shows at a depth. nook.across_x = (1/P00, P20/P00, -P30/P00), nook.across_y the same of the
// second row with P11, P21, P31; nook.w = (-P23, P33): w after the projection is nook.w.x * depth + nook.w.y.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w.x * depth + nook.w.y;
	float ndc_x = (float(pixel.x) + 0.5f - nook.origin.x) * nook.size.z * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f - nook.origin.y) * nook.size.w * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.across_x.z,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.across_y.z, -depth);
}

// Pixels per metre across the view direction at a depth: x to the right, y downward.
vec2 nookScale(float depth)
{
	float w = nook.w.x * depth + nook.w.y;
	return vec2(0.5f * nook.size.x / (w * nook.across_x.x), 0.5f * nook.size.y / (w * nook.across_y.x));
}

ivec2 nookInside(ivec2 pixel)
{
	return ivec2(clamp(pixel.x, nook.rect.x, nook.rect.z), clamp(pixel.y, nook.rect.y, nook.rect.w));
}

// The pixel that lies `offset` metres (x right, y up) from the middle of a pixel, or the nearest one that holds depth.
ivec2 nookNeighbour(ivec2 pixel, vec2 offset, vec2 scale)
{
	float x = float(pixel.x) + 0.5f + offset.x * scale.x;
	float y = float(pixel.y) + 0.5f - offset.y * scale.y;
	return nookInside(ivec2(int(floor(x)), int(floor(y))));
}

// A radius as it is used at a depth: in the picture at most nook.limits.z pixels, and at least nook.limits.w.
float nookRadius(float radius, float depth)
{
	vec2 scale = nookScale(depth);
	float pixels = max(abs(scale.x), abs(scale.y));
	return max(min(radius, nook.limits.z / pixels), nook.limits.w / pixels);
}

// Which of the sixteen variants of a window of 4 x 4 cells a pixel has: the place of its cell in a Bayer matrix, so that neighbours
// differ most.
int nookSliceVariant(ivec2 pixel)
{
	ivec2 cell = ivec2(pixel.x / 1, pixel.y / 1);
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

// Which share of a slice's open directions, by their cosine to the normal, lies before the direction (x, y); y points to the eye.
// turn = (sine, cosine and angle of the normal within the slice). The measure of a direction at the angle t is
// cos(t - angle) |sin t|; its integral from 0 is side / 4 (cos(angle) - cos(2 t - angle)) + |t| / 2 sin(angle).
float nookSliceShare(float x, float y, vec3 turn)
{
	if (x * turn.x + y * turn.y <= 0.0f)
	{
		return x < 0.0f ? 0.0f : 1.0f; // under the tangent plane
	}
	float square = x * x + y * y;
	float side = x < 0.0f ? -1.0f : 1.0f;
	float doubled = ((y * y - x * x) * turn.y + 2.0f * x * y * turn.x) / square;
	float measure = 0.25f * side * (turn.y - doubled) + 0.5f * abs(nookSliceAngle(x, y)) * turn.x;
	float first = 0.5f * (turn.y - (1.57079633f - turn.z) * turn.x);
	return clamp((measure + first) / (turn.y + turn.z * turn.x), 0.0f, 1.0f);
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

// What one slice leaves open, and what it is worth, by the cosine: x the open part, y all. o: the slice's direction across the view,
// a unit vector like v, which points to the eye. jitter: [0, 1).
// A surface at q covers what lies between the direction to it and the one to what is nook.slices.x behind it on its line of sight.
// What covers a bit first counts 1 - distance / radius, at a distance midway between what is seen there and where the step before
// would have seen it: the surface between the two steps is what covers it. Off the slice by up to half a pixel, a surface keeps its
// height over the tangent plane, so that planes cover nothing.
vec2 nookSlice(ivec2 pixel, vec3 n, vec3 centre, float radius, vec2 scale, vec3 sight, vec3 v, vec3 o, float jitter)
{
	vec3 beside = cross(o, v);
	vec2 within = vec2(dot(n, o), dot(n, v));
	float square = max(dot(within, within), 1e-4f);
	float aside = dot(n, beside) / square;
	float facing = max(within.y, 0.0f);
	float size = max(sqrt(within.x * within.x + facing * facing), 1e-6f);
	vec3 turn = vec3(within.x / size, facing / size, nookSliceAngle(within.x, facing));
	vec2 way = vec2(o.x - o.z * sight.x, o.y - o.z * sight.y) * radius;
	uint covered = 0u;
	float closed = 0.0f;
	for (int k = 0; k < 2 * 4; ++k)
	{
		float side = k % 2 == 0 ? 1.0f : -1.0f;
		float moved = jitter + 0.5f * float(k % 2);
		float share = (float(k / 2) + moved - floor(moved)) / float(4);
		ivec2 there = nookNeighbour(pixel, way * (side * share * share), scale);
		float surface = nookDepth(there);
		vec3 d = (nookPosition(there, surface) - centre) / radius;
		float apart = dot(d, d);
		if (surface < NOOK_SKY && apart < 1.0f && (there.x != pixel.x || there.y != pixel.y))
		{
			float slide = dot(d, beside) * aside;
			float x = dot(d, o) + slide * within.x;
			float y = dot(d, v) + slide * within.y;
			vec3 away = nookPosition(there, 1.0f) - nookPosition(there, 0.0f);
			float thick = nook.slices.x / sqrt(dot(away, away));
			float front = nookSliceShare(x, y, turn);
			float back = nookSliceShare(x + thick * dot(away, o), y + thick * dot(away, v), turn);
			int first = int(floor(32.0f * min(front, back) + 0.5f));
			int end = int(floor(32.0f * max(front, back) + 0.5f));
			uint fresh = nookSliceBitsBelow(end) & ~nookSliceBitsBelow(first) & ~covered;
			covered = covered | fresh;
			float before = max(share - 1.0f / float(4), 0.0f) / share;
			closed += float(nookSliceBitCount(fresh)) * (1.0f - 0.5f * (1.0f + before * before) * sqrt(apart));
		}
	}
	float whole = sqrt(square) * (turn.y + turn.z * turn.x);
	return vec2(whole * (1.0f - closed / 32.0f), whole);
}

// nook.count.x slices, each with nook.march.x depths on either side, near ones dense; slices are even around the view ray.
float nookSlices(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius.x, depth);
	vec2 scale = nookScale(depth);
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec3 sight = nookPosition(pixel, 0.0f) - nookPosition(pixel, 1.0f);
	vec3 v = sight / sqrt(dot(sight, sight));
	vec3 across = vec3(v.z, 0.0f, -v.x) / sqrt(v.x * v.x + v.z * v.z);
	vec3 up = cross(v, across);
	int variant = nookSliceVariant(pixel);
	float turn = (float(variant) + 0.5f) / 16.0f;
	float jitter = (float(nookSliceReverse(variant)) + 0.5f) / 16.0f;
	vec2 sum = vec2(0.0f, 0.0f);
	for (int i = 0; i < 1; ++i)
	{
		float angle = (float(i) + turn) * 3.14159265f / float(1);
		sum = sum + nookSlice(pixel, n, centre, radius, scale, sight, v, across * cos(angle) + up * sin(angle), jitter);
	}
	return sum.x / sum.y;
}

ivec2 nookPixel(ivec2 cell)
{
	return cell * 1;
}

// Of the picture, as far as it is drawn: a guard band is not.
ivec2 nookFirstCell()
{
	return ivec2((int(nook.origin.x) + 1 - 1) / 1, (int(nook.origin.y) + 1 - 1) / 1);
}

ivec2 nookLastCell()
{
	return ivec2((int(nook.origin.x + nook.size.x) - 1) / 1, (int(nook.origin.y + nook.size.y) - 1) / 1);
}

bool nookDrawn(ivec2 cell)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	return cell.x >= first.x && cell.y >= first.y && cell.x <= last.x && cell.y <= last.y;
}

// How far, as a share of the radius, a pixel's position is from the tangent plane that it shares with another one; NOOK_SKY for sky.
// The plane between the two normals: it holds both ends of any arc of a circle, so that columns are as smooth as walls. Unlike a
// difference of depths it is 0 along a plane at any slope; and visibility can change by no more than about its size.
float nookApart(vec3 centre, vec3 n, ivec2 there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return abs(dot(n + nookNormal(there), nookPosition(there, depth) - centre)) / (2.0f * nook.radius.x);
}

// Does a pixel show the same surface: 1 yes, 0 no. Flat at both ends, so that on a smooth surface all pixels count alike, which is
// what makes the mean of a window of variants exact. Chosen by eye on builtin:courtyard, not swept.
float nookAlike(vec3 centre, vec3 n, ivec2 there)
{
	float beside = clamp(2.0f - nookApart(centre, n, there) * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, nookNormal(there)) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

// One of two passes (nook.grid.z = 0: along x, 1: along y) with nook.grid.y cells on each side of the cell.
float nookBilateral(ivec2 cell)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	float sum = nookVisibility(cell);
	float weights = 1.0f;
	float width = 0.5f * float(2 + 1);
	for (int i = -2; i <= 2; ++i)
	{
		ivec2 there = cell + ivec2(i * (1 - nook_pass.x), i * nook_pass.x);
		if (i != 0 && nookDrawn(there))
		{
			float weight = exp(-0.5f * float(i * i) / (width * width)) * nookAlike(centre, n, nookPixel(there));
			sum += weight * nookVisibility(there);
			weights += weight;
		}
	}
	return sum / weights;
}

#endif // NOOK_SLICES_GLSL
