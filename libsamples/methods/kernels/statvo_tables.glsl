// SPDX-License-Identifier: MIT
// The tables of statistical volumetric obscurance: sums of positions, as integers, of all pixels and of layers of them.
// This work is based on: Q. Hendrickx, L. Scandolo, M. Eisemann, E. Eisemann, "Adaptively Layered Statistical Volumetric
// Obscurance", HPG 2015 (SVO).
//
// Passes, in order: nookStatRange, nookStatRangeUp and nookStatFrame (the range that the tables span); for each table
// nookStatCells and its sums (tables.glsl); where layers are skipped nookStatSlopes, nookStatSlopesUp, nookStatFlags; and
// nookStatVo.
// nook.box_height is in radii, nook.slope is that of psi; nook.largest_px and nook.least_box_px are half sides of a rectangle,
// and NOOK_TABLE_CELL is the side of a cell of a table, in pixels. NOOK_TABLE: the table that a pass makes. With NOOK_SKIP,
// layers are skipped where a surface is smooth.
// Tables hold view-space x, y and depth in integer steps of the range in the picture, and the number of pixels. Sky is in none
// of them, nor are pixels so far away that their box would be smaller than the least: the steps would be too coarse, and all of
// that is open.

// Half side of the box in metres, limited to nook.largest_px pixels in the picture.
float nookStatRadius(float depth)
{
	vec2 scale = nookScale(depth);
	return min(nookRadius(nook.radius, depth), nook.largest_px / max(abs(scale.x), abs(scale.y)));
}

// Half sides of the box in pixels.
vec2 nookStatBox(float depth)
{
	vec2 scale = nookScale(depth);
	float radius = nookStatRadius(depth);
	return vec2(abs(scale.x) * radius, abs(scale.y) * radius);
}

// Number of pixels that hold depth, on each side. Cells and tiles are counted from nook.first.
ivec2 nookStatSize()
{
	return ivec2(nook.last.x - nook.first.x + 1, nook.last.y - nook.first.y + 1);
}

// Does a pixel, at nook.first or after it, hold depth?
bool nookStatHolds(ivec2 pixel)
{
	return pixel.x <= nook.last.x && pixel.y <= nook.last.y;
}

// Is the surface of a pixel in the tables: 1 yes, 0 no.
int nookStatKept(float depth)
{
	if (depth >= NOOK_SKY)
	{
		return 0;
	}
	vec2 box = nookStatBox(depth);
	return max(box.x, box.y) < nook.least_box_px ? 0 : 1;
}

// The position that the tables hold for a pixel: view-space x and y, and depth, in metres.
vec3 nookStatPlace(ivec2 pixel, float depth)
{
	vec3 p = nookPosition(pixel, depth);
	return vec3(p.x, p.y, depth);
}

// For 8 x 8 pixels: the smallest x, y and depth in texel (2i, j), and the smallest negated ones in texel (2i + 1, j).
vec4 nookStatRange(ivec2 texel)
{
	float side = texel.x % 2 == 0 ? 1.0f : -1.0f;
	vec3 least = vec3(NOOK_SKY, NOOK_SKY, NOOK_SKY);
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pixel = ivec2(nook.first.x + (texel.x / 2) * 8 + i % 8, nook.first.y + texel.y * 8 + i / 8);
		if (nookStatHolds(pixel))
		{
			float depth = nookDepth(pixel);
			if (nookStatKept(depth) != 0)
			{
				least = min(least, nookStatPlace(pixel, depth) * side);
			}
		}
	}
	return vec4(least.x, least.y, least.z, 0.0f);
}

// Does the same for 8 x 8 of these pairs, of which there are NOOK_RANGE_WIDTH x NOOK_RANGE_HEIGHT.
vec4 nookStatRangeUp(ivec2 texel)
{
	vec4 least = vec4(NOOK_SKY, NOOK_SKY, NOOK_SKY, 0.0f);
	for (int i = 0; i < 64; ++i)
	{
		ivec2 pair = ivec2((texel.x / 2) * 8 + i % 8, texel.y * 8 + i / 8);
		if (pair.x < NOOK_RANGE_WIDTH && pair.y < NOOK_RANGE_HEIGHT)
		{
			least = min(least, nookLevel(ivec2(pair.x * 2 + texel.x % 2, pair.y), 0));
		}
	}
	return least;
}

// The range in the form that later passes read. Texel 0: the smallest x, y and depth in the tables, and the number of steps
// that each range is divided into. Texel 1: the length of a step along each; ranges are at least a millionth of the radius.
// The number of steps is so small that the sum over the largest rectangle, that of the nearest pixel, stays below 2^32, and at
// most what a 32-bit float holds with two bits to spare.
vec4 nookStatFrame(ivec2 texel)
{
	vec4 least = nookLevel(ivec2(0, 0), 0);
	vec4 greatest = nookLevel(ivec2(1, 0), 0);
	vec2 box = vec2(0.0f, 0.0f);
	if (least.z < NOOK_SKY) // otherwise the tables stay empty
	{
		box = nookStatBox(least.z);
	}
	int more = 2 * NOOK_TABLE_CELL;
	int area = (2 * int(box.x + 0.5f) + more) * (2 * int(box.y + 0.5f) + more);
	float steps = float(min(4294967295u / uint(area), 4194304u));
	if (texel.x == 0)
	{
		return vec4(least.x, least.y, least.z, steps);
	}
	float smallest = 1e-6f * nook.radius;
	return vec4(max(-greatest.x - least.x, smallest), max(-greatest.y - least.y, smallest), max(-greatest.z - least.z, smallest),
				0.0f) / steps;
}

