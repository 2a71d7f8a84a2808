// SPDX-License-Identifier: MIT
// Fragment stage of the volumes: from a pixel that a volume covers to the occlusion of the surface there by the polygon.

// From view space to the axes of the world.
vec3 nookTurned(vec3 v)
{
	return nook.right.xyz * v.x + nook.up.xyz * v.y + nook.back.xyz * v.z;
}

// Sets up the surface that a pixel shows as the receiver, with the rounding of its position; returns its height above the polygon.
float nookReceive(ivec2 pixel, float depth)
{
	nook_base = nook_offset - nookTurned(nookPosition(pixel, depth));
	nook_bias = max(nook.plane_bias, nookDepthError(depth) + nook.position_error);
	return nookHeight(nook_front.xyz);
}

// Does the volume reach the receiver, or may it once nookLifted has moved it?
bool nookMayReach(float height)
{
	return nookReaches(height, float(nook_polygon.z), nook.radius * nookShare().x, -nook_bias);
}

// Moves the receiver by nookLift; returns its new height.
float nookLifted(float height, vec3 normal)
{
	float lift = nookLift(height, float(nook_polygon.z), nook_bias, dot(normal, nook_front.xyz));
	nook_base -= lift * nook_front.xyz;
	return height + lift;
}

// AOV eqs. 4 and 5. The normal is fetched only where the volume reaches.
float nookOcclusion(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 0.0;
	}
	float height = nookReceive(pixel, depth);
	if (!nookMayReach(height))
	{
		return 0.0;
	}
	vec3 normal = nookTurned(nookNormal(pixel));
	height = nookLifted(height, normal);
	return nookVolume(nook_polygon.y, normal, nook_front.xyz, nook_front.w, float(nook_polygon.z), height, nook.radius, nookShare(),
		nook_bias);
}
