// SPDX-License-Identifier: MIT
// Coarser depths for samples that are far away in the picture, so that neighbouring pixels' samples share texels.
// This work is based on: M. McGuire, M. Mara, D. Luebke, "Scalable Ambient Obscurance", HPG 2012 (SAO).
//
// Level l from 1 to NOOK_LEVELS has one texel for 2^l x 2^l pixels, and holds the depth of one of them. No mean: a mean of depths is
// no depth of anything. Which one changes from texel to texel (rotated grid), so that no column or row is left out whole.

// The texel of the level before `level` whose depth is that of a texel of `level`; of level 1, a pixel.
ivec2 nookFinerTexel(ivec2 texel, int level)
{
	ivec2 there = ivec2(2 * texel.x + (texel.y & 1), 2 * texel.y + (texel.x & 1));
	if (level == 1)
	{
		return nookInside(there);
	}
	int before = level - 1;
	return ivec2(min(there.x, max((nook.last.x + 1) >> before, 1) - 1), min(there.y, max((nook.last.y + 1) >> before, 1) - 1));
}

// The pass that makes a texel of level NOOK_LEVEL + 1 from the level before.
float nookCoarser(ivec2 texel)
{
	ivec2 there = nookFinerTexel(texel, NOOK_LEVEL + 1);
	if (NOOK_LEVEL == 0)
	{
		return nookDepth(there);
	}
	return nookLevel(there, NOOK_LEVEL - 1).x;
}

// The level for samples that are `distance` pixels away, 0 for the picture itself: one more with every doubling beyond 2^3, the
// paper's q'. A texel is at most an eighth of the distance.
int nookLevelFor(float distance)
{
	return clamp(int(floor(log2(max(distance, 1.0f)))) - 3, 0, NOOK_LEVELS);
}

// The texel of a level, 1 or more, in which a pixel lies; of a picture's last columns and rows, the nearest one.
ivec2 nookTexelOf(ivec2 pixel, int level)
{
	return ivec2(min(pixel.x >> level, max((nook.last.x + 1) >> level, 1) - 1),
				 min(pixel.y >> level, max((nook.last.y + 1) >> level, 1) - 1));
}

// A pixel's depth at a level, 0 or more.
float nookDepthAt(ivec2 pixel, int level)
{
	if (level == 0)
	{
		return nookDepth(pixel);
	}
	return nookLevel(nookTexelOf(pixel, level), level - 1).x;
}

// The pixel of which that is the depth.
ivec2 nookPixelAt(ivec2 pixel, int level)
{
	if (level == 0)
	{
		return pixel;
	}
	ivec2 there = nookTexelOf(pixel, level);
	for (int i = level; i > 0; --i)
	{
		there = nookFinerTexel(there, i);
	}
	return there;
}
