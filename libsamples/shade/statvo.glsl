// SPDX-License-Identifier: MIT
// Statistical volumetric obscurance: how much of a box over a pixel its neighbours' mean height fills, layer by layer.
// This work is based on: Q. Hendrickx, L. Scandolo, M. Eisemann, E. Eisemann, "Adaptively Layered Statistical Volumetric Obscurance",
// HPG 2015 (SVO).
//
// Passes and the meaning of nook.statvo, nook.layers and nook.table: statvo_tables.glsl.

// Sum over a rectangle of cells (left, upper, right, lower, as parts of cells) of one table less two others, -1 for none. Between
// entries the tables are linear: what is cut off at the four sides is taken out by parts, of exact sums.
vec4 nookStatSum(vec4 box, ivec3 which)
{
	ivec4 whole = ivec4(int(floor(box.x)), int(floor(box.y)), int(floor(box.z)), int(floor(box.w)));
	vec4 sum = vec4(0.0f, 0.0f, 0.0f, 0.0f);
	int parts = 3;
	if (nook.layers.w == 1)
	{
		parts = 1;
	}
	for (int i = 0; i < parts * parts; ++i)
	{
		int x = i % parts;
		int y = i / parts;
		ivec4 part = whole;
		float share = 1.0f;
		if (x == 1)
		{
			part.z = whole.x + 1;
			share = float(whole.x) - box.x;
		}
		if (x == 2)
		{
			part.x = whole.z;
			part.z = whole.z + 1;
			share = box.z - float(whole.z);
		}
		if (y == 1)
		{
			part.w = whole.y + 1;
			share = share * (float(whole.y) - box.y);
		}
		if (y == 2)
		{
			part.y = whole.w;
			part.w = whole.w + 1;
			share = share * (box.w - float(whole.w));
		}
		if (share != 0.0f)
		{
			uvec4 counted = nookTableBox(part, which.x);
			if (which.y >= 0)
			{
				counted = counted - nookTableBox(part, which.y);
			}
			if (which.z >= 0)
			{
				counted = counted - nookTableBox(part, which.z);
			}
			sum += share * vec4(float(counted.x), float(counted.y), float(counted.z), float(counted.w));
		}
	}
	return sum;
}

// One layer (SVO eqs. 4, 6, 7 and psi): n * StatVO_i, and how many of its n pixels do not count in eq. 5, for they lie so far in front
// of the box that they say nothing of what is in it. They fade out where psi has come down to 0.
// `fill` turns a mean, less `centre`, into the filled share: eq. 7's n / h for x, y, depth in steps; and what is filled at height 0.
vec2 nookStatLayer(vec4 sum, vec3 centre, vec4 fill)
{
	if (sum.w < 1e-3f)
	{
		return vec2(0.0f, 0.0f);
	}
	vec3 mean = vec3(sum.x, sum.y, sum.z) / sum.w;
	float t = dot(mean - centre, vec3(fill.x, fill.y, fill.z)) + fill.w;
	float over = max(t - 1.0f, 0.0f) * nook.statvo.y;
	return sum.w * vec2(clamp(t, 0.0f, 1.0f) * max(1.0f - over, 0.0f), clamp(over - 1.0f, 0.0f, 1.0f));
}

