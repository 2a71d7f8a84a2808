// SPDX-License-Identifier: MIT
// The Alchemy ambient obscurance: projected occlusion of points of the depth buffer.
// This work is based on: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient Obscurance Algorithm",
// HPG 2011 (ALC).

// The level of depth_levels.glsl that a sample of a disk of that many pixels reads.
int nookAlchemyLevel(vec4 point, float pixels)
{
	return nookLevelFor(sqrt(point.x * point.x + point.y * point.y) * pixels);
}

// ALC eq. 10 with lengths in units of the radius, so that neither metres nor centimetres change the picture: the paper's sigma for a
// radius of r metres is sigma * r, its beta is beta, its epsilon is epsilon * r^2. Samples: (x, y, -, weight), uniform on the disk.
// With the cut, what is further away than the radius (eq. 9's H) does not count.
// What the format of depths and normals may have added to v.n is taken off, as beta is.
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
		// The coarser depth's own pixel takes the sample's place, so that planes stay planes.
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
