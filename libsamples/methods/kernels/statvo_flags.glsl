// SPDX-License-Identifier: MIT
// Where statistical volumetric obscurance needs no layers: surfaces without creases and edges around a tile of 8 x 8 pixels.
// An addition of nook; the paper evaluates all layers everywhere.

// Slope between two depths that differ by `rise`, of a function of depth that is affine in the picture on every plane.
float nookStatSlope(float depth, float rise)
{
	float near = nook.w_slope * depth + nook.w_start;
	float far = nook.w_slope * (depth + rise) + nook.w_start;
	return rise * (nook.w_slope * nook.w_slope + nook.w_start * nook.w_start) / (near * far);
}

// How much deeper than a pixel its tangent plane is `across` pixels away (x to the right, y downward); NOOK_SKY where the plane
// does not face the camera there. w: clip-space w of the pixel.
float nookStatRise(ivec2 pixel, vec2 across, float w)
{
	vec3 n = nookNormal(pixel);
	vec2 texel = nookTexel();
	float beside = n.x * texel.x * across.x + n.y * texel.y * across.y;
	float fall = nook.w_slope * beside - dot(n, nookSight(pixel));
	return fall > -1e-6f ? NOOK_SKY : -w * beside / fall;
}

// From a pixel to its neighbour: the smallest slope as x and the smallest negated slope as y, of the surface between them
// and of the tangent plane of the pixel. No bound where both pixels are in no table; an infinite slope where only one of them
// is.
vec2 nookStatStep(ivec2 pixel, ivec2 there)
{
	if (!nookStatHolds(there))
	{
		return vec2(NOOK_SKY, NOOK_SKY);
	}
	float depth = nookDepth(pixel);
	float beside = nookDepth(there);
	int kept = nookStatKept(depth);
	if (kept != nookStatKept(beside))
	{
		return vec2(-NOOK_SKY, -NOOK_SKY);
	}
	if (kept == 0)
	{
		return vec2(NOOK_SKY, NOOK_SKY);
	}
	float slope = nookStatSlope(depth, beside - depth);
	vec2 result = vec2(slope, -slope);
#if NOOK_USE_NORMAL
	vec2 across = vec2(float(there.x - pixel.x), float(there.y - pixel.y));
	float w = nook.w_slope * depth + nook.w_start;
	float rise = nookStatRise(pixel, across, w);
	if (rise >= NOOK_SKY || nook.w_slope * (depth + rise) + nook.w_start <= 0.0f)
	{
		return vec2(-NOOK_SKY, -NOOK_SKY);
	}
	float own = nookStatSlope(depth, rise);
	result = min(result, vec2(own, -own));
#endif
	return result;
}

// A texel for 8 x 8 pixels: bounds of nookStatStep along x (x, y) and along y (z, w).
vec4 nookStatSlopes(ivec2 tile)
{
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pixel = ivec2(nook.first.x + tile.x * 8 + i % 8, nook.first.y + tile.y * 8 + i / 8);
		if (nookStatHolds(pixel))
		{
			vec2 across = nookStatStep(pixel, ivec2(pixel.x + 1, pixel.y));
			vec2 down = nookStatStep(pixel, ivec2(pixel.x, pixel.y + 1));
			least = min(least, vec4(across.x, across.y, down.x, down.y));
		}
	}
	return least;
}

// Last texel of a level of the slopes.
ivec2 nookStatLast(int level)
{
	ivec2 size = nookStatSize();
	return ivec2(max(((size.x + 7) / 8) >> level, 1) - 1, max(((size.y + 7) / 8) >> level, 1) - 1);
}

