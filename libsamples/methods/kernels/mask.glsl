// SPDX-License-Identifier: MIT
// Which of a fixed set of directions a polygon covers, as bits. Polygons are merged by OR, so that no direction counts twice.
// This work is based on: S. Laine, T. Karras, "Two Methods for Fast Ray-Cast Ambient Occlusion", EGSR 2010, for the masks;
// directions, thresholds and frame are additions of nook.
//
// The including file provides nookCorner(i) (form_factor.glsl) and nookDirection(i): a unit direction of the hemisphere around
// z, and as w a threshold in (0, 1). All directions have the same weight. An opaque polygon at distance t covers a direction
// where 1 - t / reach is above its threshold, so that over all directions the falloff is linear, as in the ray tracer of AOV. A
// polygon with alpha < 1 covers that share of the directions, another share for each polygon, so that two of them cover more
// than one.

// A number in [0, 1) for each polygon, evenly distributed over any run of consecutive polygons.
float nookShift(int polygon)
{
	return float((uint(polygon) * 2654435769u) >> 8u) * 5.9604645e-8f;
}

// Axis 0 or 1 of a frame around a unit normal, the same for every receiver with that normal: the shortest rotation that takes a
// fixed axis to the normal. Only the normal opposite to that axis has no frame; the axis points steeply up, in a direction that
// is opposite to no axis-aligned or mirrored surface.
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
	// This sum keeps its digits where n is nearly opposite to the pole; 1 + dot(n, pole) would lose them.
	vec3 between = pole + n;
	return u - 2.0f * dot(between, u) / max(dot(between, between), 1e-12f) * between;
}

// Smallest and largest cosine to the normal of all directions within an angle below 90 degrees around one direction; `middle`
// and `within` are the cosines of that direction and of the angle.
vec2 nookRingAround(float middle, float within)
{
	if (within <= 0.0f)
	{
		return vec2(-1.0f, 1.0f);
	}
	float across = sqrt(max(0.0f, (1.0f - middle * middle) * (1.0f - within * within)));
	return vec2(-middle >= within ? -1.0f : middle * within - across, middle >= within ? 1.0f : middle * within + across);
}

// Smallest and largest cosine to the normal of all directions that a polygon covers within reach, rounded to the safe side.
// Requires that no corner coincides with the receiver.
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
	float slack = 1e-3f; // covers all rounding
	// Above the horizon, no point of an edge is lower than its ends.
	return vec2(max(lowest > 0.0f ? lowest : around.x, plane.x) - slack, min(around.y, plane.y) + slack);
}

// Can a polygon with that ring cover any of 32 directions? Directions are sorted, the steepest first.
bool nookMaskAsks(int word, vec2 ring)
{
	return nookDirection(32 * word).z >= ring.x && nookDirection(32 * word + 31).z <= ring.y;
}

// Inward normal of the plane through an edge and the receiver, along the axes of the frame. The neighbour along that edge gets
// exactly the negative, so that no direction falls between the two. 0 where both ends coincide.
vec3 nookInward(vec3 from, vec3 to, vec3 n, vec3 x, vec3 y)
{
	vec3 c = nookCross(to, from);
	return vec3(dot(c, x), dot(c, y), dot(c, n));
}

// Bits of the directions from 32 * word to 32 * word + 31 that one polygon covers. height: nookHeight(front). polygon: a number
// of its own, the index of its first corner.
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
		float along = dot(vec3(d.x, d.y, d.z), down) * reach; // the ray meets the plane at up / along of the reach
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
	// Three edges for each pass over the directions; an edge without length removes none.
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
