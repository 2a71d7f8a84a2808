// SPDX-License-Identifier: MIT
// From noisy visibility to a clean picture: filters that stay on the surface of the pixel, and half resolution to full
// resolution.
// The two one-dimensional passes are after: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
//
// Visibility lies on a grid of cells. With NOOK_CELL = 1 a cell is a pixel; with 2, a cell stands for 2 x 2 pixels and was
// evaluated at their upper left one. No look-up is needed to find that pixel, and the pixels between lie midway between those
// that are known. The including file provides nookVisibility(cell) as well as nookDepth and nookNormal.

// The pixel at which a cell of visibility was evaluated.
ivec2 nookPixel(ivec2 cell)
{
	return cell * NOOK_CELL;
}

// The cell that holds a pixel of the picture. Without signs the division is a shift.
ivec2 nookCellOf(ivec2 pixel)
{
	return ivec2(int(uint(pixel.x) / uint(NOOK_CELL)), int(uint(pixel.y) / uint(NOOK_CELL)));
}

// First cell of the picture; the guard band around it is not drawn.
ivec2 nookFirstCell()
{
	return nookCellOf(ivec2(int(nook.origin.x) + NOOK_CELL - 1, int(nook.origin.y) + NOOK_CELL - 1));
}

// Last cell of the picture.
ivec2 nookLastCell()
{
	return nookCellOf(ivec2(int(nook.origin.x + nook.size.x) - 1, int(nook.origin.y + nook.size.y) - 1));
}

// Is a cell in the picture?
bool nookDrawn(ivec2 cell)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	return cell.x >= first.x && cell.y >= first.y && cell.x <= last.x && cell.y <= last.y;
}

// Distance of two positions from a common tangent plane, as a share of the radius. The plane lies midway between the two
// normals, so it contains both ends of any circular arc and columns count as smooth as walls. Unlike a difference of depths,
// the distance is 0 along a plane at any slope. Visibility cannot change by much more than it.
float nookApartFrom(vec3 centre, vec3 n, vec3 there, vec3 n_there)
{
	return abs(dot(n + n_there, there - centre)) / (2.0f * nook.radius);
}

// nookApartFrom for the surface of another pixel; NOOK_SKY where that is sky.
float nookApart(vec3 centre, vec3 n, ivec2 there, vec3 n_there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return nookApartFrom(centre, n, nookPosition(there, depth), n_there);
}

// Do two pixels show the same surface: 1 yes, 0 no, with a ramp between. The ramp is flat at both ends, so that all pixels of a
// smooth surface have the same weight and the mean over a window of variants is exact. The thresholds were chosen by eye.
float nookAlikeOf(float apart, vec3 n, vec3 n_there)
{
	float beside = clamp(2.0f - apart * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, n_there) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

// nookAlikeOf for the surface of a pixel, with the normal n and the line of sight `sight`, and a surface at depth `there`, `across`
// pixels away; 0 where that is sky.
float nookAlikeThere(vec3 sight, float depth, vec3 n, vec2 across, float there, vec3 n_there)
{
	vec2 texel = nookTexel();
	vec3 both = n + n_there;
	float w = nook.w_slope * there + nook.w_start;
	float apart = w * (both.x * (texel.x * across.x) + both.y * (texel.y * across.y)) - dot(both, sight) * (there - depth);
	float alike = nookAlikeOf(abs(apart) / (2.0f * nook.radius), n, n_there);
	return there < NOOK_SKY ? alike : 0.0f;
}

// nookAlikeThere for the pixel `there`.
float nookAlike(vec3 sight, float depth, vec3 n, ivec2 there, vec2 across)
{
	return nookAlikeThere(sight, depth, n, across, nookDepth(there), nookNormal(there));
}

// Everything that the bilateral filter reads of a cell, in one texel: visibility, and whether the next cell along x and the
// next one along y show the same surface. 8 bits per channel are enough.
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
		vec3 sight = nookSight(pixel);
		ivec2 last = nookLastCell();
		ivec2 right = nookPixel(ivec2(min(cell.x + 1, last.x), cell.y));
		ivec2 lower = nookPixel(ivec2(cell.x, min(cell.y + 1, last.y)));
		along_x = nookAlike(sight, depth, n, right, vec2(float(NOOK_CELL), 0.0f));
		along_y = nookAlike(sight, depth, n, lower, vec2(0.0f, float(NOOK_CELL)));
		along_x = cell.x < last.x ? along_x : 0.0f;
		along_y = cell.y < last.y ? along_y : 0.0f;
	}
	return vec4(open, along_x, along_y, 1.0f);
}

// The values of a cell that the filter takes the mean of: visibility, or a mean of open directions and visibility.
vec4 nookFiltered(ivec2 cell)
{
#if NOOK_BENT
	return nookLevel(cell, 0);
#else
	return nookPacked(cell);
#endif
}

// A cell, moved along an axis (1, 0 or 0, 1) to another column or row.
ivec2 nookMovedTo(ivec2 cell, ivec2 axis, int place)
{
	return ivec2(axis.x > 0 ? place : cell.x, axis.y > 0 ? place : cell.y);
}