// A texel of the next level, NOOK_LEVEL, from 2 x 2 texels; from 3 on a side where the last one would be left over.
vec4 nookStatSlopesUp(ivec2 texel)
{
	int level = NOOK_LEVEL;
	ivec2 last = nookStatLast(level);
	ivec2 source = nookStatLast(level - 1);
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int i = 0; i < 9; ++i)
	{
		ivec2 there = ivec2(texel.x * 2 + i % 3, texel.y * 2 + i / 3);
		bool mine = (i % 3 < 2 || texel.x == last.x) && (i / 3 < 2 || texel.y == last.y);
		if (mine && there.x <= source.x && there.y <= source.y)
		{
			least = min(least, nookLevel(there, level - 1));
		}
	}
	return least;
}

// For a tile of 8 x 8 pixels: 0 where layers would make no visible difference, else 1.
// With normals: 0 where everything that the box of these pixels reaches lies so close to the tangent plane of each pixel that
// no mean of a layer can be off it by more than 1/512 of the height of the box. Any path from one pixel to the other has slopes
// within their bounds. Without normals: 0 where all of it lies between the near and the far face of the box, since psi is
// linear there.
float nookStatFlags(ivec2 tile)
{
	float near = NOOK_SKY;
	float far = 0.0f;
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pixel = ivec2(nook.first.x + tile.x * 8 + i % 8, nook.first.y + tile.y * 8 + i / 8);
		if (nookStatHolds(pixel))
		{
			float depth = nookDepth(pixel);
			if (nookStatKept(depth) != 0)
			{
				near = min(near, depth);
				far = max(far, depth);
			}
		}
	}
	if (near >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec2 box = nookStatBox(near);
	vec2 reach = vec2(floor(box.x) + float(NOOK_TABLE_CELL), floor(box.y) + float(NOOK_TABLE_CELL));
	int level = 0;
	while (float(24 << level) < 2.0f * max(reach.x, reach.y) + 8.0f && nookStatLast(level) != ivec2(0, 0))
	{
		level = level + 1;
	}
	ivec2 last = nookStatLast(level);
	int left = max(tile.x * 8 - int(reach.x), 0) / 8;
	int upper = max(tile.y * 8 - int(reach.y), 0) / 8;
	ivec2 first = ivec2(min(left >> level, last.x), min(upper >> level, last.y));
	ivec2 end = ivec2(min(((tile.x * 8 + 7 + int(reach.x)) / 8) >> level, last.x),
					  min(((tile.y * 8 + 7 + int(reach.y)) / 8) >> level, last.y));
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int y = first.y; y <= end.y; ++y)
	{
		for (int x = first.x; x <= end.x; ++x)
		{
			least = min(least, nookLevel(ivec2(x, y), level));
		}
	}
	if (min(min(least.x, least.y), min(least.z, least.w)) <= -NOOK_SKY)
	{
		return 1.0f;
	}
	// Spread of the slopes, and their largest size; 0 where only one pixel is in the tables.
	vec2 spread = max(vec2(-least.x - least.y, -least.z - least.w), vec2(0.0f, 0.0f));
	vec2 steepest = max(-min(vec2(least.x, least.z), vec2(least.y, least.w)), vec2(0.0f, 0.0f));
	float total = nook.w_slope * nook.w_slope + nook.w_start * nook.w_start;
	float w = nook.w_slope * far + nook.w_start;
	// 1 / w decreases by slope * distance / total.
	float rest = 1.0f / w - nook.w_slope * dot(steepest, reach) / total;
	if (rest <= 0.0f)
	{
		return 1.0f;
	}
	float height = nook.box_height * nookStatRadius(near);
#if NOOK_USE_NORMAL
	float ray_x = abs(nook.w_slope * nook.across_x.x) + abs(nook.across_x.y);
	float ray_y = abs(nook.w_slope * nook.across_y.x) + abs(nook.across_y.y);
	float away = dot(spread, reach) / (rest * rest * total) * sqrt(1.0f + ray_x * ray_x + ray_y * ray_y);
	return away * 512.0f <= height ? 0.0f : 1.0f;
#else
	return dot(steepest, reach) / (rest * rest * total) <= height ? 0.0f : 1.0f;
#endif
}
