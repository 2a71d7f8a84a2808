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

// nookMaskRing for this polygon.
vec2 nookCoveredRing(vec3 normal, float height)
{
	return nookMaskRing(nook_polygon.y, normal, nook_front.xyz, height, nook.radius);
}

// nookMaskWord for this polygon: 32 of the directions. height: not 0.
uint nookCovered(int word, vec3 normal, float height)
{
	return nookMaskWord(nook_polygon.y, word, normal, nook_front.xyz, height, nook_front.w, nook_polygon.x, nook.radius);
}