// Mean over NOOK_TAPS cells on either side of a cell, along x (axis 1, 0) or y (axis 0, 1). A cell has weight only as far as
// all cells between show the same surface. The outermost ones count half, so that on one surface all cells of a window of
// 2 NOOK_TAPS have the same weight, and patterns that repeat with the window vanish.
vec4 nookMeanAlong(ivec2 cell, ivec2 axis)
{
	ivec2 first_cell = nookFirstCell();
	ivec2 last_cell = nookLastCell();
	int first = axis.x > 0 ? first_cell.x : first_cell.y;
	int last = axis.x > 0 ? last_cell.x : last_cell.y;
	int own = axis.x > 0 ? cell.x : cell.y;
	vec4 links = nookPacked(cell);
	vec4 sum = nookFiltered(cell);
	float weights = 1.0f;
	float before = 1.0f;
	float after = axis.x > 0 ? links.y : links.z;
	for (int i = 1; i <= NOOK_TAPS; ++i)
	{
		float falls = i < NOOK_TAPS ? 1.0f : 0.5f;
		ivec2 one = nookMovedTo(cell, axis, max(own - i, first));
		ivec2 other = nookMovedTo(cell, axis, min(own + i, last));
		links = nookPacked(one);
		before *= own - i < first ? 0.0f : axis.x > 0 ? links.y : links.z;
		sum = sum + nookFiltered(one) * (falls * before) + nookFiltered(other) * (falls * after);
		weights += falls * before + falls * after;
		links = nookPacked(other);
		after *= axis.x > 0 ? links.y : links.z;
	}
	return sum / weights;
}

// First pass of the bilateral filter.
vec4 nookBilateralX(ivec2 cell)
{
	vec4 own = nookPacked(cell);
	return vec4(nookMeanAlong(cell, ivec2(1, 0)).x, own.y, own.z, 1.0f);
}

// Second pass of the bilateral filter.
float nookBilateralY(ivec2 cell)
{
	float open = nookMeanAlong(cell, ivec2(0, 1)).x;
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}

// Mean over the window of the tile, which holds every variant of the samples once. All cells that show the same surface have
// the same weight.
float nookWindow(ivec2 cell)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 sight = nookSight(pixel);
	int first = -((NOOK_WINDOW - 1) / 2);
	int down = nook.across_y.x < 0.0f ? -1 : 1; // rows count as in nookRow
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
				vec2 across = vec2(float(NOOK_CELL * x), float(NOOK_CELL * down * y));
				float weight = nookAlike(sight, depth, n, nookPixel(there), across);
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

// A unit vector as two numbers: its stereographic projection from (0, 0, -1), the direction of surfaces that face away.
vec2 nookFlattened(vec3 n)
{
	return n.z < -0.9999f ? vec2(1e4f, 0.0f) : vec2(n.x / (1.0f + n.z), n.y / (1.0f + n.z));
}

// The unit vector that nookFlattened stored.
vec3 nookUnflattened(vec2 at)
{
	float size = 2.0f / (1.0f + dot(at, at));
	return vec3(at.x * size, at.y * size, size - 1.0f);
}

// Everything that upsampling reads of a cell, in one texel of 32-bit floats: visibility, depth, and the normal as
// nookFlattened stores it.
vec4 nookOfSurface(ivec2 cell, float visibility)
{
	ivec2 pixel = nookPixel(cell);
	vec2 normal = nookFlattened(nookNormal(pixel));
	return vec4(visibility, nookDepth(pixel), normal.x, normal.y);
}

// Visibility of a pixel at full resolution, from cells of 2 x 2 pixels: the mean of the one, two or four cells around it that
// show its surface. Returns -1 where none does, for a pass that evaluates these pixels by themselves. They are thin objects and
// edges, about 4 % of a picture; taking the nearest cell there instead would nearly double the difference to full resolution.
float nookUpsample(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 sight = nookSight(pixel);
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	ivec2 cell = nookCellOf(pixel);
	float sum = 0.0f;
	float weights = 0.0f;
	int corners = NOOK_CELL * NOOK_CELL;
	for (int i = 0; i < corners; ++i)
	{
		int x = i % NOOK_CELL;
		int y = i / NOOK_CELL;
		ivec2 there = ivec2(clamp(cell.x + x, first.x, last.x), clamp(cell.y + y, first.y, last.y));
		vec4 one = nookPacked(there);
		ivec2 at = nookPixel(there);
		vec2 across = vec2(float(at.x - pixel.x), float(at.y - pixel.y));
		float weight = nookAlikeThere(sight, depth, n, across, one.y, nookUnflattened(vec2(one.z, one.w)));
		weight = x <= pixel.x - NOOK_CELL * cell.x && y <= pixel.y - NOOK_CELL * cell.y ? weight : 0.0f;
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

// A pixel or cell itself (0), its neighbours along x (1, 2) and along y (3, 4).
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

// Visibility for one of several samples of a pixel (MSAA), given by its view-space position and its normal n: the mean over
// those of five pixels in a cross that show the surface of the sample (ALC 3.3), so that edges get no halo from what lies
// before or behind them. Where none of the five does, the one nearest to the tangent plane of the sample has the most weight.
// The four neighbours together weigh as much as the pixel itself; anything from a fifth of that to four times as much was
// equally good.
float nookGather(ivec2 pixel, vec3 position, vec3 n)
{
	float sum = 0.0f;
	float weights = 0.0f;
	for (int i = 0; i < 5; ++i)
	{
		ivec2 there = nookOfCross(pixel, i);
		if (nookDrawn(there))
		{
			vec3 n_there = nookNormal(there);
			float apart = nookApart(position, n, there, n_there);
			float weight = 1e-4f / (1.0f + 20.0f * apart);
			weight += (i == 0 ? 1.0f : 0.25f) * nookAlikeOf(apart, n, n_there);
			sum += weight * nookVisibility(there);
			weights += weight;
		}
	}
	return sum / weights;
}
