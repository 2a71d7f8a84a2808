// SPDX-License-Identifier: MIT
// Form factor of a polygon: the cosine-weighted share of the hemisphere of a receiver that a convex polygon covers.
// This work is based on: M. McGuire, "Ambient Occlusion Volumes", HPG 2010 (AOV), eq. 4, after D. R. Baum, H. E. Rushmeier, J.
// M. Winget, "Improving Radiosity Solutions through the Use of Analytically Determined Form-Factors", SIGGRAPH 1989.
//
// The including file provides nookCorner(i): corner i of the polygon relative to the receiver, metres along the axes of the
// world.
//
// Eq. 4 is printed with an arc cosine and a quotient of cross products, both of which lose all digits where an edge appears
// short or passes close by. Here the corners are unit vectors, and the angle over its sine is a polynomial of its cosine
// (nookArc), so that short edges lose nothing. For edges that appear nearly as long as half a turn, the cross product has split
// factors, whose direction is accurate to 32 bits. The printed sum is negative for corners that are counter-clockwise as seen
// from the receiver; this is its negative.

// The upper 12 bits of each component: the product of two of them is exact.
vec3 nookHead(vec3 a)
{
	return vec3(uintBitsToFloat(floatBitsToUint(a.x) & 0xfffff000u), uintBitsToFloat(floatBitsToUint(a.y) & 0xfffff000u),
		uintBitsToFloat(floatBitsToUint(a.z) & 0xfffff000u));
}

// a * b - c * d for numbers in two parts (the upper bits and the rest), accurate to 2^-36 of the larger product. Swapping a
// with c and b with d gives exactly the negative.
float nookProducts(vec2 a, vec2 b, vec2 c, vec2 d)
{
	float low = (a.x * b.y + a.y * b.x + a.y * b.y) - (c.x * d.y + c.y * d.x + c.y * d.y);
	return (a.x * b.x - c.x * d.x) + low;
}

// Cross product whose direction is accurate even where it nearly cancels. Where the language has fma(), which rounds once, products
// and their rounding are subtracted (W. Kahan's difference of products); otherwise factors are split.
vec3 nookCross(vec3 a, vec3 b)
{
#if NOOK_NATIVE_FMA
	vec3 right = vec3(a.z * b.y, a.x * b.z, a.y * b.x);
	vec3 lost = vec3(fma(a.z, b.y, -right.x), fma(a.x, b.z, -right.y), fma(a.y, b.x, -right.z));
	return vec3(fma(a.y, b.z, -right.x), fma(a.z, b.x, -right.y), fma(a.x, b.y, -right.z)) - lost;
#else
	vec3 ha = nookHead(a);
	vec3 hb = nookHead(b);
	vec3 la = a - ha;
	vec3 lb = b - hb;
	vec2 ax = vec2(ha.x, la.x);
	vec2 ay = vec2(ha.y, la.y);
	vec2 az = vec2(ha.z, la.z);
	vec2 bx = vec2(hb.x, lb.x);
	vec2 by = vec2(hb.y, lb.y);
	vec2 bz = vec2(hb.z, lb.z);
	return vec3(nookProducts(ay, bz, az, by), nookProducts(az, bx, ax, bz), nookProducts(ax, by, ay, bx));
#endif
}

// acos(x) / sqrt(1 - x * x) for x in [0, 1]: the angle between two unit vectors over its sine, from its cosine. Times the sine, the
// polynomial is off by 4e-7. It gives the same result on every GPU, which acos does not guarantee.
float nookArc(float x)
{
	float p = 0.522759580f + x * (-0.345475831f + x * (0.152677448f - x * 0.0317200786f));
	return 1.57079595f + x * (-0.999943104f + x * (0.783984789f + x * (-0.653083218f + x * p)));
}

// A vector times this has unit length, if it is longer than 1e-15.
float nookUnit(vec3 a)
{
	return 1.0f / sqrt(max(dot(a, a), 1e-30f));
}

