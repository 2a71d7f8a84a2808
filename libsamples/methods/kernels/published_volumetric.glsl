// SPDX-License-Identifier: MIT
// For comparison, not in emitted modules: volumetric ambient occlusion, the open fraction of the sphere tangent to the surface.
// This work is based on: L. Szirmay-Kalos, T. Umenhoffer, B. Toth, L. Szecsi, M. Sbert, "Volumetric Ambient Occlusion for Real-Time
// Rendering and Games", IEEE Computer Graphics and Applications 30(1), 2010.

// Projects a view-space point to pixels from the texture's upper left corner; pixel centres are at 1/2.
vec2 nookProjected(vec3 position)
{
	float depth = -position.z;
	float w = nook.w_slope * depth + nook.w_start;
	float ndc_x = (position.x - depth * nook.across_x.y - nook.aside.x) / (w * nook.across_x.x);
	float ndc_y = (position.y - depth * nook.across_y.y - nook.aside.y) / (w * nook.across_y.x);
	return vec2(nook.origin.x + (0.5f + 0.5f * ndc_x) * nook.size.x, nook.origin.y + (0.5f - 0.5f * ndc_y) * nook.size.y);
}

// The sphere has half the radius and its centre that far above the surface: its volume measures the cosine-weighted visibility of
// surfaces nearer than the radius. Sums lines along the view direction from where they enter the sphere to the depth buffer or
// their exit, divided by the total length of the lines (rather than the sphere's volume, so that few lines also read 1 in the
// open). Samples: (x, y, half length, weight), uniform on the disk. The radius is at most the pixel's depth, in perspective its
// distance from the eye's plane, so that no sphere extends behind the camera.
float nookVolumetric(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float most = depth;
	if (nook.w_slope > 0.0f)
	{
		most = min(depth, (nook.w_slope * depth + nook.w_start) / nook.w_slope);
	}
	float radius = 0.5f * min(nookRadius(nook.radius, depth), most);
	vec3 centre = nookPosition(pixel, depth) + radius * nookNormal(pixel);
	float middle = -centre.z;
	vec2 scale = nookScale(middle) * radius;
	vec2 at = nookProjected(centre);
	int row = nookVariant(pixel);
	float seen = 0.0f;
	float whole = 0.0f;
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec4 line = nookSample(row, i);
		// Clamped as floats: off-centre projections may put it anywhere.
		float x = clamp(floor(at.x + line.x * scale.x), float(nook.first.x), float(nook.last.x));
		float y = clamp(floor(at.y - line.y * scale.y), float(nook.first.y), float(nook.last.y));
		float end = min((nookDepth(ivec2(int(x), int(y))) - middle) / radius, line.z);
		seen += line.w * max(end + line.z, 0.0f);
		whole += line.w * 2.0f * line.z;
	}
	float open = whole > 0.0f ? seen / whole : 1.0f;
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
