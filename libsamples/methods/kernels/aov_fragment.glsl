// SPDX-License-Identifier: MIT
// Fragment stage of the volumes: from a pixel that a volume covers to the occlusion of the surface there by the polygon.

// From view space to the axes of the world.
vec3 nookTurned(vec3 v)
{
	return nook.right.xyz * v.x + nook.up.xyz * v.y + nook.back.xyz * v.z;
}

// Sets up the surface that a pixel shows as the receiver, with the rounding of its position; returns its normal, or 0 where
// there is no surface.
vec3 nookReceive(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return vec3(0.0, 0.0, 0.0);
	}
	nook_base = nook_offset - nookTurned(nookPosition(pixel, depth));
	nook_bias = max(nook.plane_bias, nookDepthError(depth) + nook.position_error);
	vec3 normal = nookTurned(nookNormal(pixel));
	nook_base -= nookLift(nookHeight(nook_front.xyz), float(nook_polygon.z), nook_bias, dot(normal, nook_front.xyz)) * nook_front.xyz;
	return normal;
}

// AOV eqs. 4 and 5.
float nookOcclusion(ivec2 pixel)
{
	vec3 normal = nookReceive(pixel);
	if (dot(normal, normal) < 0.25)
	{
		return 0.0;
	}
	return nookVolume(nook_polygon.y, normal, nook_front.xyz, nook_front.w, float(nook_polygon.z), nook.radius,
		nookShare(), nook_bias);
}
