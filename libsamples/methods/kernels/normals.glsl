// SPDX-License-Identifier: MIT
// Normals from depth: on each axis one difference of depths, to the neighbour on the side where the surface continues.
// The choice of side is after: Y. Wu, "Accurate Normal Reconstruction from Depth Buffer", 2019 (a note on the web): the side
// whose two neighbours, extrapolated in a straight line, come closest to the pixel. Here the extrapolation is straight in 1 /
// w, so that planes are exact for any projection.

// A function of depth that is affine in the picture on every plane: 1 / w, or the depth itself where w is constant.
float nookAffine(float depth)
{
	return nook.w_slope == 0.0f ? depth : 1.0f / (nook.w_slope * depth + nook.w_start);
}

// Depth of a pixel, NOOK_SKY where it holds none.
float nookDepthOrSky(ivec2 pixel)
{
	return nookInside(pixel) == pixel ? nookDepth(pixel) : NOOK_SKY;
}

// How badly one side continues to a pixel of the given depth: the error of extrapolating the depths one and two pixels away
// (beside, beyond) to it. The difference to the nearer one alone counts as well, so that a surface of two pixels is not lost.
float nookMisfit(float depth, float beside, float beyond)
{
	float first = nookAffine(beside);
	float own = nookAffine(depth);
	float gap = abs(first - own);
	return beyond >= NOOK_SKY ? gap : min(gap, abs(2.0f * first - nookAffine(beyond) - own));
}

// Direction of the surface along an axis of the picture, a unit vector; 0 where both neighbours are sky. It comes from the
// difference of the depths, because a difference of positions would lose its digits far away.
vec3 nookAlongAxis(ivec2 pixel, ivec2 axis, float depth, vec3 sight)
{
	float after = nookDepthOrSky(pixel + axis);
	float before = nookDepthOrSky(pixel - axis);
	bool forward = after < NOOK_SKY;
	if (forward && before < NOOK_SKY)
	{
		float fore = nookMisfit(depth, after, nookDepthOrSky(pixel + axis + axis));
		float back = nookMisfit(depth, before, nookDepthOrSky(pixel - axis - axis));
		forward = fore <= back + 2e-6f * abs(nookAffine(depth)); // rounding must not decide
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

// Unit normal of the surface that a pixel shows, in view space, toward the camera; nine depth reads at most. It is exact on a
// plane. Where the surface is known along one axis only, or along none, the normal faces the camera as far as that allows.
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
