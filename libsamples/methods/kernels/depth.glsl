// SPDX-License-Identifier: MIT
// Depth buffers of any projection and format, and the radius at a depth.

// Linear depth from the value of a depth buffer, 0 to 1, for every projection whose z does not depend on x and y: perspective
// and orthographic, reversed, infinite, both ranges of NDC z. t is the distance of the value from nook.far_end, its value at
// the far plane, because 1 - value would lose digits far away. The far plane itself is sky, since buffers are cleared to it,
// and so is everything beyond infinity.
float nookLinear(float device)
{
	float t = abs(device - nook.far_end);
	float below = nook.depth.z + nook.depth.w * t;
	if (t <= 0.0f || below <= 0.0f)
	{
		return NOOK_SKY;
	}
	return (nook.depth.x + nook.depth.y * t) / below;
}

// By how much rounding may have changed a depth, in the unit of the depth. A step of a depth buffer grows with the square of w:
// nook.depth_step is half a step at w = 1, nook.depth_share is the rounding in proportion to the depth.
float nookDepthError(float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	return nook.depth_step * w * w + nook.depth_share * abs(depth);
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
