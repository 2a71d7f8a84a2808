// SPDX-License-Identifier: MIT
// For comparison, not in emitted modules: scalable ambient obscurance.
// This work is based on: M. McGuire, M. Mara, D. Luebke, "Scalable Ambient Obscurance", HPG 2012.

// Level nook.march.y + 1 of the depths from level nook.march.y, the picture itself being level 0: every fourth pixel, whose place
// among its four changes from texel to texel (rotated grid), so that no column or row is left out whole. No mean: a mean of depths is
// no depth of anything.
float nookSaoDepth(ivec2 texel)
{
	int level = nook.march.y;
	int size = 1 << level;
	ivec2 there = ivec2(2 * texel.x + (texel.y & 1), 2 * texel.y + (texel.x & 1));
	there = ivec2(min(there.x, max((nook.rect.z + 1) / size, 1) - 1), min(there.y, max((nook.rect.w + 1) / size, 1) - 1));
	if (level == 0)
	{
		return nookDepth(there);
	}
	return nookLevel(there, level - 1).x;
}

// A pixel's depth from the level for samples that are `distance` pixels away: one level more with every doubling beyond 2^3
// pixels, the paper's q', so that neighbouring pixels' samples share texels.
float nookSaoSurface(ivec2 pixel, float distance)
{
	int level = clamp(int(floor(log2(max(distance, 1.0f)))) - 3, 0, nook.march.x);
	int size = 1 << level;
	if (level == 0)
	{
		return nookDepth(pixel);
	}
	int x = min(pixel.x / size, max((nook.rect.z + 1) / size, 1) - 1);
	int y = min(pixel.y / size, max((nook.rect.w + 1) / size, 1) - 1);
	return nookLevel(ivec2(x, y), level - 1).x;
}

// The turn of a pixel's spiral: 10 (3 x xor (y + x y)) radians, to 1/4096 of a turn, in integers so that all machines agree.
float nookSaoTurn(ivec2 pixel)
{
	int hash = (3 * pixel.x) ^ (pixel.y + pixel.x * pixel.y);
	return float(((hash & 4095) * 2423) & 4095) * (6.2831853f / 4096.0f);
}

// A = max(0, 1 - 5 intensity / s sum (1 - v.v)^3 max(0, (v.n - bias) / (v.v + epsilon))) over s samples, v in radii: what the authors
// publish for r = 1 m; for another radius their intensity is ours * r, their bias ours * r, their epsilon ours * r^2.
// Samples: (x, y, distance, weight), a spiral. nook.rival = (intensity, bias, epsilon); nook.march.x = levels beside the picture.
// Theirs takes normals from depth; ours those of the G-buffer, which may be from depth as well.
float nookSao(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius.x, depth);
	vec2 scale = nookScale(depth) * radius;
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	float turn = nookSaoTurn(pixel);
	float c = cos(turn);
	float s = sin(turn);
	float sum = 0.0f;
	for (int i = 0; i < nook.count.x; ++i)
	{
		vec4 point = nookSample(0, i);
		ivec2 there = nookNeighbour(pixel, vec2(c * point.x - s * point.y, s * point.x + c * point.y), scale);
		float x = float(there.x - pixel.x);
		float y = float(there.y - pixel.y);
		float near = sqrt(x * x + y * y) + 1.0f; // nearer than the spiral's where the picture's border holds it back
		float surface = nookSaoSurface(there, min(point.z * max(scale.x, abs(scale.y)), near));
		if (surface < NOOK_SKY)
		{
			vec3 v = (nookPosition(there, surface) - centre) / radius;
			float square = dot(v, v);
			float f = max(1.0f - square, 0.0f);
			sum += point.w * f * f * f * max((dot(v, n) - nook.rival.y) / (square + nook.rival.z), 0.0f);
		}
	}
	return max(0.0f, 1.0f - 5.0f * nook.rival.x * sum);
}
