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

// Angle from a to b, unit vectors in a plane with the normal `axis`, in (-pi/2, pi]; below 0 where rounding has swapped two points
// that should be in that order. Beyond a right angle the sign is not due to rounding, except for a receiver close to the polygon,
// where it could only be guessed.
float nookTurn(vec3 a, vec3 b, vec3 axis)
{
	float sine = dot(cross(a, b), axis);
	float cosine = dot(a, b);
	float arc = nookArc(abs(cosine));
	return cosine < 0.0f ? 3.14159265f - arc * abs(sine) : arc * sine;
}

// AOV eq. 4 for the part of the polygon above the tangent plane of a receiver with the unit normal n, in [0, 1]. side: 1 where
// the receiver sees the corners counter-clockwise, -1 where clockwise.
// It walks around the edges once. The tangent plane cuts the polygon at pairs of an exit and an entry, and the edge along the
// cut is added for each pair. A convex polygon has one pair; rounding may add more close to the tangent plane, and each gets
// its edge.
// The direction in which an edge crosses the tangent plane is interpolated between those of its ends. Where they are nearly
// opposite it lies on the line that the tangent plane and the plane of the edge share, unless both planes nearly are one: then
// any direction between the ends will do.
float nookFormFactor(int count, vec3 n, float side)
{
	vec3 a = nookCorner(count - 1);
	vec3 from = a * nookUnit(a); // the direction of a, and its sine of elevation
	float ha = dot(from, n);
	float edges = 0.0f;
	float cuts = 0.0f;
	vec3 exit = vec3(0.0f, 0.0f, 0.0f);  // the last exit
	vec3 entry = vec3(0.0f, 0.0f, 0.0f); // the first entry, where no exit came before it
	int exits = 0;
	int entries = 0;
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		vec3 to = b * nookUnit(b);
		float hb = dot(to, n);
		if (ha > 0.0f || hb > 0.0f)
		{
			vec3 first = from;
			vec3 last = to;
			float cosine = dot(from, to);
			bool opposite = cosine < -0.95f;
			vec3 exact = vec3(0.0f, 0.0f, 0.0f);
			if (opposite)
			{
				exact = nookCross(b, a);
			}
			if (ha <= 0.0f || hb <= 0.0f)
			{
				vec3 node = from * abs(hb) + to * abs(ha);
				if (opposite)
				{
					vec3 line = cross(n, exact);
					if (dot(line, line) > 1e-4f * dot(exact, exact))
					{
						node = dot(line, node) < 0.0f ? -line : line;
					}
				}
				node = node * nookUnit(node);
				if (hb <= 0.0f)
				{
					exit = node;
					exits = 1;
					last = node;
				}
				else
				{
					if (exits > 0)
					{
						cuts += nookTurn(node, exit, n * side);
					}
					else
					{
						entry = node;
						entries = 1;
					}
					first = node;
				}
				cosine = dot(first, last);
			}
			vec3 c = cross(last, first);
			float term = dot(n, c) * nookArc(abs(cosine));
			if (cosine < 0.0f)
			{
				c = opposite ? exact : c;
				term = 3.14159265f * dot(n, c) * nookUnit(c) - term;
			}
			edges += term;
		}
		a = b;
		ha = hb;
		from = to;
	}
	if (entries > 0 && exits > 0)
	{
		cuts += nookTurn(entry, exit, n * side);
	}
	return clamp((side * edges + cuts) * 0.159154943f, 0.0f, 1.0f);
}
