// SPDX-License-Identifier: MIT
// Normals from depth: on each axis one difference, to the neighbour on the side where the surface goes on.
// The choice of side is after: Y. Wu, "Accurate Normal Reconstruction from Depth Buffer", 2019 (a note on the web): the one whose two
// neighbours, continued in a straight line, come closest. Ours is straight in 1 / w, so that planes come out whatever the projection.

// What is an affine function of the picture on every plane: 1 / w, or where that is the same everywhere the depth itself.
float nookAffine(float depth)
{
	return nook.w_slope == 0.0f ? depth : 1.0f / (nook.w_slope * depth + nook.w_start);
}

// NOOK_SKY where there is no depth.
float nookDepthOrSky(ivec2 pixel)
{
	return nookInside(pixel) == pixel ? nookDepth(pixel) : NOOK_SKY;
}

// How badly a side continues to a pixel: its depth, and those one and two pixels beside it. Good is also a side whose nearer neighbour
// alone is close, so that surfaces of two pixels' width are seen.
float nookMisfit(float depth, float beside, float beyond)
{
	float first = nookAffine(beside);
	float own = nookAffine(depth);
	float gap = abs(first - own);
	return beyond >= NOOK_SKY ? gap : min(gap, abs(2.0f * first - nookAffine(beyond) - own));
}

// The surface's way along an axis, a unit vector; 0 where neither neighbour is there. From the difference of the depths, for the
// positions themselves would leave little of it far away.
vec3 nookAlongAxis(ivec2 pixel, ivec2 axis, float depth, vec3 sight)
{
	float after = nookDepthOrSky(pixel + axis);
	float before = nookDepthOrSky(pixel - axis);
	bool forward = after < NOOK_SKY;
	if (forward && before < NOOK_SKY)
	{
		float fore = nookMisfit(depth, after, nookDepthOrSky(pixel + axis + axis));
		float back = nookMisfit(depth, before, nookDepthOrSky(pixel - axis - axis));
		forward = fore <= back + 2e-6f * abs(nookAffine(depth)); // rounding decides nothing
	}
	float there = forward ? after : before;
	if (there >= NOOK_SKY)
	{
		return vec3(0.0f, 0.0f, 0.0f);
	}
	float side = forward ? 1.0f : -1.0f;
	float w = nook.w_slope * there + nook.w_start;
	vec3 way = sight * (side * (there - depth));
	way.x += 2.0f * float(axis.x) * nook.pixel_size.x * nook.across_x.x * w;
	way.y -= 2.0f * float(axis.y) * nook.pixel_size.y * nook.across_y.x * w;
	return way / sqrt(dot(way, way));
}

// Unit normal in view space of what a pixel shows, towards the camera: reads nine depths. On a plane it is the plane's. Where the
// surface is known along one axis alone, or none, it turns towards the camera as far as that allows.
vec3 nookNormalFromDepth(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 sight = nookPosition(pixel, 1.0f) - nookPosition(pixel, 0.0f);
	vec3 towards = sight / -sqrt(dot(sight, sight));
	if (depth >= NOOK_SKY)
	{
		return towards;
	}
	vec3 right = nookAlongAxis(pixel, ivec2(1, 0), depth, sight);
	vec3 down = nookAlongAxis(pixel, ivec2(0, nook.across_y.x < 0.0f ? -1 : 1), depth, sight);
	vec3 n = cross(down, right);
	if (dot(n, n) <= 0.0f)
	{
		vec3 only = right + down;
		n = towards - dot(towards, only) * only;
	}
	float square = dot(n, n);
	if (square <= 0.0f)
	{
		return towards;
	}
	n = n / sqrt(square);
	return dot(n, towards) < 0.0f ? -n : n;
}
