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
// uniform on the disk, with a sum of weights of 1. Emitted with --cut, surfaces farther away than the radius do not count (H in
// eq. 9). The rounding of depths and normals is subtracted from v.n together with beta, for normals as if v were longer by epsilon.
float nookAlchemy(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 n = nookNormal(pixel); // fetched together with the depth
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec2 texel = nookTexel();
	vec2 step_of = texel * (nook.w_slope * depth + nook.w_start); // size of a pixel at this depth
	vec2 metre = vec2(1.0f / step_of.x, -1.0f / step_of.y);
	float radius = nookRadiusOf(nook.radius, min(abs(step_of.x), abs(step_of.y)));
	vec2 scale = metre * radius;
	vec2 turn = texel * nook.w_slope; // by how much the line of sight changes from pixel to pixel
	vec3 sight = nookSight(pixel);
	float facing = max(0.0f, dot(n, sight));
	float bias = nook.beta * depth + nookSlack(depth, radius) * facing;
	float least = nook.epsilon * radius * radius;
	int row = nookVariant(pixel);
	vec4 around = nookAround(pixel);
	float pixels = max(abs(scale.x), abs(scale.y));
	int count = nookCount(pixels);
	float sum = 0.0f;
	float weights = 0.0f;
	for (int i = 0; i < count; ++i)
	{
		vec4 point = nookSample(row, i);
		vec2 near = nookNear(around, vec2(point.x, point.y), scale);
		vec2 across = nookAcross(near);
		ivec2 there = nookThere(pixel, near);
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
		// The surface lies at (x, y, -deeper). Sky does not occlude: it is so far away that it adds nothing.
		float deeper = min(surface, 1e15f) - depth;
		float x = across.x * step_of.x + deeper * (across.x * turn.x - sight.x);
		float y = across.y * step_of.y + deeper * (across.y * turn.y - sight.y);
		float square = x * x + (y * y + (deeper * deeper + least));
		float inverse = 1.0f / sqrt(square);
		float height = x * n.x + y * n.y - (deeper * n.z + bias);
		float adds = point.w * inverse * clamp(height * inverse - nook.normal_error, 0.0f, 1.0f);
#if NOOK_CUT
		adds = square < radius * radius + least ? adds : 0.0f;
#endif
		sum += adds;
#if NOOK_BANDS > 1
		weights += point.w;
#endif
	}
#if NOOK_BANDS > 1
	sum /= weights;
#endif
	float open = pow(max(0.0f, 1.0f - nook.sigma * radius * (sum + sum)), nook.contrast);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
