// SPDX-License-Identifier: MIT
// Which of a fixed set of directions a polygon covers: bits that are merged by OR, so that nothing is counted twice.
// This work is based on: S. Laine, T. Karras, "Two Methods for Fast Ray-Cast Ambient Occlusion", EGSR 2010, for the masks;
// directions, thresholds and frame are our own.
//
// Whoever includes this offers nookCorner(i) (form_factor.glsl) and nookDirection(i): a unit direction of the hemisphere around z,
// and in w a threshold in (0, 1). Each direction counts alike. It is covered by an opaque polygon at a distance t where
// 1 - t / reach is above its threshold, so that over all directions the falloff is linear, as in AOV's ray tracer. Of a polygon with
// alpha < 1 that share of the directions counts, another one for each polygon, so that two of them cover more than one does.

// A number in [0, 1) for each polygon of a set, even over any of them that follow one another.
float nookShift(int polygon)
{
	return float((uint(polygon) * 2654435769u) >> 8u) * 5.9604645e-8f;
}

// A frame around a unit normal, the same for every receiver with that normal: the least turn that takes a fixed axis to it. The
// only normal without one is opposite to that axis, which points steeply up, to where no axis-aligned or mirrored surface has its
// normal. axis: the first or the second one.
vec3 nookTangent(vec3 n, int axis)
{
	vec3 pole = vec3(0.23f, 0.94f, 0.252f);
	pole = pole / sqrt(dot(pole, pole));
	vec3 u = vec3(pole.y, -pole.x, 0.0f);
	u = u / sqrt(dot(u, u));
	if (axis > 0)
	{
		u = cross(pole, u);
	}
	// The sum has all digits where n is close to that one; 1 + dot(n, pole) would have none.
	vec3 between = pole + n;
	return u - 2.0f * dot(between, u) / max(dot(between, between), 1e-12f) * between;
}

// Cosines to a receiver's normal, the least and the most, of all directions no further from one than an angle below 90 degrees; by
// the cosines of both.
vec2 nookRingAround(float middle, float within)
{
	if (within <= 0.0f)
	{
		return vec2(-1.0f, 1.0f);
	}
	float across = sqrt(max(0.0f, (1.0f - middle * middle) * (1.0f - within * within)));
	return vec2(-middle >= within ? -1.0f : middle * within - across, middle >= within ? 1.0f : middle * within + across);
}

// Of all directions that a polygon covers within reach, on the safe side. None of its corners is at the receiver.
vec2 nookMaskRing(int count, vec3 n, vec3 front, float height, float reach)
{
	vec3 sum = vec3(0.0f, 0.0f, 0.0f);
	float lowest = 1.0f;
	for (int i = 0; i < count; ++i)
	{
		vec3 corner = nookCorner(i);
		vec3 unit = corner / sqrt(dot(corner, corner));
		sum = sum + unit;
		lowest = min(lowest, dot(unit, n));
	}
	vec3 middle = sum / sqrt(max(dot(sum, sum), 1e-12f));
	float within = 1.0f;
	for (int i = 0; i < count; ++i)
	{
		vec3 corner = nookCorner(i);
		within = min(within, dot(middle, corner) / sqrt(dot(corner, corner)));
	}
	vec2 around = nookRingAround(dot(middle, n), within);
	vec2 plane = nookRingAround(dot(front, n) * (height < 0.0f ? 1.0f : -1.0f), abs(height) / reach);
	float slack = 1e-3f; // of all rounding
	// Above the horizon, no edge is lower than its ends.
	return vec2(max(lowest > 0.0f ? lowest : around.x, plane.x) - slack, min(around.y, plane.y) + slack);
}

// May a polygon with that ring cover one of those 32 directions? The steepest come first.
bool nookMaskAsks(int word, vec2 ring)
{
	return nookDirection(32 * word).z >= ring.x && nookDirection(32 * word + 31).z <= ring.y;
}

// Of an edge, along the frame's axes: exactly the negative of what a neighbour along that edge has, so that no direction falls
// between the two. 0 where both ends are one.
vec3 nookInward(vec3 from, vec3 to, vec3 n, vec3 x, vec3 y)
{
	vec3 c = nookCross(to, from);
	return vec3(dot(c, x), dot(c, y), dot(c, n));
}

// 32 of the directions, word * 32 and those that follow, that one polygon covers, as bits; height: nookHeight(front). polygon: a
// number of its own, the place of its first corner among those of the set.
uint nookMaskWord(int count, int word, vec3 n, vec3 front, float height, float alpha, int polygon, float reach)
{
	vec3 x = nookTangent(n, 0);
	vec3 y = nookTangent(n, 1);
	float side = height < 0.0f ? -1.0f : 1.0f;
	float up = abs(height);
	vec3 down = vec3(dot(front, x), dot(front, y), dot(front, n)) * -side;
	float shift = nookShift(polygon);
	uint bits = 0u;
	for (int i = 0; i < 32; ++i)
	{
		vec4 d = nookDirection(32 * word + i);
		float along = dot(vec3(d.x, d.y, d.z), down) * reach; // the plane is met at a share up / along of the reach
		if (along > up && 1.0f - up / along > d.w)
		{
			float share = float(32 * word + i) * 0.754877666f + shift;
			if (share - floor(share) < alpha)
			{
				bits = bits | (1u << uint(i));
			}
		}
	}
	vec3 a = nookCorner(count - 1);
	// Three edges for each look at the directions; an edge of no length takes none.
	for (int k = 0; k < count; k += 3)
	{
		vec3 b = nookCorner(k);
		vec3 c = nookCorner(min(k + 1, count - 1));
		vec3 e = nookCorner(min(k + 2, count - 1));
		if (bits != 0u)
		{
			vec3 first = nookInward(a, b, n, x, y) * side;
			vec3 second = nookInward(b, c, n, x, y) * side;
			vec3 third = nookInward(c, e, n, x, y) * side;
			for (int i = 0; i < 32; ++i)
			{
				vec4 d = nookDirection(32 * word + i);
				vec3 ray = vec3(d.x, d.y, d.z);
				if (dot(ray, first) < 0.0f || dot(ray, second) < 0.0f || dot(ray, third) < 0.0f)
				{
					bits = bits & ~(1u << uint(i));
				}
			}
		}
		a = e;
	}
	return bits;
}
