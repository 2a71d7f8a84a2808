// SPDX-License-Identifier: MIT
// For comparison, not in emitted modules: Crytek's ambient occlusion, which tests points of the ball against the depth buffer. This
// work is based on: M. Mittring, "Finding Next Gen: CryEngine 2", SIGGRAPH 2007 courses; with the range check of V. Kajalin,
// "Screen-Space Ambient Occlusion", ShaderX7, 2009.
//
// Members of the block:
//   float crytek_range: radii in front from which a sample counts as 1/2

// Fraction of the ball's points in front of the depth buffer. The normal is not used, so an open flat surface reads about 1/2 and
// convex edges read more. Samples: (x, y, z, weight), x right, y up, z toward the camera.
// The range check: a surface far in front provides no information about the ball; it counts as 1/2 from nook.crytek_range radii on,
// and partly before. Kajalin measures the range and the ball relative to the depth; here both are lengths, so that a level looks
// the same from any distance.
float nookCrytek(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth) * radius;
	int row = nookVariant(pixel);
	float seen = 0.0f;
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec4 point = nookSample(row, i);
		float surface = nookDepth(nookNeighbour(pixel, vec2(point.x, point.y), scale));
		float invalid = clamp((depth - surface) / (nook.crytek_range * radius), 0.0f, 1.0f);
		float open = 0.0f;
		if (surface > depth - radius * point.z)
		{
			open = 1.0f;
		}
		seen += point.w * (open + (0.5f - open) * invalid);
	}
	float open = min(seen, 1.0f);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
