// SPDX-License-Identifier: MIT
// Coarser levels of depth for samples that are far away in the picture, so that neighbouring pixels share texels.
// This work is based on: M. McGuire, M. Mara, D. Luebke, "Scalable Ambient Obscurance", HPG 2012 (SAO).
//
// Level l from 1 to NOOK_LEVELS has one texel for 2^l x 2^l pixels, which holds the depth of one of them: the mean of several
// depths would be the depth of no surface. Which pixel is taken changes from texel to texel (rotated grid), so that no column
// or row is skipped altogether.

// The texel of level `level` - 1 whose depth a texel of `level` holds; for level 1 that is a pixel.
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

// A texel of level NOOK_LEVEL + 1, from the level before. nook_levels counts from 0, so it is level NOOK_LEVEL there.
float nookCoarser(ivec2 texel)
{
	ivec2 there = nookFinerTexel(texel, NOOK_LEVEL + 1);
	if (NOOK_LEVEL == 0)
	{
		return nookDepth(there);
	}
	return nookLevel(there, NOOK_LEVEL - 1).x;
}

// The level for a sample `distance` pixels away; 0 is the picture itself. Each doubling beyond 2^3 pixels, the paper's q', adds
// one, so that a texel is at most an eighth of the distance.
int nookLevelFor(float distance)
{
	return clamp(int(floor(log2(max(distance, 1.0f)))) - 3, 0, NOOK_LEVELS);
}

// The texel of a level, 1 or more, that contains a pixel; the nearest one for the last columns and rows of a picture.
ivec2 nookTexelOf(ivec2 pixel, int level)
{
	return ivec2(min(pixel.x >> level, max((nook.last.x + 1) >> level, 1) - 1),
				 min(pixel.y >> level, max((nook.last.y + 1) >> level, 1) - 1));
}

// Depth at a pixel, read from a level, 0 or more.
float nookDepthAt(ivec2 pixel, int level)
{
	if (level == 0)
	{
		return nookDepth(pixel);
	}
	return nookLevel(nookTexelOf(pixel, level), level - 1).x;
}

// The pixel whose depth nookDepthAt returned.
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
