// SPDX-License-Identifier: MIT
// Positions from depth, and sizes in the picture, for any projection without a skew.
//
// Written once for GLSL and for C++ with GLM (kernels.h): no swizzles, no in or out parameters, 1.0f literals. The including
// file provides the block `nook` and the functions nookDepth, nookNormal and nookSample.
//
// View space is right-handed, the camera looks down -z, in metres. depth = -z > 0; sky has a depth of NOOK_SKY or more.
// Pixel (0, 0) is the upper left one of the texture. The picture that the projection makes is the rectangle of nook.size pixels
// at nook.origin; nook.first and nook.last are the first and the last pixel that hold depth, guard band included.

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

// From the surface of a pixel to that of another one, which is `across` pixels away (x to the right, y downward) and `deeper`
// metres deeper, with the clip-space w there. sight: of the first pixel.
vec3 nookOffset(vec3 sight, vec2 across, float deeper, float w)
{
	vec2 texel = nookTexel();
	return vec3(across.x * texel.x * w - sight.x * deeper, across.y * texel.y * w - sight.y * deeper, -deeper);
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

// The pixel at `offset` (x to the right, y up, in the unit of `scale`) from the centre of a pixel, moved to the nearest pixel that
// holds depth. Clamped before it becomes an int: close to the camera a radius may span more pixels than an int can count.
ivec2 nookNeighbour(ivec2 pixel, vec2 offset, vec2 scale)
{
	float x = clamp(float(pixel.x) + 0.5f + offset.x * scale.x, float(nook.first.x), float(nook.last.x));
	float y = clamp(float(pixel.y) + 0.5f - offset.y * scale.y, float(nook.first.y), float(nook.last.y));
	return ivec2(int(floor(x)), int(floor(y))); // rounded last: GPUs convert and round down in one instruction
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

// Pixels near another one, as floats: 12582912 + the distance. That is 1.5 * 2^23, where floats have a spacing of 1. So adding an
// offset rounds it, and the bits are those of 12582912 (0x4b400000) + the distance: no instruction rounds or converts.

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
#if NOOK_BANDS > 1
	if (pixels < nook.first_band_px)
	{
		return NOOK_FIRST_BAND;
	}
#endif
#if NOOK_BANDS > 2
	if (pixels < nook.second_band_px)
	{
		return NOOK_TWO_BANDS;
	}
#endif
	return NOOK_SAMPLES;
}
