// SPDX-License-Identifier: MIT
// The Alchemy ambient obscurance: projected occlusion of points of the depth buffer.
// This work is based on: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient Obscurance Algorithm",
// HPG 2011 (ALC).

// ALC eq. 10 with lengths in units of the radius, so that neither metres nor centimetres change the picture: the paper's sigma for a
// radius of r metres is sigma * r, its beta is beta, its epsilon is epsilon * r^2. Samples: (x, y, -, weight), uniform on the disk.
// nook.alchemy = (sigma, contrast k, beta, epsilon); nook.count.w = 1 cuts off what is further than the radius (eq. 9's H).
float nookAlchemy(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nook.radius.x;
	vec2 scale = nookScale(depth) * radius;
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	int row = nookVariant(pixel);
	float sum = 0.0f;
	for (int i = 0; i < nook.count.x; ++i)
	{
		vec4 point = nookSample(row, i);
		ivec2 there = nookNeighbour(pixel, vec2(point.x, point.y), scale);
		float surface = nookDepth(there);
		if (surface < NOOK_SKY)
		{
			vec3 v = (nookPosition(there, surface) - centre) / radius;
			float square = dot(v, v);
			if (nook.count.w == 0 || square < 1.0f)
			{
				sum += point.w * max(0.0f, dot(v, n) - nook.alchemy.z * depth / radius) / (square + nook.alchemy.w);
			}
		}
	}
	return pow(max(0.0f, 1.0f - 2.0f * nook.alchemy.x * sum), nook.alchemy.y);
}
