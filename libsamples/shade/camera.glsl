// SPDX-License-Identifier: MIT
// Any camera without a skew: positions from depth, and how large a length is in the picture.
//
// Written once for GLSL and for C++ with GLM (kernels.h): no swizzles, no in or out parameters, 1.0f literals. Whoever includes it
// offers the block `nook` and the functions nookDepth, nookNormal and nookSample.
//
// View space: right-handed, the camera looks down -z, metres. depth = -z > 0; sky has a depth of NOOK_SKY or more.
// Pixels: (0, 0) is the upper left one.

// View-space position of what a pixel shows at a depth. nook.across_x = (1/P00, P20/P00, -P30/P00), nook.across_y the same of the
// second row with P11, P21, P31; nook.w = (-P23, P33): w after the projection is nook.w.x * depth + nook.w.y.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w.x * depth + nook.w.y;
	float ndc_x = (float(pixel.x) + 0.5f) * nook.size.z * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f) * nook.size.w * 2.0f;
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
	return ivec2(clamp(pixel.x, 0, int(nook.size.x) - 1), clamp(pixel.y, 0, int(nook.size.y) - 1));
}

// The pixel that lies `offset` metres (x right, y up) from the middle of a pixel, or the nearest one of the picture.
ivec2 nookNeighbour(ivec2 pixel, vec2 offset, vec2 scale)
{
	float x = float(pixel.x) + 0.5f + offset.x * scale.x;
	float y = float(pixel.y) + 0.5f - offset.y * scale.y;
	return nookInside(ivec2(int(floor(x)), int(floor(y))));
}

// Depth at which another pixel's line of sight is `height` metres above the tangent plane of a pixel, less the depth of that pixel;
// NOOK_SKY where the plane does not face the camera there. From the distance between the pixels alone: the depths themselves would
// leave nothing of it far away.
float nookPlaneRise(ivec2 pixel, ivec2 there, vec3 n, float depth, float height)
{
	float w = nook.w.x * depth + nook.w.y;
	float x = float(there.x - pixel.x) * nook.size.z * 2.0f * w * nook.across_x.x;
	float y = float(pixel.y - there.y) * nook.size.w * 2.0f * w * nook.across_y.x;
	float fall = dot(n, nookPosition(there, 1.0f) - nookPosition(there, 0.0f));
	if (fall > -1e-6f)
	{
		return NOOK_SKY;
	}
	return (height - (n.x * x + n.y * y)) / fall;
}
