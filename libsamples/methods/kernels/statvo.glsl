// SPDX-License-Identifier: MIT
// Statistical volumetric obscurance: how much of a box over a pixel the mean height of its neighbours fills, layer by layer.
// This work is based on: Q. Hendrickx, L. Scandolo, M. Eisemann, E. Eisemann, "Adaptively Layered Statistical Volumetric
// Obscurance", HPG 2015 (SVO).
//
// Passes, and the meaning of the members of the block: statvo_tables.glsl.

// Entry of one table minus those of up to two others, -1 for none: the sums of a layer that has no table of its own (SVO 7.2).
uvec4 nookStatEntry(int x, int y, ivec3 which)
{
	uvec4 entry = nookTable(ivec2(x, y), which.x);
	if (which.y >= 0)
	{
		entry = entry - nookTable(ivec2(x, y), which.y);
	}
	if (which.z >= 0)
	{
		entry = entry - nookTable(ivec2(x, y), which.z);
	}
	return entry;
}

// Sum over a rectangle of whole cells.
vec4 nookStatBetween(int x0, int y0, int x1, int y1, ivec3 which)
{
	uvec4 sum = nookStatEntry(x1, y1, which) - nookStatEntry(x0, y1, which) - nookStatEntry(x1, y0, which) +
				nookStatEntry(x0, y0, which);
	return vec4(float(sum.x), float(sum.y), float(sum.z), float(sum.w));
}

// Sum over whole rows, and over columns from x.x to x.z minus the share cut.x of the first one and plus the share cut.y of the
// column after the last. x.y and x.w are the ends of these two columns.
vec4 nookStatRows(ivec4 x, int y0, int y1, vec2 cut, ivec3 which)
{
	return nookStatBetween(x.x, y0, x.z, y1, which) - cut.x * nookStatBetween(x.x, y0, x.y, y1, which) +
		   cut.y * nookStatBetween(x.z, y0, x.w, y1, which);
}

// Sum over a rectangle (left, upper, right, lower), in fractions of cells. Tables are interpolated linearly between entries
// (SVO 7.1): the cells cut at the four sides are added by their shares, from exact sums.
vec4 nookStatSum(vec4 box, ivec3 which)
{
	ivec4 whole = ivec4(int(floor(box.x)), int(floor(box.y)), int(floor(box.z)), int(floor(box.w)));
#if NOOK_TABLE_CELL == 1
	return nookStatBetween(whole.x, whole.y, whole.z, whole.w, which);
#else
	ivec2 size = nookStatSize();
	ivec2 last = ivec2((size.x + NOOK_TABLE_CELL - 1) / NOOK_TABLE_CELL, (size.y + NOOK_TABLE_CELL - 1) / NOOK_TABLE_CELL);
	ivec4 x = ivec4(whole.x, min(whole.x + 1, last.x), whole.z, min(whole.z + 1, last.x));
	ivec4 y = ivec4(whole.y, min(whole.y + 1, last.y), whole.w, min(whole.w + 1, last.y));
	vec2 cut = vec2(box.x - float(whole.x), box.z - float(whole.z));
	return nookStatRows(x, y.x, y.z, cut, which) - (box.y - float(whole.y)) * nookStatRows(x, y.x, y.y, cut, which) +
		   (box.w - float(whole.w)) * nookStatRows(x, y.z, y.w, cut, which);
#endif
}

// One layer (SVO eqs. 4, 6, 7 and psi): n * StatVO_i, and how many of its n pixels are left out of eq. 5, because they are so
// far in front of the box that they say nothing of what is in it. They fade out where psi has fallen to 0. `fill` turns a mean
// minus `centre` into the filled share: n / h of eq. 7 for x, y and depth in steps, and the share that is filled at height 0.
vec2 nookStatLayer(vec4 sum, vec3 centre, vec4 fill)
{
	vec3 mean = vec3(sum.x, sum.y, sum.z) / max(sum.w, 1e-3f);
	float t = dot(mean - centre, vec3(fill.x, fill.y, fill.z)) + fill.w;
	float over = max(t - 1.0f, 0.0f) * nook.slope;
	return sum.w * vec2(clamp(t, 0.0f, 1.0f) * max(1.0f - over, 0.0f), clamp(over - 1.0f, 0.0f, 1.0f));
}

