// SPDX-License-Identifier: MIT
// Depth buffers of any projection and format, and how far to look.

// What a depth buffer holds, 0 to 1 -> depth, for every projection whose z does not depend on x and y: perspective and parallel,
// reversed, infinite, both ranges of z. nook.far_end is what the far end holds, 0 or 1. With t = the distance from there, depth =
// (nook.depth.x + nook.depth.y t) / (nook.depth.z + nook.depth.w t): far away t is exact, where 1 - device / far loses digits.
// The far end itself is sky, for that is what the buffer is cleared to; so is what lies beyond infinity.
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
