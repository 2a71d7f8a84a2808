// SPDX-License-Identifier: MIT
// Volumetric obscurance by lines, by points and by areas: what the three share, from the sum over the samples to the visibility of
// a pixel.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// NOOK_EXTENT says what a sample of the method is: 0 a line, 1 a point, 2 an area.

// By how much less is covered where a sample whose surface is too far in front to say anything (own.z) is replaced: the share own.z
// of it takes the openness of the sample on the opposite side of the pixel, or without normals the openness of its mirror image
// through the point. On a plane this changes nothing.
float nookMirrored(vec3 own, vec3 opposite)
{
	float share = own.z * (1.0f - opposite.z);
#if NOOK_USE_NORMAL
	return share * own.y * (opposite.y - opposite.x) / max(opposite.y, 1e-6f);
#else
	return share * opposite.x;
#endif
}

// Visibility for one radius (VO 4, 4.1, 4.2 and 4.4). With the normal, samples end at the tangent plane, and the open part is
// divided by the part above the plane. Without it, an open surface that faces the camera reads 1/2. Paired samples: 2i and 2i + 1
// lie on opposite sides.
float nookVoIn(ivec2 pixel, vec3 n, vec4 plane, vec4 around, int row, vec2 metre, float depth, float radius, float thick)
{
	vec2 scale = metre * radius;
	float pixels = max(abs(scale.x), abs(scale.y));
	float flat_variance = 0.0f;
#if NOOK_EXTENT == 2
	pixels = sqrt(abs(scale.x * scale.y));
	flat_variance = nookFlatVariance(plane, depth);
#endif
#if NOOK_USE_NORMAL
	if (pixels < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
#endif
	int count = nookCount(pixels);
	float slack = nookSlack(depth, radius);
	float covered = 0.0f;
	float whole = 0.0f;
	vec3 own = vec3(0.0f, 0.0f, 0.0f);
	vec3 before = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < count; ++i)
	{
#if NOOK_EXTENT == 0
		own = nookVoLineAt(pixel, nookSample(row, i), scale, plane, around, depth, radius, slack, thick);
#elif NOOK_EXTENT == 1
		own = nookVoPointAt(pixel, nookSample(row, i), scale, n, plane, around, depth, radius, slack, thick);
#else
		own =
			nookVoAreaAt(pixel, nookSample(row, i), scale, plane, around, depth, radius, slack, thick, log2(pixels), flat_variance);
#endif
		covered += own.x;
		whole += own.y;
#if NOOK_PAIRED
		if (i % 2 == 1)
		{
			covered -= nookMirrored(own, before) + nookMirrored(before, own);
		}
		before = own;
#endif
	}
	return clamp(1.0f - covered / max(whole, 1e-20f), 0.0f, 1.0f); // 1 where the falloff is 0 at all samples
}

// Combines the results of two radii (VO 5): their product or the smaller one, as this module was emitted. A third radius is an
// addition to the paper.
float nookBoth(float open, float other)
{
#if NOOK_RADII == 1
	return open * other;
#else
	return min(open, other);
#endif
}

// Visibility of a pixel.
float nookVo(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 n = nookVoNormal(pixel); // fetched together with the depth
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec4 plane = nookPlane(pixel, n, nook.w_slope * depth + nook.w_start);
	vec4 around = nookAround(pixel);
	int row = nookVariant(pixel);
	vec2 metre = nookScale(depth);
	float open = nookVoIn(pixel, n, plane, around, row, metre, depth, nookRadius(nook.radius, depth), nook.thickness);
#if NOOK_RADII
	open = nookBoth(
		open, nookVoIn(pixel, n, plane, around, row, metre, depth, nookRadius(nook.second_radius, depth), nook.second_thickness));
#endif
#if NOOK_THIRD
	open = nookBoth(
		open, nookVoIn(pixel, n, plane, around, row, metre, depth, nookRadius(nook.third_radius, depth), nook.third_thickness));
#endif
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}

// Visibility of a pixel by lines.
float nookVoLine(ivec2 pixel)
{
	return nookVo(pixel);
}

// Visibility of a pixel by points.
float nookVoPoint(ivec2 pixel)
{
	return nookVo(pixel);
}

// Visibility of a pixel by areas.
float nookVoArea(ivec2 pixel)
{
	return nookVo(pixel);
}