// Share of the box that is filled by the pixels in one rectangle of cells, which has `area` pixels; 0 where it has none. Pixels
// in no table are open, and so is everything behind the box. `ends`: the uniform layers that contain the near and the far end
// of the box; layered = 0: all layers as one.
float nookStatFilled(vec4 box, float area, vec3 centre, vec4 fill, vec2 ends, int layered)
{
	vec2 sum = vec2(0.0f, 0.0f);
	if (layered == 0)
	{
		sum = nookStatLayer(nookStatSum(box, ivec3((NOOK_LAYERS - 1) * NOOK_UNIFORM_LAYERS, -1, -1)), centre, fill);
	}
	else
	{
#if NOOK_UNIFORM_LAYERS
		int first = int(ends.x);
		int last = int(ends.y);
		if (first > 0)
		{
			sum.y = nookStatSum(box, ivec3(first - 1, -1, -1)).w;
		}
		for (int i = first; i <= last; ++i)
		{
			sum += nookStatLayer(nookStatSum(box, ivec3(i, i - 1, -1)), centre, fill);
		}
#elif NOOK_LAYERS == 2
		sum = nookStatLayer(nookStatSum(box, ivec3(1, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(0, 1, -1)), centre, fill);
#elif NOOK_LAYERS == 4
		// SVO algorithm 2: A2,0; A2,1 = A1,0 - A2,0; A2,2; A2,3 = A0 - A1,0 - A2,2
		sum = nookStatLayer(nookStatSum(box, ivec3(2, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(1, 2, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(3, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(0, 1, 3)), centre, fill);
#endif
	}
	return sum.x / max(area - sum.y, 1e-3f); // eq. 5
}

// An edge in pixels, converted to cells; the last cell may have fewer pixels than the others.
float nookStatEdge(float edge, int size)
{
	int side = NOOK_TABLE_CELL;
	float full = float(size - size % side);
	if (edge > full)
	{
		return full / float(side) + (edge - full) / float(size % side);
	}
	return edge / float(side);
}

// Edges of a rectangle in pixels, converted to cells.
vec4 nookStatCellsOf(vec4 edges)
{
	ivec2 size = nookStatSize();
	return vec4(nookStatEdge(edges.x, size.x), nookStatEdge(edges.y, size.y), nookStatEdge(edges.z, size.x),
				nookStatEdge(edges.w, size.y));
}

// Area of a rectangle.
float nookStatArea(vec4 edges)
{
	return (edges.z - edges.x) * (edges.w - edges.y);
}

// The filled share for the whole rectangle, or the mean of those of its non-empty quadrants (SVO 6), which need nine look-ups
// per table instead of four where equal ones are shared. Edges and middle are in pixels.
float nookStatAll(vec4 edges, vec2 middle, vec3 centre, vec4 fill, vec2 ends, int layered)
{
#if NOOK_QUADRANTS
	vec4 whole = nookStatCellsOf(edges);
	vec4 half_way = nookStatCellsOf(vec4(middle.x, middle.y, middle.x, middle.y));
	vec4 areas = vec4(nookStatArea(vec4(edges.x, edges.y, middle.x, middle.y)),
					  nookStatArea(vec4(middle.x, edges.y, edges.z, middle.y)),
					  nookStatArea(vec4(edges.x, middle.y, middle.x, edges.w)),
					  nookStatArea(vec4(middle.x, middle.y, edges.z, edges.w)));
	vec4 filled = vec4(
		nookStatFilled(vec4(whole.x, whole.y, half_way.x, half_way.y), areas.x, centre, fill, ends, layered),
		nookStatFilled(vec4(half_way.x, whole.y, whole.z, half_way.y), areas.y, centre, fill, ends, layered),
		nookStatFilled(vec4(whole.x, half_way.y, half_way.x, whole.w), areas.z, centre, fill, ends, layered),
		nookStatFilled(vec4(half_way.x, half_way.y, whole.z, whole.w), areas.w, centre, fill, ends, layered));
	vec4 there = vec4(areas.x > 1e-3f ? 1.0f : 0.0f, areas.y > 1e-3f ? 1.0f : 0.0f, areas.z > 1e-3f ? 1.0f : 0.0f,
					  areas.w > 1e-3f ? 1.0f : 0.0f);
	return dot(filled, there) / max(dot(there, vec4(1.0f, 1.0f, 1.0f, 1.0f)), 1.0f);
#else
	return nookStatFilled(nookStatCellsOf(edges), nookStatArea(edges), centre, fill, ends, layered);
#endif
}

// Does a pixel need layers: 1 yes; 0 no, all layers as one give the same result. `at` counts from the first pixel that holds
// depth.
int nookStatLayered(ivec2 at)
{
#if NOOK_LAYERS == 1
	return 0;
#elif NOOK_SKIP
	return nookLevel(ivec2(at.x / 8, at.y / 8), 0).x > 0.5f ? 1 : 0;
#else
	return 1;
#endif
}

// The uniform layers whose mean can have an effect: those of the box, and those in front of it until they are left out of eq.
// 5. They are limited to the existing layers as floats, because where all depths are alike the number of layers in a box
// exceeds every integer.
vec2 nookStatEnds(float depth, vec3 n)
{
	vec4 least = nookRange(0);
	float radius = nookStatRadius(depth);
	float height = nook.box_height * radius;
	float over = height * (1.0f + 2.0f / nook.slope);
	float aside = 0.0f;
#if NOOK_USE_NORMAL
	aside = 1.4143f * radius * sqrt(max(1.0f - n.z * n.z, 0.0f));
#endif
	float layers = float(NOOK_LAYERS) / (nookRange(1).z * least.w);
	vec2 last = vec2(float(NOOK_LAYERS - 1), float(NOOK_LAYERS - 1));
	return clamp(vec2((depth - over - aside - least.z) * layers, (depth + height + aside - least.z) * layers), vec2(0.0f, 0.0f),
				 last);
}

// Visibility of a pixel, 1 - StatVO. With the normal, the box stands on the tangent plane (SVO 6). Without it, the box is
// aligned with the view direction and extends as far behind the pixel as in front of it (SVO 3), so that an open surface across
// the view reads 1/2.
float nookStatVo(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (nookStatKept(depth) == 0)
	{
		return 1.0f;
	}
	vec4 least = nookRange(0);
	vec4 step = nookRange(1);
	vec3 place = nookStatPlace(pixel, depth);
	vec3 centre = vec3((place.x - least.x) / step.x, (place.y - least.y) / step.y, (place.z - least.z) / step.z);
	float radius = nookStatRadius(depth);
	float height = nook.box_height * radius;
	vec3 n = vec3(0.0f, 0.0f, 0.5f);
	float ground = 0.5f;
#if NOOK_USE_NORMAL
	n = nookNormal(pixel);
	ground = 0.0f;
#endif
	vec4 fill = vec4(step.x * n.x / height, step.y * n.y / height, -step.z * n.z / height, ground);

	ivec2 at = ivec2(pixel.x - nook.first.x, pixel.y - nook.first.y);
	int layered = nookStatLayered(at);
	vec2 ends = nookStatEnds(depth, n);

	vec2 box = nookStatBox(depth);
	float fade = clamp(max(box.x, box.y) / nook.least_box_px - 1.0f, 0.0f, 1.0f); // fades to open before the box is too small for the tables
	vec2 middle = vec2(float(at.x) + 0.5f, float(at.y) + 0.5f);
	vec4 edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x, middle.y + box.y);
#if NOOK_TABLE_CELL == 1
	middle = vec2(float(at.x), float(at.y));
	box = floor(box + vec2(0.5f, 0.5f));
	edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x + 1.0f, middle.y + box.y + 1.0f);
#endif
	vec2 size = vec2(nookStatSize());
	edges = clamp(edges, vec4(0.0f, 0.0f, 0.0f, 0.0f), vec4(size.x, size.y, size.x, size.y));
	// Two branches, so that the look-ups of each have no further branches.
	float filled = 0.0f;
	if (layered == 0)
	{
		filled = nookStatAll(edges, middle, centre, fill, ends, 0);
	}
	else
	{
		filled = nookStatAll(edges, middle, centre, fill, ends, 1);
	}
	float open = 1.0f - filled * fade;
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
