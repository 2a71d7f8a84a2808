// SPDX-License-Identifier: MIT
// Noisy visibility → clean: filters that stay on the pixel's own surface, and half resolution back to full.
// The two one-dimensional passes are those of: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
//
// Visibility lies on a grid of cells: NOOK_CELL = 1, a cell is a pixel; 2, a cell stands for 2 x 2 pixels and was evaluated at
// their upper left one. That one needs no look-up, and the pixels between lie midway between those that are known. Whoever
// includes this offers nookVisibility(cell) beside nookDepth and nookNormal.

ivec2 nookPixel(ivec2 cell)
{
	return cell * NOOK_CELL;
}

// Of the picture, as far as it is drawn: a guard band is not.
ivec2 nookFirstCell()
{
	return ivec2((int(nook.origin.x) + NOOK_CELL - 1) / NOOK_CELL, (int(nook.origin.y) + NOOK_CELL - 1) / NOOK_CELL);
}
ivec2 nookLastCell()
{
	return ivec2((int(nook.origin.x + nook.size.x) - 1) / NOOK_CELL, (int(nook.origin.y + nook.size.y) - 1) / NOOK_CELL);
}
bool nookDrawn(ivec2 cell)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	return cell.x >= first.x && cell.y >= first.y && cell.x <= last.x && cell.y <= last.y;
}

// How far, as a share of the radius, a pixel's position is from the tangent plane that it shares with another one; NOOK_SKY for sky.
// The plane between the two normals: it holds both ends of any arc of a circle, so that columns are as smooth as walls. Unlike a
// difference of depths it is 0 along a plane at any slope; and visibility can change by no more than about its size.
float nookApart(vec3 centre, vec3 n, ivec2 there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return abs(dot(n + nookNormal(there), nookPosition(there, depth) - centre)) / (2.0f * nook.radius);
}

// Does a pixel show the same surface: 1 yes, 0 no. Flat at both ends, so that on a smooth surface all pixels count alike, which is
// what makes the mean of a window of variants exact. Chosen by eye on builtin:courtyard, not swept.
float nookAlike(vec3 centre, vec3 n, ivec2 there)
{
	float beside = clamp(2.0f - nookApart(centre, n, there) * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, nookNormal(there)) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

// One of two passes (NOOK_ALONG_Y = 0: along x, 1: along y) with NOOK_TAPS cells on each side of the cell.
float nookBilateral(ivec2 cell)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	float sum = nookVisibility(cell);
	float weights = 1.0f;
	float width = 0.5f * float(NOOK_TAPS + 1);
	for (int i = -NOOK_TAPS; i <= NOOK_TAPS; ++i)
	{
		ivec2 there = cell + ivec2(i * (1 - NOOK_ALONG_Y), i * NOOK_ALONG_Y);
		if (i != 0 && nookDrawn(there))
		{
			float weight = exp(-0.5f * float(i * i) / (width * width)) * nookAlike(centre, n, nookPixel(there));
			sum += weight * nookVisibility(there);
			weights += weight;
		}
	}
	float open = sum / weights;
#if NOOK_SHAPED
	if (NOOK_ALONG_Y == 1)
	{
		open = nookShaped(open);
	}
#endif
	return open;
}

// The mean over the window of the tile: every variant once. All cells that show the same surface count alike.
float nookWindow(ivec2 cell)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	int first = -((NOOK_WINDOW - 1) / 2);
	float sum = nookVisibility(cell);
	float weights = 1.0f;
	for (int y = first; y < first + NOOK_WINDOW; ++y)
	{
		for (int x = first; x < first + NOOK_WINDOW; ++x)
		{
			ivec2 there = ivec2(cell.x + x, cell.y + y);
			bool other = x != 0 || y != 0;
			if (other && nookDrawn(there))
			{
				float weight = nookAlike(centre, n, nookPixel(there));
				sum += weight * nookVisibility(there);
				weights += weight;
			}
		}
	}
	float open = sum / weights;
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}

// Full resolution from cells of 2 x 2 pixels: the mean of the one, two or four cells around a pixel that show its surface; -1 where
// none does, for a pass that evaluates these few pixels themselves (thin things and edges: 4 % of builtin:courtyard at 320 x 180,
// where the nearest cell instead would nearly double the difference to full resolution).
float nookUpsample(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	ivec2 cell = ivec2(pixel.x / NOOK_CELL, pixel.y / NOOK_CELL);
	float sum = 0.0f;
	float weights = 0.0f;
	int corners = NOOK_CELL * NOOK_CELL;
	for (int i = 0; i < corners; ++i)
	{
		int x = i % NOOK_CELL;
		int y = i / NOOK_CELL;
		float used = 0.0f;
		if (x <= pixel.x - NOOK_CELL * cell.x && y <= pixel.y - NOOK_CELL * cell.y)
		{
			used = 1.0f;
		}
		ivec2 there = ivec2(clamp(cell.x + x, first.x, last.x), clamp(cell.y + y, first.y, last.y));
		float weight = used * nookAlike(centre, n, nookPixel(there));
		sum += weight * nookVisibility(there);
		weights += weight;
	}
	if (weights < 0.5f)
	{
		return -1.0f;
	}
	float open = sum / weights;
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}

// A pixel or cell itself (0), those beside it (1, 2), and those above and under it (3, 4).
ivec2 nookOfCross(ivec2 at, int i)
{
	int to = 2 * (i % 2) - 1;
	if (i == 0)
	{
		return at;
	}
	if (i < 3)
	{
		return ivec2(at.x + to, at.y);
	}
	return ivec2(at.x, at.y + to);
}

// For a renderer with several samples a pixel (MSAA), where it shades one: visibility at its view-space position, from the five
// pixels of a cross that show its surface (ALC 3.3), so that edges get no halo of what lies before or behind them. n: its normal.
// Visibility of all pixels; where none of the five shows the sample's surface, the nearest to its tangent plane counts most.
// The four together count as much as the pixel itself; a fifth to four times that is as good (builtin levels, 320 x 180).
float nookGather(ivec2 pixel, vec3 position, vec3 n)
{
	float sum = 0.0f;
	float weights = 0.0f;
	for (int i = 0; i < 5; ++i)
	{
		ivec2 there = nookOfCross(pixel, i);
		if (nookDrawn(there))
		{
			float weight = 1e-4f / (1.0f + 20.0f * nookApart(position, n, there));
			weight += (i == 0 ? 1.0f : 0.25f) * nookAlike(position, n, there);
			sum += weight * nookVisibility(there);
			weights += weight;
		}
	}
	return sum / weights;
}
