// SPDX-License-Identifier: MIT
// Debug views of statistical volumetric obscurance, like debug.glsl for the other methods; not in emitted modules.

// Fraction of the layers that a pixel evaluates; with skipping, or a single layer, it evaluates one.
float nookDebugLayers(ivec2 pixel)
{
	ivec2 at = nookDebugPixel(pixel);
	float depth = nookDepth(at);
	if (nookStatKept(depth) == 0)
	{
		return 0.0f;
	}
	if (nookStatLayered(ivec2(at.x - nook.first.x, at.y - nook.first.y)) == 0)
	{
		return 1.0f / float(NOOK_LAYERS);
	}
#if NOOK_UNIFORM_LAYERS
	vec3 n = vec3(0.0f, 0.0f, 0.5f);
#if NOOK_USE_NORMAL
	n = nookNormal(at);
#endif
	vec2 ends = nookStatEnds(depth, n);
	return float(int(ends.y) - int(ends.x) + 1) / float(NOOK_LAYERS);
#else
	return 1.0f;
#endif
}
