// SPDX-License-Identifier: MIT
// Fragment stage with masks: from a pixel that a volume covers to the directions that the polygon covers there, as bits.

// Height of the surface that a pixel shows above the polygon where it is within the volume, else 0. Sets nook_normal.
float nookMaskHeight(ivec2 pixel)
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
	nook_normal = nookTurned(nookNormal(pixel));
	if (dot(nook_normal, nook_normal) < 0.25)
	{
		return 0.0;
	}
	height = nookLifted(height, nook_normal);
	bool within = nookReaches(height, float(nook_polygon.z), nook.radius * nookShare().x, nook_bias) &&
		nookFalloff(nook_polygon.y, nook_front.xyz, abs(height), nook.radius, nookShare().y) > 0.0;
	return within ? height : 0.0;
}

// nookMaskBits for this polygon. height: not 0.
uvec4 nookCovered(int four, vec3 normal, float height)
{
	return nookMaskBits(nook_polygon.y, four, normal, nook_front.xyz, height, nook_front.w, nook_polygon.x, nook.radius,
		uvec4(0xffffffffu, 0xffffffffu, 0xffffffffu, 0xffffffffu));
}