// Angle of a unit vector in a plane from the x axis, in (-pi/2, pi]; below 0 where rounding has swapped two points that should be in
// that order. Beyond a right angle the sign is not due to rounding, except for a receiver close to the polygon, where it could
// only be guessed.
float nookTurn(vec2 a)
{
	float arc = nookArc(abs(a.x));
	return a.x < 0.0f ? 3.14159265f - arc * abs(a.y) : arc * a.y;
}

// AOV eq. 4 for the part of the polygon above the tangent plane of a receiver with the unit normal n, in [0, 1]. side: 1 where
// the receiver sees the corners counter-clockwise, -1 where clockwise.
// It walks around the edges once, in a frame whose z axis is n (T. Duff et al., "Building an Orthonormal Basis, Revisited", JCGT
// 2017). The tangent plane cuts the polygon at pairs of an exit and an entry, and the edge along the cut has the angle between
// them. A convex polygon has one pair; rounding may add more close to the tangent plane. As complex numbers, the exits times the
// conjugates of the entries have the sum of all these angles.
// The direction in which an edge crosses the tangent plane is interpolated between those of its ends. Where they are nearly
// opposite it lies on the line that the tangent plane and the plane of the edge share, unless both planes nearly are one: then
// any direction between the ends will do.
float nookFormFactor(int count, vec3 n, float side)
{
	float upward = n.z < 0.0f ? -1.0f : 1.0f;
	float q = -1.0f / (upward + n.z);
	float mixed = n.x * n.y * q;
	vec3 right = vec3(1.0f + upward * n.x * n.x * q, upward * mixed, -upward * n.x);
	vec3 up = vec3(mixed, upward + n.y * n.y * q, -n.y);
	vec3 a = nookCorner(count - 1);
	vec3 away = a * nookUnit(a);
	vec3 from = vec3(dot(away, right), dot(away, up), dot(away, n));
	float edges = 0.0f;
	vec2 cut = vec2(1.0f, 0.0f);
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		away = b * nookUnit(b);
		vec3 to = vec3(dot(away, right), dot(away, up), dot(away, n));
		if (from.z > 0.0f || to.z > 0.0f)
		{
			vec2 first = vec2(from.x, from.y);
			vec2 last = vec2(to.x, to.y);
			float cosine = dot(from, to);
			bool opposite = cosine < -0.95f;
			vec3 exact = vec3(0.0f, 0.0f, 0.0f);
			if (opposite)
			{
				exact = nookCross(b, a);
			}
			if (from.z <= 0.0f || to.z <= 0.0f)
			{
				bool exits = to.z <= 0.0f;
				vec2 node = first * abs(to.z) + last * abs(from.z);
				if (opposite)
				{
					vec2 line = vec2(-dot(exact, up), dot(exact, right));
					line = exits ? line : -line;
					node = dot(line, line) > 1e-4f * dot(exact, exact) ? line : node;
				}
				node = node * (1.0f / sqrt(max(dot(node, node), 1e-30f)));
				first = exits ? first : node;
				last = exits ? node : last;
				cosine = dot(first, last);
				float turn = exits ? node.y : -node.y;
				cut = vec2(cut.x * node.x - cut.y * turn, cut.x * turn + cut.y * node.x);
			}
			float sine = last.x * first.y - last.y * first.x;
			float term = sine * nookArc(abs(cosine));
			if (cosine < 0.0f)
			{
				float unit = opposite ? dot(n, exact) * nookUnit(exact) : sine / sqrt(1.0f - cosine * cosine);
				term = 3.14159265f * unit - term;
			}
			edges += term;
		}
		a = b;
		from = to;
	}
	float cuts = nookTurn(vec2(cut.x, side * cut.y));
	return clamp((side * edges + cuts) * 0.159154943f, 0.0f, 1.0f);
}
