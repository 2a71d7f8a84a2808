// SPDX-License-Identifier: MIT
// Form factor of a polygon: the cosine-weighted share of the hemisphere of a receiver that a convex polygon covers.
// This work is based on: M. McGuire, "Ambient Occlusion Volumes", HPG 2010 (AOV), eq. 4, after D. R. Baum, H. E. Rushmeier, J.
// M. Winget, "Improving Radiosity Solutions through the Use of Analytically Determined Form-Factors", SIGGRAPH 1989.
//
// The including file provides nookCorner(i): corner i of the polygon relative to the receiver, metres along the axes of the
// world.
//
// Eq. 4 is printed with an arc cosine and a quotient of cross products, both of which lose all digits where an edge appears
// short or passes close by. Here the angle is an arc tangent, of a cross product with split factors, whose direction is
// accurate to 32 bits in both cases. The printed sum is negative for corners that are counter-clockwise as seen from the
// receiver; this is its negative.

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

// Cross product whose direction is accurate even where it nearly cancels.
vec3 nookCross(vec3 a, vec3 b)
{
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
}

// Angle of (x, y) with y >= 0, in [0, pi]; 0 for (0, 0). Accurate to 2e-7: the polynomial interpolates atan(t) / t in t^2 at
// nine Chebyshev nodes, which is off by 2e-8. It gives the same result on every GPU, which atan does not guarantee.
float nookAngle(float y, float x)
{
	float across = abs(x);
	float most = max(y, across);
	if (!(most > 0.0f))
	{
		return 0.0f;
	}
	float t = min(y, across) / most;
	float u = t * t;
	float p = 0.0421376236f + u * (-0.0157312491f + u * 0.0027662835f);
	p = -0.141977978f + u * (0.106183706f + u * (-0.0745685483f + u * p));
	p = t * (0.999999982f + u * (-0.333330367f + u * (0.19991872f + u * p)));
	if (y > across)
	{
		p = 1.57079633f - p;
	}
	if (x < 0.0f)
	{
		p = 3.14159265f - p;
	}
	return p;
}

// Direction to the point where an edge crosses the tangent plane of the receiver: from a at height ha to b at height hb, on
// opposite sides of the plane. c: cross product of the edge, squared: its squared length. The point is interpolated between a
// and b, or where the plane of the edge is steep enough lies on the line that both planes share, which rounding of distant
// corners does not move.
vec3 nookNode(vec3 a, float ha, vec3 b, float hb, float squared, vec3 c, vec3 n)
{
	vec3 between = (a * hb - b * ha) / (hb - ha);
	vec3 node = cross(n, c);
	if (dot(node, node) > 1e-4f * squared && squared > 0.0f)
	{
		node = node / sqrt(squared);
		return dot(node, between) < 0.0f ? -node : node;
	}
	return between;
}

// Angle from a to b around the given axis, in (-pi/2, pi]; below 0 where rounding has swapped two points that should be in that
// order. Beyond a right angle the sign is not due to rounding, except for a receiver close to the polygon, where it could only
// be guessed.
float nookTurn(vec3 a, vec3 b, vec3 axis)
{
	vec3 c = cross(a, b);
	float x = dot(a, b);
	float angle = nookAngle(sqrt(dot(c, c)), x);
	if (x > 0.0f && dot(c, axis) < 0.0f)
	{
		return -angle;
	}
	return angle;
}

// AOV eq. 4 for the part of the polygon above the tangent plane of a receiver with the unit normal n, in [0, 1]. side: 1 where
// the receiver sees the corners counter-clockwise, -1 where clockwise.
// It walks around the edges once. The tangent plane cuts the polygon at pairs of an exit and an entry, and the edge along the
// cut is added for each pair. A convex polygon has one pair; rounding may add more close to the tangent plane, and each gets
// its edge.
float nookFormFactor(int count, vec3 n, float side)
{
	vec3 a = nookCorner(count - 1);
	float ha = dot(a, n);
	float edges = 0.0f;
	float cuts = 0.0f;
	vec3 exit = vec3(0.0f, 0.0f, 0.0f);  // the last exit
	vec3 entry = vec3(0.0f, 0.0f, 0.0f); // the first entry, where no exit came before it
	int exits = 0;
	int entries = 0;
	for (int i = 0; i < count; ++i)
	{
		vec3 b = nookCorner(i);
		float hb = dot(b, n);
		if (ha > 0.0f || hb > 0.0f)
		{
			vec3 c = nookCross(b, a);
			float squared = dot(c, c);
			float angle = 0.0f;
			if (ha > 0.0f && hb > 0.0f)
			{
				angle = nookAngle(sqrt(squared), dot(a, b));
			}
			if (ha <= 0.0f)
			{
				vec3 node = nookNode(a, ha, b, hb, squared, c, n);
				angle = nookTurn(b, node, c);
				if (exits > 0)
				{
					cuts += nookTurn(node, exit, n * side);
				}
				else
				{
					entry = node;
					entries = 1;
				}
			}
			if (hb <= 0.0f)
			{
				exit = nookNode(a, ha, b, hb, squared, c, n);
				exits = 1;
				angle = nookTurn(exit, a, c);
			}
			if (squared > 0.0f)
			{
				edges += dot(n, c) / sqrt(squared) * angle;
			}
		}
		a = b;
		ha = hb;
	}
	if (entries > 0 && exits > 0)
	{
		cuts += nookTurn(entry, exit, n * side);
	}
	return clamp((side * edges + cuts) * 0.159154943f, 0.0f, 1.0f);
}
