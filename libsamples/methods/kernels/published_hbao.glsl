// SPDX-License-Identifier: MIT
// For comparison, not in emitted modules: horizon-based ambient occlusion.
// This work is based on: L. Bavoil, M. Sainz, R. Dimitrov, "Image-Space Horizon-Based Ambient Occlusion", SIGGRAPH 2008 talks.
//
// Members of the block:
//   float hbao_sine: sine of the angle bias
//   float hbao_cosine: cosine of the angle bias

// Marches along directions in the picture, in steps over the projected radius. Elevations are relative to the picture plane: t for
// the tangent, h for the highest seen so far. AO = mean over directions of the steps' (sin h - sin of the previous h) W, starting
// with h = t + angle bias; W = 1 - distance^2, in radii. The tangent is where lines of sight along the direction meet the tangent
// plane, as the authors' sample derives it from differences of positions: straight up in the picture need not be straight up in
// space. Samples, one per direction: (cos, sin, fraction of a step for the first step, weight), rotated and jittered for each pixel
// of a window. nook.hbao_sine and nook.hbao_cosine are those of the bias; NOOK_STEPS: at most one per pixel.
float nookHbao(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth) * radius;
	int steps = min(NOOK_STEPS, int(max(scale.x, abs(scale.y))));
	if (steps < 1)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec3 sight = nookPosition(pixel, 1.0f) - nookPosition(pixel, 0.0f);
	float facing = min(dot(n, sight), -1e-6f);
	int row = nookVariant(pixel);
	float sum = 0.0f;
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec4 direction = nookSample(row, i);
		vec3 tangent = vec3(direction.x, direction.y, 0.0f) - ((n.x * direction.x + n.y * direction.y) / facing) * sight;
		float rise = tangent.z;
		float run = sqrt(tangent.x * tangent.x + tangent.y * tangent.y);
		float whole = sqrt(rise * rise + run * run);
		float sine = 1.0f;
		if (run * nook.hbao_cosine > rise * nook.hbao_sine)
		{
			sine = (rise * nook.hbao_cosine + run * nook.hbao_sine) / whole; // t + bias < 90 degrees
		}
		float covered = 0.0f;
		for (int k = 0; k < steps; ++k)
		{
			float share = (float(k) + direction.z) / float(steps);
			ivec2 there = nookNeighbour(pixel, vec2(direction.x * share, direction.y * share), scale);
			float surface = nookDepth(there);
			if (surface < NOOK_SKY)
			{
				vec3 v = (nookPosition(there, surface) - centre) / radius;
				float square = dot(v, v);
				if (square < 1.0f && v.z > sine * sqrt(square))
				{
					float higher = v.z / sqrt(square);
					covered += (higher - sine) * (1.0f - square);
					sine = higher;
				}
			}
		}
		sum += direction.w * covered;
	}
	float open = max(0.0f, 1.0f - sum);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