// The position of a pixel in steps, and 1; zeros for a pixel in no table.
uvec4 nookStatPoint(ivec2 pixel)
{
	if (!nookStatHolds(pixel))
	{
		return uvec4(0u, 0u, 0u, 0u);
	}
	float depth = nookDepth(pixel);
	if (nookStatKept(depth) == 0)
	{
		return uvec4(0u, 0u, 0u, 0u);
	}
	vec4 least = nookRange(0);
	vec4 step = nookRange(1);
	vec3 place = nookStatPlace(pixel, depth);
	return uvec4(uint(clamp((place.x - least.x) / step.x, 0.0f, least.w) + 0.5f),
				 uint(clamp((place.y - least.y) / step.y, 0.0f, least.w) + 0.5f),
				 uint(clamp((place.z - least.z) / step.z, 0.0f, least.w) + 0.5f), 1u);
}

// The cells around one whose depth is a mean of depths, about as far as the box at that depth extends: left, upper, right,
// lower.
ivec4 nookStatAround(ivec2 cell, float depth)
{
	vec2 box = nookStatBox(depth);
	int side = NOOK_TABLE_CELL;
	int x = int(box.x / float(side) + 0.5f);
	int y = int(box.y / float(side) + 0.5f);
	ivec2 size = nookStatSize();
	return ivec4(max(cell.x - x, 0), max(cell.y - y, 0), min(cell.x + x + 1, (size.x + side - 1) / side),
				 min(cell.y + y + 1, (size.y + side - 1) / side));
}

// For a cell with the given sum over all its pixels: the sum over those in table NOOK_TABLE, 1 or more, of adaptive layers.
uvec4 nookStatNearer(ivec2 cell, uvec4 sum)
{
	int side = NOOK_TABLE_CELL;
	float depth = nookRange(0).z + nookRange(1).z * (float(sum.z) / float(sum.w));
	ivec4 around = nookStatAround(cell, depth);
	uvec4 all = nookTableBox(around, 0);
	uvec4 near = uvec4(0u, 0u, 0u, 0u);
	if (NOOK_TABLE > 1)
	{
		near = nookTableBox(around, 1);
	}
	sum = uvec4(0u, 0u, 0u, 0u);
	for (int i = 0; i < side * side; ++i)
	{
		uvec4 point = nookStatPoint(ivec2(nook.first.x + cell.x * side + i % side, nook.first.y + cell.y * side + i / side));
		bool nearer = point.z * all.w < all.z;
		bool mine = nearer;
		if (NOOK_TABLE == 2)
		{
			mine = nearer && point.z * near.w < near.z;
		}
		if (NOOK_TABLE == 3)
		{
			mine = !nearer && point.z * (all.w - near.w) < all.z - near.z;
		}
		if (mine)
		{
			sum += point;
		}
	}
	return sum;
}

// A cell of a table before summing: the sum over its pixels that belong to the table (SVO 5, 7 and algorithm 1). Entries (0, y)
// and (x, 0) are 0.
// Adaptive layers: table 0 has all pixels; table 1 those nearer than the mean depth around them; table 2 those of table 1 that
// are nearer than the mean of table 1; table 3 those of the others that are nearer than the mean of the others. The remaining
// layers are differences. The comparison is exact, in integers: depth * n < sum.
// Uniform layers: table i has the layers 0 to i, the nearest first, so that single layers are differences.
uvec4 nookStatCells(ivec2 texel)
{
	uvec4 sum = uvec4(0u, 0u, 0u, 0u);
	if (texel.x == 0 || texel.y == 0)
	{
		return sum;
	}
	int side = NOOK_TABLE_CELL;
	ivec2 cell = ivec2(texel.x - 1, texel.y - 1);
	for (int i = 0; i < side * side; ++i)
	{
		uvec4 point = nookStatPoint(ivec2(nook.first.x + cell.x * side + i % side, nook.first.y + cell.y * side + i / side));
#if NOOK_UNIFORM_LAYERS
		if ((point.z * uint(NOOK_LAYERS)) / (uint(nookRange(0).w) + 1u) > uint(NOOK_TABLE))
		{
			point = uvec4(0u, 0u, 0u, 0u);
		}
#endif
		sum += point;
	}
#if !NOOK_UNIFORM_LAYERS
	if (NOOK_TABLE > 0 && sum.w > 0u)
	{
		sum = nookStatNearer(cell, sum);
	}
#endif
	return sum;
}
