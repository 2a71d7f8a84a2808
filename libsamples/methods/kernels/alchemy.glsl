// SPDX-License-Identifier: MIT
// Alchemy ambient obscurance: the occlusion by points of the depth buffer, projected onto the normal.
// This work is based on: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient Obscurance
// Algorithm", HPG 2011 (ALC).

// The level of depth that a sample reads, for a disk with a radius of `pixels` pixels.
int nookAlchemyLevel(vec4 point, float pixels)
{
	return nookLevelFor(sqrt(point.x * point.x + point.y * point.y) * pixels);
}

// Visibility of a pixel: ALC eq. 10 with lengths in radii, so that the picture does not depend on the unit of length. With the
// radius r, the paper's sigma is sigma * r here, its epsilon epsilon * r^2, its beta beta. Samples are (x, y, unused, weight),
// uniform on the disk. Emitted with --cut, surfaces farther away than the radius do not count (H in eq. 9).
// The rounding of depths and normals is subtracted from v.n together with beta.
float nookAlchemy(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 n = nookNormal(pixel); // fetched together with the depth
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth) * radius;
	vec3 sight = nookSight(pixel);
	float facing = max(0.0f, dot(n, sight));
	float bias = (nook.beta * depth + nookSlack(depth, radius) * facing) / radius;
	int row = nookVariant(pixel);
	vec4 around = nookAround(pixel);
	float pixels = max(abs(scale.x), abs(scale.y));
	int count = nookCount(pixels);
	float sum = 0.0f;
	float weights = 0.0f;
	for (int i = 0; i < count; ++i)
	{
		vec4 point = nookSample(row, i);
		weights += point.w;
		vec2 across = nookAcross(around, vec2(point.x, point.y), scale);
		ivec2 there = nookThere(pixel, across);
		float surface = 0.0f;
#if NOOK_LEVELS
		// The sample moves to the pixel that the coarser depth belongs to, so that planes stay planes.
		int level = nookAlchemyLevel(point, pixels);
		surface = nookDepthAt(there, level);
		there = nookPixelAt(there, level);
		across = vec2(float(there.x - pixel.x), float(there.y - pixel.y));
#else
		surface = nookDepth(there);
#endif
		float w = nook.w_slope / radius * surface + nook.w_start / radius;
		vec3 v = nookOffset(sight, across, (surface - depth) / radius, w);
		float square = dot(v, v);
		float height = max(0.0f, dot(v, n) - bias - nook.normal_error * sqrt(square));
		bool counts = surface < NOOK_SKY;
#if NOOK_CUT
		counts = counts && square < 1.0f;
#endif
		float adds = point.w * height / (square + nook.epsilon);
		sum += counts ? adds : 0.0f;
	}
	float open = pow(max(0.0f, 1.0f - 2.0f * nook.sigma * sum / weights), nook.contrast);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
