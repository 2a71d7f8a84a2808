// SPDX-License-Identifier: MIT
// The occlusion by one polygon at a receiver within its ambient occlusion volume.
// This work is based on: M. McGuire, "Ambient Occlusion Volumes", HPG 2010 (AOV), eqs. 5 to 8.
//
// The including file provides nookCorner(i), corner i of the polygon relative to the receiver, metres along the axes of the
// world, and includes form_factor.glsl.

// Height of the receiver above the polygon, whose unit normal is `front`, in metres; below 0 behind it.
float nookHeight(vec3 front)
{
	return -dot(front, nookCorner(0));
}

// By how many metres to move a receiver along `front` before it is evaluated. A receiver in the plane of the polygon, to within
// `bias`, lies either on the polygon, which faces the same way and must not occlude it, or on another surface that meets the
// polygon in a crease, where it would show as a bright dot: that one is moved just out of the plane. facing: cosine between the
// normal of the receiver and `front`.
float nookLift(float height, float two_sided, float bias, float facing)
{
	if (abs(height) > bias || abs(facing) > 0.7f)
	{
		return 0.0f;
	}
	float out_of = two_sided > 0.5f && height < 0.0f ? -1.01f * bias : 1.01f * bias;
	return out_of - height;
}

// Does a polygon whose volume extends `reach` metres (delta in AOV) reach a receiver at `height`: in front of it, or with
// two_sided on both sides. A receiver within `bias` of the plane is not reached, so that no surface occludes itself, whatever
// its normals are.
bool nookReaches(float height, float two_sided, float reach, float bias)
{
	float up = two_sided > 0.5f ? abs(height) : height;
	return up > bias && up < reach;
}

// The falloff without alpha (AOV eqs. 5 and 8), in [0, 1]; 0 outside the volume. height: distance from the plane. share: the
// volume ends where the factor of a side falls below 1 - share; the height is checked by nookReaches.
float nookFalloff(int count, vec3 front, float height, float reach, float share)
{
	float least = 1.0f - share;
	float scale = 1.0f / reach;
	float g = clamp(1.0f - height * scale, 0.0f, 1.0f);
	vec3 a = nookCorner(count - 1);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		vec3 inward = cross(front, b - a); // AOV eq. 7
		float side = clamp(1.0f - dot(a, inward) * (scale * nookUnit(inward)), 0.0f, 1.0f); // 1 where both ends coincide
		g = side < least ? 0.0f : g * side;
		a = b;
	}
	return g;
}

// The occlusion by the polygon, falloff times form factor, at a receiver with the unit normal n; in [0, alpha]. height:
// nookHeight(front). share: extent of the volume along the normal (x) and beyond the edges (y), as shares of reach.
float nookVolume(int count, vec3 n, vec3 front, float alpha, float two_sided, float height, float reach, vec2 share, float bias)
{
	if (!nookReaches(height, two_sided, reach * share.x, bias))
	{
		return 0.0f;
	}
	float g = alpha * nookFalloff(count, front, abs(height), reach, share.y);
	if (g > 0.0f)
	{
		return g * nookFormFactor(count, n, height < 0.0f ? -1.0f : 1.0f);
	}
	return 0.0f;
}
