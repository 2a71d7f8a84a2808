// SPDX-License-Identifier: MIT
// For comparison, not in emitted modules: scalable ambient obscurance.
// This work is based on: M. McGuire, M. Mara, D. Luebke, "Scalable Ambient Obscurance", HPG 2012.
//
// Members of the block:
//   float sao_intensity: factor of the obscurance
//   float sao_bias: height over the tangent plane that counts for nothing, in radii
//   float sao_epsilon: in squares of the radius

// Rotation of a pixel's spiral, cosine and sine: 10 (3 x xor (y + x y)) radians, to 1/4096 of a turn, in integers so that all
// machines agree; plus NOOK_VARIANT sixteenths of a turn (--debug noise).
vec2 nookSaoTurn(ivec2 pixel)
{
	int hash = (3 * pixel.x) ^ (pixel.y + pixel.x * pixel.y);
	float turn = float(((hash & 4095) * 2423 + NOOK_VARIANT * 256) & 4095) * (6.2831853f / 4096.0f);
	return vec2(cos(turn), sin(turn));
}

// Position of a sample of the spiral: a pixel, and the level of depth_levels.glsl that it reads.
ivec3 nookSaoPlace(ivec2 pixel, vec4 point, vec2 turn, vec2 scale)
{
	vec2 turned = vec2(turn.x * point.x - turn.y * point.y, turn.y * point.x + turn.x * point.y);
	ivec2 there = nookNeighbour(pixel, turned, scale);
	float x = float(there.x - pixel.x);
	float y = float(there.y - pixel.y);
	float near = sqrt(x * x + y * y) + 1.0f; // less than the spiral's if clamped to the picture's border
	return ivec3(there.x, there.y, nookLevelFor(min(point.z * max(scale.x, abs(scale.y)), near)));
}

// A = max(0, 1 - 5 intensity / s sum (1 - v.v)^3 max(0, (v.n - bias) / (v.v + epsilon))) over s samples, v in radii: the published
// formula for r = 1 m. For another radius their intensity is ours * r, their bias ours * r, their epsilon ours * r^2. Samples: (x,
// y, distance, weight), a spiral. Coarser depths (depth_levels.glsl) are treated as those of the samples' own pixels.
// The authors compute normals from depth; here they come from the G-buffer, which may derive them from depth as well.
float nookSao(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth) * radius;
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec2 turn = nookSaoTurn(pixel);
	float sum = 0.0f;
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec4 point = nookSample(0, i);
		ivec3 place = nookSaoPlace(pixel, point, turn, scale);
		ivec2 there = ivec2(place.x, place.y);
		float surface = nookDepthAt(there, place.z);
		if (surface < NOOK_SKY)
		{
			vec3 v = (nookPosition(there, surface) - centre) / radius;
			float square = dot(v, v);
			if (square < 1.0f)
			{
				float f = 1.0f - square;
				sum += point.w * f * f * f * max((dot(v, n) - nook.sao_bias) / (square + nook.sao_epsilon), 0.0f);
			}
		}
	}
	float open = max(0.0f, 1.0f - 5.0f * nook.sao_intensity * sum);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
