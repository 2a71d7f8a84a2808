// SPDX-License-Identifier: MIT
// For comparison, not in emitted modules: visibility bit masks as published. nookSlices is nook's form of them.
// This work is based on: O. Therrien, Y. Levesque, G. Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", The Visual
// Computer 39 (2023).
//
// Members of the block:
//   float bitmask_thickness: of surfaces, in radii
//   float bitmask_round: added to a number of sectors before it is cut off

// The sector of a direction, with its fractional part: one of 32 sectors of equal angle, from the tangent on one side of a slice to
// that on the other; (x, y) as in nookSliceAngle. angle: of the normal within the slice.
float nookBitmaskSector(float x, float y, float angle)
{
	return clamp((nookSliceAngle(x, y) - angle) * 10.1859164f + 16.0f, 0.0f, 32.0f);
}

// Number of open sectors out of 32 in a slice (algorithm 1). A surface covers the sectors between the direction to it and the
// direction to the point nook.bitmask_thickness further from the eye, at any distance. Sectors are counted from where the surface
// begins; nook.bitmask_round defines how its width is rounded. angle: of the normal within the slice.
int nookBitmaskSlice(ivec2 pixel, vec3 centre, vec3 v, float radius, vec2 way, vec2 scale, float jitter, float angle)
{
	vec2 across = way * scale;
	float pixels = sqrt(dot(across, across));
	uint covered = 0u;
	for (int k = 0; k < 2 * NOOK_STEPS; ++k)
	{
		float side = k % 2 == 0 ? 1.0f : -1.0f;
		float share = (float(k / 2) + jitter) / float(NOOK_STEPS);
		ivec2 there = nookNeighbour(pixel, way * (side * nookSliceStep(share * share, pixels)), scale);
		float surface = nookDepth(there);
		if (surface < NOOK_SKY && (there.x != pixel.x || there.y != pixel.y))
		{
			vec3 d = (nookPosition(there, surface) - centre) / radius;
			float y = dot(d, v);
			float x = side * sqrt(max(dot(d, d) - y * y, 1e-30f));
			float front = nookBitmaskSector(x, y, angle);
			float back = nookBitmaskSector(x, y - nook.bitmask_thickness, angle);
			int first = int(floor(min(front, back)));
			int count = int(floor(abs(front - back) + nook.bitmask_round));
			covered = covered | (nookSliceBitsBelow(first + count) & ~nookSliceBitsBelow(first));
		}
	}
	return 32 - nookSliceBitCount(covered);
}

// NOOK_SAMPLES slices with NOOK_STEPS depths on either side. All sectors have equal weight: no cosine, no falloff.
// Samples as in nookGtao.
float nookBitmask(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth);
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec3 sight = nookPosition(pixel, 0.0f) - nookPosition(pixel, 1.0f);
	vec3 v = sight / sqrt(dot(sight, sight));
	vec3 across = nookSliceAcross(v);
	vec3 up = cross(v, across);
	int row = nookVariant(pixel);
	float open = 0.0f;
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec4 slice = nookSample(row, i);
		vec3 o = across * slice.x + up * slice.y;
		vec2 way = vec2(o.x - o.z * sight.x, o.y - o.z * sight.y) * radius;
		float angle = nookSliceAngle(dot(n, o), max(dot(n, v), 0.0f));
		open += slice.w * float(nookBitmaskSlice(pixel, centre, v, radius, way, scale, slice.z, angle)) / 32.0f;
	}
	open = min(open, 1.0f);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
