// SPDX-License-Identifier: MIT
// Which of a fixed set of directions a polygon covers, as bits. Polygons are merged by OR, so that no direction counts twice.
// This work is based on: S. Laine, T. Karras, "Two Methods for Fast Ray-Cast Ambient Occlusion", EGSR 2010, for the masks and the
// table; directions, lengths and frame are additions of nook.
//
// A direction is stored as a ray, nookRay(i): a unit direction of the hemisphere around z times a length in (0, 1), a share of the
// reach. All have the same weight; where a file has fewer than 128 * four, the others are 0. An opaque polygon covers the rays that
// cross it. Lengths are evenly distributed, so over all rays the falloff is linear in the distance, as in the ray tracer of AOV. A
// polygon with alpha < 1 covers that share of the rays, another share for each polygon, so that two of them cover more than one.
//
// Which rays lie on the inner side of an edge is read from a table of half spaces, nookHalfSpace(texel, four): bits of the rays
// 128 * four to 128 * four + 127 whose product with the normal of that texel is above 0. The including file provides both, and
// nookCorner(i) (form_factor.glsl).

// Side of the table in texels. A texel is 2 degrees wide.
int nookHalfSpaces()
{
	return 64;
}

// Normal of a texel of the table: a hemisphere as a square, the folded octahedron turned by 45 degrees. Not of unit length.
vec3 nookHalfSpaceNormal(ivec2 texel)
{
	float side = float(nookHalfSpaces());
	float u = (2.0f * float(texel.x) + 1.0f) / side - 1.0f;
	float v = (2.0f * float(texel.y) + 1.0f) / side - 1.0f;
	float x = 0.5f * (u + v);
	float y = 0.5f * (u - v);
	return vec3(x, y, 1.0f - abs(x) - abs(y));
}

// Bits of the rays from 32 * word to 32 * word + 31 that reach farther than `least` along the direction `toward`, in shares of the
// reach.
uint nookMaskWord(int word, vec3 toward, float least)
{
	uint bits = 0u;
	for (int i = 0; i < 32; ++i)
	{
		bits = bits | (uint(dot(nookRay(32 * word + i), toward) > least) << uint(i));
	}
	return bits;
}

// nookMaskWord for the rays among `asked`, of 128 * four to 128 * four + 127.
uvec4 nookMaskWords(int four, vec3 toward, float least, uvec4 asked)
{
	uvec4 bits = uvec4(0u, 0u, 0u, 0u);
	if (asked.x != 0u)
	{
		bits.x = nookMaskWord(4 * four, toward, least);
	}
	if (asked.y != 0u)
	{
		bits.y = nookMaskWord(4 * four + 1, toward, least);
	}
	if (asked.z != 0u)
	{
		bits.z = nookMaskWord(4 * four + 2, toward, least);
	}
	if (asked.w != 0u)
	{
		bits.w = nookMaskWord(4 * four + 3, toward, least);
	}
	return bits & asked;
}

// A texel of the table of half spaces.
uvec4 nookHalfSpaceTexel(ivec2 texel, int four)
{
	return nookMaskWords(four, nookHalfSpaceNormal(texel), 0.0f, uvec4(4294967295u, 4294967295u, 4294967295u, 4294967295u));
}

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

// Inward normal of the plane through an edge and the receiver, along the axes of the frame. The neighbour along that edge gets
// exactly the negative, so that no direction falls between the two. 0 where both ends coincide.
vec3 nookInward(vec3 from, vec3 to, vec3 n, vec3 x, vec3 y)
{
	vec3 c = nookCross(to, from);
	return vec3(dot(c, x), dot(c, y), dot(c, n));
}

// Bits of the rays on the inner side of a plane through the receiver, whose normal points inward; all where it is 0. For the
// opposite normal they are exactly the others.
uvec4 nookInsideEdge(int four, vec3 inward)
{
	float size = abs(inward.x) + abs(inward.y) + abs(inward.z);
	bool upper = inward.z > 0.0f || (inward.z == 0.0f && (inward.y > 0.0f || (inward.y == 0.0f && inward.x >= 0.0f)));
	vec3 n = upper ? inward : -inward;
	int side = nookHalfSpaces();
	float half_side = 0.5f * float(side);
	float scale = half_side / max(size, 1e-37f);
	ivec2 texel = ivec2(int(half_side + scale * (n.x + n.y)), int(half_side + scale * (n.x - n.y)));
	uvec4 bits = nookHalfSpace(ivec2(clamp(texel.x, 0, side - 1), clamp(texel.y, 0, side - 1)), four);
	uint other = upper ? 0u : 4294967295u;
	uint all = size > 0.0f ? 0u : 4294967295u;
	return (bits ^ uvec4(other, other, other, other)) | uvec4(all, all, all, all);
}

// Bits of the share `alpha` of the rays from 32 * word to 32 * word + 31. shift: nookShift of the polygon.
uint nookMaskShare(int word, float alpha, float shift)
{
	uint bits = 0u;
	for (int i = 0; i < 32; ++i)
	{
		float share = float(32 * word + i) * 0.754877666f + shift;
		if (share - floor(share) < alpha)
		{
			bits = bits | (1u << uint(i));
		}
	}
	return bits;
}

// Bits of the rays among `asked`, of 128 * four to 128 * four + 127, that one polygon covers. height: nookHeight(front). polygon: a
// number that no other has, the index of its first corner.
uvec4 nookMaskBits(int count, int four, vec3 n, vec3 front, float height, float alpha, int polygon, float reach, uvec4 asked)
{
	vec3 x = nookTangent(n, 0);
	vec3 y = nookTangent(n, 1);
	float side = height < 0.0f ? -1.0f : 1.0f;
	uvec4 bits = asked;
	vec3 a = nookCorner(count - 1);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		bits = bits & nookInsideEdge(four, nookInward(a, b, n, x, y) * side);
		if ((bits.x | bits.y | bits.z | bits.w) == 0u)
		{
			return bits;
		}
		a = b;
	}
	vec3 down = vec3(dot(front, x), dot(front, y), dot(front, n)) * -side;
	bits = nookMaskWords(four, down, abs(height) / reach, bits);
	if (alpha < 1.0f)
	{
		float shift = nookShift(polygon);
		bits = bits & uvec4(nookMaskShare(4 * four, alpha, shift), nookMaskShare(4 * four + 1, alpha, shift),
							nookMaskShare(4 * four + 2, alpha, shift), nookMaskShare(4 * four + 3, alpha, shift));
	}
	return bits;
}