// Filled share of the box by what is in one rectangle of cells, which has `area` pixels; -1 where it has none. Pixels in no table are
// open, as is what lies behind the box. `ends`: the uniform layers that the box's near and far end lie in; layered = 0: all layers as
// one.
float nookStatFilled(vec4 box, float area, vec3 centre, vec4 fill, vec2 ends, int layered)
{
	if (area < 1e-3f)
	{
		return -1.0f;
	}
	vec2 sum = vec2(0.0f, 0.0f);
	if (layered == 0)
	{
		sum = nookStatLayer(nookStatSum(box, ivec3((nook.layers.x - 1) * nook.layers.y, -1, -1)), centre, fill);
	}
	else if (nook.layers.y != 0)
	{
		int first = clamp(int(floor(ends.x)), 0, nook.layers.x - 1);
		int last = clamp(int(floor(ends.y)), 0, nook.layers.x - 1);
		if (first > 0)
		{
			sum.y = nookStatSum(box, ivec3(first - 1, -1, -1)).w;
		}
		for (int i = first; i <= last; ++i)
		{
			sum += nookStatLayer(nookStatSum(box, ivec3(i, i - 1, -1)), centre, fill);
		}
	}
	else if (nook.layers.x == 2)
	{
		sum = nookStatLayer(nookStatSum(box, ivec3(1, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(0, 1, -1)), centre, fill);
	}
	else // SVO algorithm 2: A2,0; A2,1 = A1,0 - A2,0; A2,2; A2,3 = A0 - A1,0 - A2,2
	{
		sum = nookStatLayer(nookStatSum(box, ivec3(2, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(1, 2, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(3, -1, -1)), centre, fill) +
			  nookStatLayer(nookStatSum(box, ivec3(0, 1, 3)), centre, fill);
	}
	return sum.x / max(area - sum.y, 1e-3f); // eq. 5
}

// An edge, in pixels, as cells; the last cell may have fewer pixels than others.
float nookStatEdge(float edge, int size)
{
	int side = nook.layers.w;
	float full = float(size - size % side);
	if (edge > full)
	{
		return full / float(side) + (edge - full) / float(size % side);
	}
	return edge / float(side);
}

vec4 nookStatCellsOf(vec4 edges)
{
	ivec2 size = nookStatSize();
	return vec4(nookStatEdge(edges.x, size.x), nookStatEdge(edges.y, size.y), nookStatEdge(edges.z, size.x),
				nookStatEdge(edges.w, size.y));
}

// Visibility of a pixel: 1 - StatVO. With the normal, the box stands on the tangent plane (SVO 6). Without, it is aligned with the view
// direction and reaches as far behind the pixel as before it (SVO 3), so that an open surface across the view reads 1/2.
float nookStatVo(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (nookStatKept(depth) == 0)
	{
		return 1.0f;
	}
	vec3 least = nookStatLeast();
	vec3 step = nookStatSpan() / float(nookStatSteps());
	vec3 centre = (nookStatPlace(pixel, depth) - least) / step;
	float radius = nookStatRadius(depth);
	float height = nook.statvo.x * radius;
	vec3 n = vec3(0.0f, 0.0f, 0.5f);
	float ground = 0.5f;
	if (nook.count.z != 0)
	{
		n = nookNormal(pixel);
		ground = 0.0f;
	}
	vec4 fill = vec4(step.x * n.x / height, step.y * n.y / height, -step.z * n.z / height, ground);

	ivec2 at = ivec2(pixel.x - nook.rect.x, pixel.y - nook.rect.y);
	int layered = nook.layers.x > 1 ? 1 : 0;
	if (nook.table.w != 0 && layered != 0)
	{
		layered = nookLevel(ivec2(at.x / 8, at.y / 8), 0).x > 0.5f ? 1 : 0;
	}
	// Depths between which a layer's mean can count: the box's, and what lies before it until it does not count in eq. 5.
	float over = height * (1.0f + 2.0f / nook.statvo.y);
	float aside = 0.0f;
	if (nook.count.z != 0)
	{
		aside = 1.4143f * radius * sqrt(max(1.0f - n.z * n.z, 0.0f));
	}
	float layers = float(nook.layers.x) / nookStatSpan().z;
	vec2 ends = vec2((depth - over - aside - least.z) * layers, (depth + height + aside - least.z) * layers);

	vec2 box = nookStatBox(depth);
	vec2 middle = vec2(float(at.x) + 0.5f, float(at.y) + 0.5f);
	vec4 edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x, middle.y + box.y);
	if (nook.layers.w == 1)
	{
		middle = vec2(float(at.x), float(at.y));
		box = floor(box + vec2(0.5f, 0.5f));
		edges = vec4(middle.x - box.x, middle.y - box.y, middle.x + box.x + 1.0f, middle.y + box.y + 1.0f);
	}
	vec2 size = vec2(nookStatSize());
	edges = clamp(edges, vec4(0.0f, 0.0f, 0.0f, 0.0f), vec4(size.x, size.y, size.x, size.y));
	if (nook.layers.z == 0)
	{
		float area = (edges.z - edges.x) * (edges.w - edges.y);
		return 1.0f - max(nookStatFilled(nookStatCellsOf(edges), area, centre, fill, ends, layered), 0.0f);
	}
	float sum = 0.0f;
	float count = 0.0f;
	for (int i = 0; i < 4; ++i)
	{
		vec4 quarter = vec4(i % 2 == 0 ? edges.x : middle.x, i / 2 == 0 ? edges.y : middle.y,
							i % 2 == 0 ? middle.x : edges.z, i / 2 == 0 ? middle.y : edges.w);
		float area = (quarter.z - quarter.x) * (quarter.w - quarter.y);
		float filled = nookStatFilled(nookStatCellsOf(quarter), area, centre, fill, ends, layered);
		if (filled >= 0.0f)
		{
			sum += filled;
			count += 1.0f;
		}
	}
	return 1.0f - sum / max(count, 1.0f);
}
