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
	for (int k = 0; k < count; ++k)
	{
		vec3 b = nookCorner(k);
		if (bits != 0u)
		{
			// Exactly the negative of what a neighbour along that edge has: no direction falls between the two.
			vec3 c = nookCross(b, a);
			vec3 inward = vec3(dot(c, x), dot(c, y), dot(c, n)) * side;
			for (int i = 0; i < 32; ++i)
			{
				vec4 d = nookDirection(32 * word + i);
				if (dot(vec3(d.x, d.y, d.z), inward) < 0.0f)
				{
					bits = bits & ~(1u << uint(i));
				}
			}
		}
		a = b;
	}
	return bits;
}
