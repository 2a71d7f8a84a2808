// SPDX-License-Identifier: MIT
// Volumetric obscurance: the open share of the ball around a point, sampled by lines along the view direction, by points, or by
// areas.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// A sample is rounded to the centre of a pixel, or of a texel of the depth moments. All quantities, the depth of the tangent
// plane included, are then taken at that centre, so that an open flat surface reads 1 at any slope and for every projection.
// Lengths along a line are shares of the radius, measured from the middle of the line away from the camera.

// Integral of the falloff along a line of the ball, from its end at -reach (nearest the camera) to `end` <= reach, in radii.
// The falloff is constant, so that volume alone counts (VO 3), or 1 - d^2 at a distance of d radii from the point.
float nookAlong(float reach, float end)
{
#if NOOK_QUADRATIC
	return reach * reach * (end + reach) - (end * end * end + reach * reach * reach) / 3.0f;
#else
	return end + reach;
#endif
}

// Integral of the falloff from `from` to `to`.
float nookPiece(float reach, float from, float to)
{
#if NOOK_QUADRATIC
	return nookAlong(reach, to) - nookAlong(reach, from);
#else
	return to - from;
#endif
}

// Open part of a line, whose part above the tangent plane ends at `end` and measures `whole`, with a surface at `front` that is
// `thick` deep (VO 4.3). Positions are in radii along the line.
float nookOpen(float reach, float end, float whole, float front, float thick)
{
	float first = clamp(front, -reach, end);
#if NOOK_THICK
	return whole - nookPiece(reach, first, clamp(front + thick, -reach, end));
#else
	return whole - nookPiece(reach, first, end);
#endif
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

// Evaluates one line of the ball, given as (x, y, half length, weight). Returns the weight of its open part, the weight of the
// whole line above the tangent plane, and how certain it is that the surface seen there has nothing to do with the ball: 0
// where that surface is no more than one radius in front of the point, rising to 1 where it is two radii in front.
vec3 nookVoLineAt(ivec2 pixel, vec4 line, vec2 scale, vec3 plane, vec4 around, float w, float depth, float radius, float thick)
{
	vec2 across = nookAcross(around, vec2(line.x, line.y), scale);
	float end = line.z;
	float slack = 0.0f;
#if NOOK_USE_NORMAL
	end = clamp(nookPlaneRise(plane, across, w / radius, 0.0f), -line.z, line.z);
	slack = nookSlack(depth, radius) / radius;
#endif
	float front = (nookDepth(nookThere(pixel, across)) - depth) / radius + slack;
	float share = line.w / max(nookAlong(line.z, line.z), 1e-20f); // a line on the rim of the ball has no length and no weight
	float whole = nookAlong(line.z, end);
	float open = nookOpen(line.z, end, whole, front, thick / radius);
	return vec3(share * open, share * whole, clamp(-1.0f - front, 0.0f, 1.0f));
}

// Evaluates one point of the ball, given as (x, y, z, weight) with x to the right, y up, z toward the camera. Returns its weight
// where it is open and 0 elsewhere, its weight, and 0. With the normal, points below the tangent plane are mirrored to above it,
// and each is tested at its height above that plane.
vec3 nookVoPointAt(ivec2 pixel, vec4 point, vec2 scale, vec3 n, vec3 plane, vec4 around, float w, float depth, float radius,
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
	vec2 across = nookAcross(around, vec2(p.x, p.y), scale);
	float behind = -radius * p.z; // how much deeper than the pixel the point lies
#if NOOK_USE_NORMAL
	// The depth at the same height above the tangent plane, on the line of sight through the centre of that pixel.
	behind = nookPlaneRise(plane, across, w, radius * above);
#endif
	float weight = point.w;
#if NOOK_QUADRATIC
	weight = point.w * max(1.0f - dot(p, p), 0.0f);
#endif
	float front = nookDepth(nookThere(pixel, across)) - depth;
#if NOOK_USE_NORMAL
	front += nookSlack(depth, radius);
#endif
	bool free = behind <= front;
#if NOOK_THICK
	free = free || behind > front + thick;
#endif
	float open = 0.0f;
	if (free)
	{
		open = weight;
	}
	return vec3(open, weight, 0.0f);
}
