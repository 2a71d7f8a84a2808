// SPDX-License-Identifier: MIT
// Fragment stage with masks: from a pixel that a volume covers to the directions that the polygon covers there, as bits.

// Height of the receiver above the polygon where it is within the volume, else 0.
float nookMaskHeight(vec3 normal)
{
	if (dot(normal, normal) < 0.25)
	{
		return 0.0;
	}
	float height = nookHeight(nook_front.xyz);
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
