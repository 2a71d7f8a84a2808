// SPDX-License-Identifier: MIT
// For comparison, not in emitted modules: ground-truth ambient occlusion from horizons on slices around the view ray. This work is
// based on: J. Jimenez, X. Wu, A. Pesce, A. Jarabo, "Practical Real-Time Strategies for Accurate Indirect Occlusion", SIGGRAPH 2016
// courses; with the steps and the falloff of F. Strugar, S. McCalla, "XeGTAO", Intel 2021 (the paper spaces steps evenly).
//
// Members of the block:
//   float gtao_falloff: radii from which horizons fade
//   float gtao_thickness: share of the way down that a lower step brings a horizon

// Cosine of the angle between the highest horizon on one side of a slice and v, which points to the eye (eq. 6). lowest: the
// tangent's cosine. Up to nook.gtao_falloff radii a surface counts fully; beyond, its horizon fades to the tangent (4.1). A step
// below the current horizon lowers it by nook.gtao_thickness of the difference, so thin objects occlude little (eq. 9).
float nookGtaoHorizon(ivec2 pixel, vec3 centre, vec3 v, float radius, vec2 way, vec2 scale, float jitter, float lowest)
{
	vec2 across = way * scale;
	float pixels = sqrt(dot(across, across));
	float horizon = lowest;
	for (int k = 0; k < NOOK_STEPS; ++k)
	{
		float share = (float(k) + jitter) / float(NOOK_STEPS);
		ivec2 there = nookNeighbour(pixel, way * nookSliceStep(share * share, pixels), scale);
		if (there.x != pixel.x || there.y != pixel.y)
		{
			float surface = nookDepth(there);
			float seen = lowest; // sky
			if (surface < NOOK_SKY)
			{
				vec3 d = (nookPosition(there, surface) - centre) / radius;
				float apart = sqrt(max(dot(d, d), 1e-30f));
				float counts = clamp((1.0f - apart) / (1.0f - nook.gtao_falloff), 0.0f, 1.0f);
				seen = lowest + counts * (dot(d, v) / apart - lowest);
			}
			float part = seen > horizon ? 1.0f : nook.gtao_thickness;
			horizon += part * (seen - horizon);
		}
	}
	return clamp(horizon, -1.0f, 1.0f);
}

// NOOK_SAMPLES slices with NOOK_STEPS depths on either side. For each, the open part between its two horizons, weighted by the
// cosine to the normal within the slice, times that normal's length (eqs. 7 and 8), divided by the value without occluders;
// otherwise a pixel whose few slices lean toward the normal would read more than 1, and only the mean over a window would be 1.
// Samples, one per slice: (cos, sin, fraction of a step for the first step, weight), rotated and jittered for each pixel of a
// window.
float nookGtao(ivec2 pixel)
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
	float sum = 0.0f;
	float whole = 0.0f;
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec4 slice = nookSample(row, i);
		vec3 o = across * slice.x + up * slice.y;
		vec2 way = vec2(o.x - o.z * sight.x, o.y - o.z * sight.y) * radius;
		float aside = dot(n, o);
		float facing = max(dot(n, v), 0.0f);
		float size = max(sqrt(aside * aside + facing * facing), 1e-6f);
		vec3 turn = vec3(aside / size, facing / size, nookSliceAngle(aside, facing));
		float after = nookGtaoHorizon(pixel, centre, v, radius, way, scale, slice.z, -turn.x);
		float before = nookGtaoHorizon(pixel, centre, v, radius, -way, scale, slice.z, turn.x);
		float open = nookSliceMeasure(sqrt(1.0f - after * after), after, turn) -
					 nookSliceMeasure(-sqrt(1.0f - before * before), before, turn);
		sum += slice.w * size * open;
		whole += slice.w * size * (turn.y + turn.z * turn.x);
	}
	float open = clamp(sum / max(whole, 1e-6f), 0.0f, 1.0f);
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}
