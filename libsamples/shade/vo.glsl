// SPDX-License-Identifier: MIT
// Volumetric obscurance: the open share of the ball around a point, by lines along the view direction or by points.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// Where a sample falls is rounded to a pixel. Everything about it, the tangent plane's depth included, is then taken at that pixel's
// centre, so that an open flat surface reads 1 whatever its slope, for every projection.

// VO 4.1 and 4.4. Lines of the disk: (x, y, half length z_s, weight). With the normal the lines end at the tangent plane, and the sum
// is divided by what it would be with nothing in the way. Without it an open surface that faces the camera reads 1/2.
float nookVoLine(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nook.radius.x;
	vec2 scale = nookScale(depth) * radius;
	if (nook.count.z != 0 && max(scale.x, scale.y) < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
	vec3 n = nookNormal(pixel);
	int row = nookVariant(pixel);
	float seen = 0.0f;
	float whole = 0.0f;
	for (int i = 0; i < nook.count.x; ++i)
	{
		vec4 line = nookSample(row, i);
		ivec2 there = nookNeighbour(pixel, vec2(line.x, line.y), scale);
		float end = line.z;
		if (nook.count.z != 0)
		{
			end = min(end, nookPlaneRise(pixel, there, n, depth, 0.0f) / radius);
		}
		float front = (nookDepth(there) - depth) / radius;
		float share = line.w / (2.0f * line.z);
		seen += share * max(min(end, front) + line.z, 0.0f);
		whole += share * max(end + line.z, 0.0f);
	}
	if (nook.count.z == 0)
	{
		return seen;
	}
	if (whole > 0.0f)
	{
		return seen / whole;
	}
	return 1.0f;
}

// VO 4 and 4.4. Points of the ball: (x, y, z, weight), x right, y up, z toward the camera. With the normal, points under the tangent
// plane are reflected to above it, and what counts is a point's height above that plane.
float nookVoPoint(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nook.radius.x;
	vec2 scale = nookScale(depth) * radius;
	if (nook.count.z != 0 && max(scale.x, scale.y) < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
	vec3 n = nookNormal(pixel);
	int row = nookVariant(pixel);
	float seen = 0.0f;
	for (int i = 0; i < nook.count.x; ++i)
	{
		vec4 point = nookSample(row, i);
		vec3 p = vec3(point.x, point.y, point.z);
		float above = dot(p, n);
		if (nook.count.z != 0 && above < 0.0f)
		{
			p = p - 2.0f * above * n;
			above = -above;
		}
		ivec2 there = nookNeighbour(pixel, vec2(p.x, p.y), scale);
		float behind = -radius * p.z; // the pixel's depth
		if (nook.count.z != 0)
		{
			// As far above the plane as it is, on the line of sight of the pixel's centre.
			behind = nookPlaneRise(pixel, there, n, depth, radius * above);
		}
		if (behind <= nookDepth(there) - depth)
		{
			seen += point.w;
		}
	}
	return seen;
}
