// SPDX-License-Identifier: MIT
// Views that show what methods and filters do rather than their result, for `nook shade --debug`; not in emitted modules.
//
// Each is drawn for every pixel of the picture, in [0, 1]; if visibility is computed on cells of several pixels (reconstruct.glsl),
// a pixel shows the value of its cell. Sky is 0.

ivec2 nookDebugPixel(ivec2 pixel)
{
	return nookPixel(ivec2(pixel.x / NOOK_CELL, pixel.y / NOOK_CELL));
}

// 1 if a filter finds another surface, or sky, in one of the four adjacent cells.
float nookDebugEdges(ivec2 pixel)
{
	ivec2 at = nookDebugPixel(pixel);
	float depth = nookDepth(at);
	if (depth >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec3 n = nookNormal(at);
	vec3 sight = nookSight(at);
	for (int i = 1; i < 5; ++i)
	{
		ivec2 cell = nookOfCross(ivec2(pixel.x / NOOK_CELL, pixel.y / NOOK_CELL), i);
		if (nookDrawn(cell))
		{
			ivec2 there = nookPixel(cell);
			if (nookAlike(sight, depth, n, there, vec2(float(there.x - at.x), float(there.y - at.y))) < 0.5f)
			{
				return 1.0f;
			}
		}
	}
	return 0.0f;
}

// Volumetric obscurance: radius of a ball in the picture, in pixels, as the methods compute it.
float nookDebugBall(float depth, float radius)
{
	vec2 scale = nookScale(depth);
#if NOOK_LEVELS
	return sqrt(abs(scale.x * scale.y)) * nookRadius(radius, depth); // areas
#else
	return max(abs(scale.x), abs(scale.y)) * nookRadius(radius, depth);
#endif
}

// Number of samples for that ball.
int nookDebugBallCount(float pixels)
{
#if NOOK_USE_NORMAL
	if (pixels < 0.5f)
	{
		return 0;
	}
#endif
	return nookCount(pixels);
}

// Volumetric obscurance: fraction of its samples that a pixel takes; with several radii, of all samples.
float nookDebugSamplesVo(ivec2 pixel)
{
	float depth = nookDepth(nookDebugPixel(pixel));
	if (depth >= NOOK_SKY)
	{
		return 0.0f;
	}
	float taken = float(nookDebugBallCount(nookDebugBall(depth, nook.radius)));
#if NOOK_RADII
	taken = 0.5f * (taken + float(nookDebugBallCount(nookDebugBall(depth, nook.second_radius))));
#endif
#if NOOK_THIRD
	taken = (2.0f * taken + float(nookDebugBallCount(nookDebugBall(depth, nook.third_radius)))) / 3.0f;
#endif
	return taken / float(NOOK_SAMPLES);
}

float nookDebugSamplesAlchemy(ivec2 pixel)
{
	float depth = nookDepth(nookDebugPixel(pixel));
	if (depth >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec2 scale = nookScale(depth) * nookRadius(nook.radius, depth);
	return float(nookCount(max(abs(scale.x), abs(scale.y)))) / float(NOOK_SAMPLES);
}

// Horizon-based: steps along each direction.
float nookDebugSamplesHbao(ivec2 pixel)
{
	float depth = nookDepth(nookDebugPixel(pixel));
	if (depth >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec2 scale = nookScale(depth) * nookRadius(nook.radius, depth);
	return float(min(NOOK_STEPS, int(max(scale.x, abs(scale.y))))) / float(NOOK_STEPS);
}

// For methods that take all samples everywhere.
float nookDebugSamplesAll(ivec2 pixel)
{
	return nookDepth(nookDebugPixel(pixel)) >= NOOK_SKY ? 0.0f : 1.0f;
}

// Areas: sum of the levels that a ball's samples read, and the number of samples.
vec2 nookDebugBallLevels(ivec2 at, float pixels)
{
	int count = nookDebugBallCount(pixels);
	int sum = 0;
	for (int i = 0; i < count; ++i)
	{
		sum += nookAreaLevel(log2(pixels), nookSample(nookVariant(at), i));
	}
	return vec2(float(sum), float(count));
}

// Mean depth level, or level of moments, that a pixel's samples read, relative to the number of levels.
float nookDebugLodArea(ivec2 pixel)
{
	ivec2 at = nookDebugPixel(pixel);
	float depth = nookDepth(at);
	if (depth >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec2 sum = nookDebugBallLevels(at, nookDebugBall(depth, nook.radius));
#if NOOK_RADII
	sum += nookDebugBallLevels(at, nookDebugBall(depth, nook.second_radius));
#endif
#if NOOK_THIRD
	sum += nookDebugBallLevels(at, nookDebugBall(depth, nook.third_radius));
#endif
	return sum.x / (max(sum.y, 1.0f) * float(NOOK_LEVELS));
}

float nookDebugLodAlchemy(ivec2 pixel)
{
	ivec2 at = nookDebugPixel(pixel);
	float depth = nookDepth(at);
	if (depth >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec2 scale = nookScale(depth) * nookRadius(nook.radius, depth);
	float pixels = max(abs(scale.x), abs(scale.y));
	int count = nookCount(pixels);
	int sum = 0;
	for (int i = 0; i < count; ++i)
	{
		sum += nookAlchemyLevel(nookSample(nookVariant(at), i), pixels);
	}
	return float(sum) / float(count * NOOK_LEVELS);
}

float nookDebugLodSao(ivec2 pixel)
{
	ivec2 at = nookDebugPixel(pixel);
	float depth = nookDepth(at);
	if (depth >= NOOK_SKY)
	{
		return 0.0f;
	}
	vec2 scale = nookScale(depth) * nookRadius(nook.radius, depth);
	int sum = 0;
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		sum += nookSaoPlace(at, nookSample(0, i), nookSaoTurn(at), scale).z;
	}
	return float(sum) / float(NOOK_SAMPLES * NOOK_LEVELS);
}

// Running mean of the estimates and sum of their squared differences from it, one variant at a time (Welford 1962); NOOK_VARIANTS
// is the number of previous ones.
vec4 nookDebugScatter(ivec2 cell)
{
	float value = nookVisibility(cell);
	vec4 sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
	if (NOOK_VARIANTS > 0)
	{
		sum = nookLevel(cell, 0);
	}
	float apart = value - sum.x;
	float mean = sum.x + apart / float(NOOK_VARIANTS + 1);
	return vec4(mean, sum.y + apart * (value - mean), 0.0f, 0.0f);
}

// Noise due to the choice of the variant: the standard deviation over all NOOK_VARIANTS of them.
float nookDebugNoise(ivec2 pixel)
{
	vec4 sum = nookLevel(ivec2(pixel.x / NOOK_CELL, pixel.y / NOOK_CELL), 0);
	return sqrt(sum.y / float(NOOK_VARIANTS));
}
