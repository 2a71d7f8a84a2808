// SPDX-License-Identifier: MIT
// Any camera without a skew: positions from depth, and how large a length is in the picture.
//
// Written once for GLSL and for C++ with GLM (kernels.h): no swizzles, no in or out parameters, 1.0f literals. Whoever includes it
// offers the block `nook` and the functions nookDepth, nookNormal and nookSample.
//
// View space: right-handed, the camera looks down -z, metres. depth = -z > 0; sky has a depth of NOOK_SKY or more.
// Pixels: (0, 0) is the texture's upper left one. The picture that the projection makes is the rectangle of nook.size pixels from
// nook.origin on; nook.first and nook.last are the first and the last pixel that hold depth, those around the picture (a guard band)
// included.

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
