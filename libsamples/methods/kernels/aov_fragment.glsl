// SPDX-License-Identifier: MIT
// Fragment stage of ambient occlusion volumes: a pixel of a volume -> what its polygon takes from the surface there. Not a kernel of
// both languages, but calls those (methods/kernels/*.glsl). What stands before it, and its main(), are in aov_text.cpp.

// Corner i of the polygon from the receiver.
vec3 nookCorner(int i)
{
	return nook_base + nook_step * vec3(nookPackedCorner(nook_polygon.x + i).xyz);
}

// View space -> axes of the world.
vec3 nookTurned(vec3 v)
{
	return nook.right.xyz * v.x + nook.up.xyz * v.y + nook.back.xyz * v.z;
}

// Sets the receiver and by how much its place may be off; its normal, or 0 where there is none.
vec3 nookReceive(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return vec3(0.0);
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
