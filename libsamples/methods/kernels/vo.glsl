// SPDX-License-Identifier: MIT
// Volumetric obscurance: the open share of the ball around a point, by lines along the view direction, by points, or by areas.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// Where a sample falls is rounded to a pixel, or to a texel of the depth moments. Everything about it, the tangent plane's depth
// included, is then taken at the centre of that, so that an open flat surface reads 1 whatever its slope, for every projection.
// Lengths along a line are shares of the radius, from the line's middle, away from the camera.

// Integral of the falloff along a line, from its beginning at -reach to `end` <= reach. Constant (VO 3: volume alone), or 1 - d^2
// at a distance of d radii.
float nookAlong(float reach, float end)
{
#if NOOK_QUADRATIC
	return reach * reach * (end + reach) - (end * end * end + reach * reach * reach) / 3.0f;
#else
	return end + reach;
#endif
}

// The open part of a line that ends at `end`, where the surface is at `front` and `thick` (VO 4.3).
float nookOpen(float reach, float end, float front, float thick)
{
	float open = nookAlong(reach, clamp(front, -reach, end));
#if NOOK_THICK
	open += nookAlong(reach, end) - nookAlong(reach, clamp(front + thick, -reach, end));
#endif
	return open;
}

// The normal where it is used, so that without it no picture of normals is needed.
vec3 nookVoNormal(ivec2 pixel)
{
#if NOOK_USE_NORMAL
	return nookNormal(pixel);
#else
	return vec3(0.0f, 0.0f, 1.0f);
#endif
}

// A line of the disk: (x, y, half length, weight) -> its open part, all of it (as far as the tangent plane), and how far out of
// range its surface is: 0 in the ball's slab, 1 from a radius in front of the ball on.
vec3 nookVoLineAt(ivec2 pixel, vec4 line, vec2 scale, vec3 n, float depth, float radius, float thick)
{
	ivec2 there = nookNeighbour(pixel, vec2(line.x, line.y), scale * radius);
	float end = line.z;
#if NOOK_USE_NORMAL
	end = clamp(nookPlaneRise(pixel, there, n, depth, 0.0f) / radius, -line.z, line.z);
#endif
	float front = nookDepth(there) - depth;
#if NOOK_USE_NORMAL
	front += nookSlack(depth, radius);
#endif
	front = front / radius;
	float share = line.w / max(nookAlong(line.z, line.z), 1e-20f); // a line on the rim has no length, and counts for nothing
	float open = share * nookOpen(line.z, end, front, thick / radius);
	return vec3(open, share * nookAlong(line.z, end), clamp(-1.0f - front, 0.0f, 1.0f));
}

// What of a sample that is out of range is open after all: its share of that is taken from the sample at the opposite side of the
// pixel, as open as that one is; without the normal, as its mirror image through the pixel's point. Nothing changes on a plane.
float nookMirrored(vec3 own, vec3 opposite)
{
	float share = own.z * (1.0f - opposite.z);
#if NOOK_USE_NORMAL
	return share * own.y * opposite.x / max(opposite.y, 1e-6f);
#else
	return share * max(opposite.y - opposite.x, 0.0f);
#endif
}

// VO 4.1 and 4.4. With the normal the lines end at the tangent plane, and the sum is divided by what it would be with nothing in the
// way. Without it an open surface that faces the camera reads 1/2. Of paired samples 2i and 2i + 1 are opposite.
float nookVoLineIn(ivec2 pixel, vec3 n, float depth, float radius, float thick)
{
	vec2 scale = nookScale(depth);
	float pixels = max(abs(scale.x), abs(scale.y)) * radius;
#if NOOK_USE_NORMAL
	if (pixels < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
#endif
	int count = nookCount(pixels);
	int row = nookVariant(pixel);
	float open = 0.0f;
	float whole = 0.0f;
	vec3 before = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < count; ++i)
	{
		vec3 own = nookVoLineAt(pixel, nookSample(row, i), scale, n, depth, radius, thick);
		open += own.x;
		whole += own.y;
#if NOOK_PAIRED
		if (i % 2 == 1)
		{
			open += nookMirrored(own, before) + nookMirrored(before, own);
		}
		before = own;
#endif
	}
	if (whole > 0.0f)
	{
		return clamp(open / whole, 0.0f, 1.0f); // both are rounded
	}
	return 1.0f;
}

// Two radii (VO 5): both results multiplied (1), or the lesser (2). A third one is our own.
float nookBoth(float open, float other)
{
#if NOOK_RADII == 1
	return open * other;
#else
	return min(open, other);
#endif
}

float nookVoLine(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookVoNormal(pixel);
	float open = nookVoLineIn(pixel, n, depth, nookRadius(nook.radius, depth), nook.thickness);
#if NOOK_RADII
	open = nookBoth(open, nookVoLineIn(pixel, n, depth, nookRadius(nook.second_radius, depth), nook.second_thickness));
#endif
#if NOOK_THIRD
	open = nookBoth(open, nookVoLineIn(pixel, n, depth, nookRadius(nook.third_radius, depth), nook.third_thickness));
#endif
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}

// VO 4 and 4.4. Points of the ball: (x, y, z, weight), x right, y up, z toward the camera. With the normal, points under the tangent
// plane are reflected to above it, and what counts is a point's height above that plane.
float nookVoPointIn(ivec2 pixel, vec3 n, float depth, float radius, float thick)
{
	vec2 scale = nookScale(depth) * radius;
	float pixels = max(abs(scale.x), abs(scale.y));
#if NOOK_USE_NORMAL
	if (pixels < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
#endif
	int count = nookCount(pixels);
	int row = nookVariant(pixel);
	float open = 0.0f;
	float whole = 0.0f;
	for (int i = 0; i < count; ++i)
	{
		vec4 point = nookSample(row, i);
		vec3 p = vec3(point.x, point.y, point.z);
		float above = dot(p, n);
#if NOOK_USE_NORMAL
		if (above < 0.0f)
		{
			p = p - 2.0f * above * n;
			above = -above;
		}
#endif
		ivec2 there = nookNeighbour(pixel, vec2(p.x, p.y), scale);
		float behind = -radius * p.z; // the pixel's depth
#if NOOK_USE_NORMAL
		// As far above the plane as it is, on the line of sight of the pixel's centre.
		behind = nookPlaneRise(pixel, there, n, depth, radius * above);
#endif
		float weight = point.w;
#if NOOK_QUADRATIC
		weight = point.w * max(1.0f - dot(p, p), 0.0f);
#endif
		float front = nookDepth(there) - depth;
#if NOOK_USE_NORMAL
		front += nookSlack(depth, radius);
#endif
		bool free = behind <= front;
#if NOOK_THICK
		free = free || behind > front + thick;
#endif
		if (free)
		{
			open += weight;
		}
		whole += weight;
	}
	if (whole > 0.0f)
	{
		return open / whole;
	}
	return 1.0f; // all points lie where the falloff has come to 0
}

float nookVoPoint(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookVoNormal(pixel);
	float open = nookVoPointIn(pixel, n, depth, nookRadius(nook.radius, depth), nook.thickness);
#if NOOK_RADII
	open = nookBoth(open, nookVoPointIn(pixel, n, depth, nookRadius(nook.second_radius, depth), nook.second_thickness));
#endif
#if NOOK_THIRD
	open = nookBoth(open, nookVoPointIn(pixel, n, depth, nookRadius(nook.third_radius, depth), nook.third_thickness));
#endif
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
