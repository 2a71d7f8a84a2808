// SPDX-License-Identifier: MIT
// Volumetric obscurance: the open share of the ball around a point, sampled by lines along the view direction, by points, or by
// areas.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// A sample is rounded to the centre of a pixel, or of a texel of the depth moments. All quantities, the depth of the tangent
// plane included, are then taken at that centre, so that an open flat surface reads 1 at any slope and for every projection.
// Positions along a line are shares of its length, 0 at its end nearest the camera and 1 at the other one, so that its weight is
// that of the whole line.

// Weight of a line of the ball as far as a position, as a share of the whole. The falloff is constant, so that volume alone counts
// (VO 3), or 1 - d^2 at a distance of d radii from the point.
float nookAlong(float place)
{
#if NOOK_QUADRATIC
	float within = clamp(place, 0.0f, 1.0f);
	return within * within * (3.0f - 2.0f * within);
#else
	return place;
#endif
}

// Covered share of a line, whose part above the tangent plane ends at `end`, by a surface from `front` to `back` (VO 4.3).
float nookCoveredShare(float end, float front, float back)
{
	return clamp(nookAlong(min(back, end)) - nookAlong(max(front, 0.0f)), 0.0f, 1.0f);
}

// The normal, where the method uses it; without it, no texture of normals is read.
vec3 nookVoNormal(ivec2 pixel)
{
#if NOOK_USE_NORMAL
	return nookNormal(pixel);
#else
	return vec3(0.0f, 0.0f, 1.0f);
#endif
}

// Evaluates one line of the ball, given as (x, y, half length, weight). Returns the weight of its covered part, the weight of the
// whole line above the tangent plane, and for paired samples how certain it is that the surface seen there has nothing to do with
// the ball: 0 where that surface is no more than one radius in front of the point, rising to 1 where it is two radii in front.
// slack: nookSlack.
vec3 nookVoLineAt(ivec2 pixel, vec4 line, vec2 scale, vec4 plane, vec4 around, float depth, float radius, float slack, float thick)
{
	vec2 near = nookNear(around, vec2(line.x, line.y), scale);
	vec2 across = nookAcross(near);
	float share = 0.5f / max(line.z * radius, 1e-20f); // a line on the rim of the ball has no length and no weight
	float end = 1.0f;
	float away = nookDepth(nookThere(pixel, near)) - depth;
#if NOOK_USE_NORMAL
	end = clamp(0.5f + share * nookPlaneRise(plane, across, 0.0f), 0.0f, 1.0f);
	away += slack;
#endif
	float front = 0.5f + share * away;
	float back = 1.0f;
#if NOOK_THICK
	back = front + share * thick;
#endif
	float missing = 0.0f;
#if NOOK_PAIRED
	missing = clamp(-1.0f - away / radius, 0.0f, 1.0f);
#endif
	return vec3(line.w * nookCoveredShare(end, front, back), line.w * nookAlong(end), missing);
}

// Evaluates one point of the ball, given as (x, y, z, weight) with x to the right, y up, z toward the camera. Returns its weight
// where it is covered and 0 elsewhere, its weight, and 0. With the normal, points below the tangent plane are mirrored to above it,
// and each is tested at its height above that plane.
vec3 nookVoPointAt(ivec2 pixel, vec4 point, vec2 scale, vec3 n, vec4 plane, vec4 around, float depth, float radius, float slack,
				   float thick)
{
	vec3 p = vec3(point.x, point.y, point.z);
	float above = dot(p, n);
#if NOOK_USE_NORMAL
	if (above < 0.0f)
	{
		p = p - 2.0f * above * n;
		above = -above;
	}
#endif
	vec2 near = nookNear(around, vec2(p.x, p.y), scale);
	vec2 across = nookAcross(near);
	float behind = -radius * p.z; // how much deeper than the pixel the point lies
	float front = nookDepth(nookThere(pixel, near)) - depth;
#if NOOK_USE_NORMAL
	// The depth at the same height above the tangent plane, on the line of sight through the centre of that pixel.
	behind = nookPlaneRise(plane, across, radius * above);
	front += slack;
#endif
	float weight = point.w;
#if NOOK_QUADRATIC
	weight = point.w * max(1.0f - dot(p, p), 0.0f);
#endif
	bool covered = behind > front;
#if NOOK_THICK
	covered = covered && behind <= front + thick;
#endif
	return vec3(covered ? weight : 0.0f, weight, 0.0f);
}
