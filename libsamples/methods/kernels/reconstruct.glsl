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

// How far, as a share of the radius, two positions are from the tangent plane that they share: the plane between the two normals
// holds both ends of any arc of a circle, so that columns are as smooth as walls. Unlike a difference of depths it is 0 along a plane
// at any slope; and visibility can change by no more than about its size.
float nookApartFrom(vec3 centre, vec3 n, vec3 there, vec3 n_there)
{
	return abs(dot(n + n_there, there - centre)) / (2.0f * nook.radius);
}

// Of a pixel's position from a pixel; NOOK_SKY for sky.
float nookApart(vec3 centre, vec3 n, ivec2 there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return nookApartFrom(centre, n, nookPosition(there, depth), nookNormal(there));
}

// Do two show the same surface: 1 yes, 0 no. Flat at both ends, so that on a smooth surface all pixels count alike, which is what
// makes the mean of a window of variants exact. Chosen by eye on builtin:courtyard, not swept.
float nookAlikeOf(float apart, vec3 n, vec3 n_there)
{
	float beside = clamp(2.0f - apart * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, n_there) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}
float nookAlike(vec3 centre, vec3 n, ivec2 there)
{
	return nookAlikeOf(nookApart(centre, n, there), n, nookNormal(there));
}

// What the bilateral filter reads of a cell, all in one texel: visibility, and whether the next cell along x and the next one along y
// show the same surface. 8 bits each are enough.
vec4 nookLinked(ivec2 cell, float visibility)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	float open = 1.0f;
	float along_x = 0.0f;
	float along_y = 0.0f;
	if (depth < NOOK_SKY)
	{
		open = visibility;
		vec3 n = nookNormal(pixel);
		vec3 centre = nookPosition(pixel, depth);
		ivec2 last = nookLastCell();
		if (cell.x < last.x)
		{
			along_x = nookAlike(centre, n, nookPixel(ivec2(cell.x + 1, cell.y)));
		}
		if (cell.y < last.y)
		{
			along_y = nookAlike(centre, n, nookPixel(ivec2(cell.x, cell.y + 1)));
		}
	}
	return vec4(open, along_x, along_y, 1.0f);
}

// The mean over NOOK_TAPS cells to either side of a cell, along x (axis 1, 0) or y (0, 1). A cell counts as far as all cells up to it
// show the same surface.
float nookMeanAlong(ivec2 cell, ivec2 axis)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	vec4 own = nookPacked(cell);
	float width = 0.5f * float(NOOK_TAPS + 1);
	float link_x = float(axis.x);
	float link_y = float(axis.y);
	float sum = own.x;
	float weights = 1.0f;
	float before = 1.0f;
	float after = link_x * own.y + link_y * own.z;
	for (int i = 1; i <= NOOK_TAPS; ++i)
	{
		float falls = exp(-0.5f * float(i * i) / (width * width));
		ivec2 there = ivec2(cell.x - i * axis.x, cell.y - i * axis.y);
		if (there.x < first.x || there.y < first.y)
		{
			before = 0.0f;
		}
		vec4 one = nookPacked(ivec2(max(there.x, first.x), max(there.y, first.y)));
		before *= link_x * one.y + link_y * one.z;
		vec4 other = nookPacked(ivec2(min(cell.x + i * axis.x, last.x), min(cell.y + i * axis.y, last.y)));
		sum += falls * (before * one.x + after * other.x);
		weights += falls * (before + after);
		after *= link_x * other.y + link_y * other.z;
	}
	return sum / weights;
}

// The two passes, in this order.
vec4 nookBilateralX(ivec2 cell)
{
	vec4 own = nookPacked(cell);
	return vec4(nookMeanAlong(cell, ivec2(1, 0)), own.y, own.z, 1.0f);
}
float nookBilateralY(ivec2 cell)
{
	float open = nookMeanAlong(cell, ivec2(0, 1));
#if NOOK_SHAPED
	open = nookShaped(open);
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
	int down = nook.across_y.x < 0.0f ? -1 : 1; // as nookRow counts
	float sum = nookVisibility(cell);
	float weights = 1.0f;
	for (int y = first; y < first + NOOK_WINDOW; ++y)
	{
		for (int x = first; x < first + NOOK_WINDOW; ++x)
		{
			ivec2 there = ivec2(cell.x + x, cell.y + down * y);
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

// A unit vector as two numbers and back: on the octahedron |x| + |y| + |z| = 1, whose lower half is folded outward.
vec2 nookFolded(vec3 n)
{
	float size = max(abs(n.x) + abs(n.y) + abs(n.z), 1e-20f); // sky has no normal
	float x = n.x / size;
	float y = n.y / size;
	if (n.z < 0.0f)
	{
		return vec2((1.0f - abs(y)) * (x < 0.0f ? -1.0f : 1.0f), (1.0f - abs(x)) * (y < 0.0f ? -1.0f : 1.0f));
	}
	return vec2(x, y);
}
vec3 nookUnfolded(vec2 folded)
{
	float below = max(abs(folded.x) + abs(folded.y) - 1.0f, 0.0f);
	float x = folded.x - (folded.x < 0.0f ? -below : below);
	float y = folded.y - (folded.y < 0.0f ? -below : below);
	vec3 n = vec3(x, y, 1.0f - abs(folded.x) - abs(folded.y));
	return n / sqrt(dot(n, n));
}

// What upsampling reads of a cell, all in one texel of 32-bit floats: visibility, depth, normal.
vec4 nookOfSurface(ivec2 cell, float visibility)
{
	ivec2 pixel = nookPixel(cell);
	vec2 folded = nookFolded(nookNormal(pixel));
	return vec4(visibility, nookDepth(pixel), folded.x, folded.y);
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
		vec4 one = nookPacked(there);
		if (one.y >= NOOK_SKY)
		{
			used = 0.0f;
			one.y = depth;
		}
		vec3 n_there = nookUnfolded(vec2(one.z, one.w));
		float apart = nookApartFrom(centre, n, nookPosition(nookPixel(there), one.y), n_there);
		float weight = used * nookAlikeOf(apart, n, n_there);
		sum += weight * one.x;
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
