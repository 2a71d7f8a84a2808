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
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth) * radius;
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	float facing = max(0.0f, dot(n, nookPosition(pixel, 0.0f) - nookPosition(pixel, 1.0f)));
	float bias = (nook.beta * depth + nookSlack(depth, radius) * facing) / radius;
	int row = nookVariant(pixel);
	float pixels = max(abs(scale.x), abs(scale.y));
	int count = nookCount(pixels);
	float sum = 0.0f;
	float weights = 0.0f;
	for (int i = 0; i < count; ++i)
	{
		vec4 point = nookSample(row, i);
		weights += point.w;
		ivec2 there = nookNeighbour(pixel, vec2(point.x, point.y), scale);
		float surface = 0.0f;
#if NOOK_LEVELS
		// The sample moves to the pixel that the coarser depth belongs to, so that planes stay planes.
		int level = nookAlchemyLevel(point, pixels);
		surface = nookDepthAt(there, level);
		there = nookPixelAt(there, level);
#else
		surface = nookDepth(there);
#endif
		if (surface < NOOK_SKY)
		{
			vec3 v = (nookPosition(there, surface) - centre) / radius;
			float square = dot(v, v);
			bool counts = true;
#if NOOK_CUT
			counts = square < 1.0f;
#endif
			if (counts)
			{
				sum += point.w * max(0.0f, dot(v, n) - bias - nook.normal_error * sqrt(square)) / (square + nook.epsilon);
			}
		}
	}
	float open = pow(max(0.0f, 1.0f - 2.0f * nook.sigma * sum / weights), nook.contrast);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
