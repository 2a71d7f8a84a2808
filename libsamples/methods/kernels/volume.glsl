// SPDX-License-Identifier: MIT
// What one polygon takes from a receiver within its ambient occlusion volume.
// This work is based on: M. McGuire, "Ambient Occlusion Volumes", HPG 2010 (AOV), eqs. 5 to 8.
//
// Whoever includes this offers nookCorner(i): corner i of the polygon, metres from the receiver, along axes of the world, and
// includes form_factor.glsl.

// Metres by which the receiver is above the polygon, whose unit normal is `front`; < 0 behind it.
float nookHeight(vec3 front)
{
	return -dot(front, nookCorner(0));
}

// Metres by which to move a receiver along `front` before it is evaluated: what lies in a polygon's plane, to within `bias`, is
// either on the polygon itself, which faces as the receiver does and must not darken it, or beside another surface, at a crease,
// where it would be a bright dot: that is moved just out of the plane. facing: cosine between the receiver's normal and `front`.
float nookLift(float height, float two_sided, float bias, float facing)
{
	if (abs(height) > bias || abs(facing) > 0.7f)
	{
		return 0.0f;
	}
	float out_of = two_sided > 0.5f && height < 0.0f ? -1.01f * bias : 1.01f * bias;
	return out_of - height;
}

// Does a polygon whose volume reaches that far (AOV: delta, metres) reach a receiver at that height: one of two sides to both, else
// its front alone. Nothing is within `bias` of its plane, so that no surface darkens itself, whatever its normals.
bool nookReaches(float height, float two_sided, float reach, float bias)
{
	float up = two_sided > 0.5f ? abs(height) : height;
	return up > bias && up < reach;
}

// The falloff without alpha (AOV eqs. 5 and 8), in [0, 1]; 0 outside of the volume. height: in front or, of two sides, behind.
// share: the volume ends where the factor of a side falls below 1 - share; of the height nookReaches asks.
float nookFalloff(int count, vec3 front, float height, float reach, float share)
{
	float least = 1.0f - share;
	float g = clamp(1.0f - height / reach, 0.0f, 1.0f);
	vec3 a = nookCorner(count - 1);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		vec3 inward = cross(front, b - a); // AOV eq. 7
		float squared = dot(inward, inward);
		if (squared > 0.0f)
		{
			float side = clamp(1.0f - dot(a, inward) / (sqrt(squared) * reach), 0.0f, 1.0f);
			g = side < least ? 0.0f : g * side;
		}
		a = b;
	}
	return g;
}

// g times the form factor: what the polygon takes from a receiver with the unit normal n; in [0, alpha]. share: of reach, how far
// the volume goes along the normal (x) and beyond the edges (y).
float nookVolume(int count, vec3 n, vec3 front, float alpha, float two_sided, float reach, vec2 share, float bias)
{
	float height = nookHeight(front);
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
