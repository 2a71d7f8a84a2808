// SPDX-License-Identifier: MIT
// Volumetric obscurance by areas: lines that take in the depths of a piece of the picture, from moments that were filtered
// before.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO 4.2).
//
// A texel of moments holds the mean and the variance of nookEven(depth), the number of its pixels with a surface, and the
// number of all its pixels. It holds the variance rather than M2 because M2 minus the squared mean would have no digits left.
// Level 0 has texels of 2 x 2 pixels; sides are multiples of a texel of the last level.

// A monotonic function of depth that is affine in the picture on every plane, so that its mean over a texel is its value at the
// centre: -1 / depth in perspective, the depth itself in an orthographic projection.
float nookEven(float depth)
{
	return (nook.w_start * depth - nook.w_slope) / (nook.w_slope * depth + nook.w_start);
}

// The inverse of nookEven; NOOK_SKY at infinity and beyond.
float nookUneven(float even)
{
	float below = nook.w_start - even * nook.w_slope;
	if (below <= 0.0f)
	{
		return NOOK_SKY;
	}
	return (nook.w_slope + even * nook.w_start) / below;
}

// Merges two sets of depths, each given as (mean, variance, pixels with a surface, pixels).
vec4 nookJoined(vec4 a, vec4 b)
{
	float count = a.z + b.z;
	if (count == 0.0f)
	{
		return vec4(0.0f, 0.0f, 0.0f, a.w + b.w);
	}
	float share = b.z / count;
	float apart = b.x - a.x;
	return vec4(a.x + share * apart, a.y + share * (b.y - a.y) + share * (1.0f - share) * apart * apart, count, a.w + b.w);
}

// Moments of one pixel, or a texel of the level before NOOK_LEVEL.
vec4 nookMomentsOf(ivec2 at)
{
	if (NOOK_LEVEL > 0)
	{
		return nookLevel(at, NOOK_LEVEL - 1);
	}
	if (at.x < nook.first.x || at.y < nook.first.y || at.x > nook.last.x || at.y > nook.last.y)
	{
		return vec4(0.0f, 0.0f, 0.0f, 0.0f);
	}
	float depth = nookDepth(at);
	if (depth >= NOOK_SKY)
	{
		return vec4(0.0f, 0.0f, 0.0f, 1.0f);
	}
	return vec4(nookEven(depth), 0.0f, 1.0f, 1.0f);
}

// A texel of level NOOK_LEVEL, from the level before.
vec4 nookMoments(ivec2 texel)
{
	ivec2 at = texel * 2;
	vec4 upper = nookJoined(nookMomentsOf(at), nookMomentsOf(ivec2(at.x + 1, at.y)));
	vec4 lower = nookJoined(nookMomentsOf(ivec2(at.x, at.y + 1)), nookMomentsOf(ivec2(at.x + 1, at.y + 1)));
	return nookJoined(upper, lower);
}

// Mean of the open part of a line over surfaces that are spread evenly from even - spread to even + spread, in the measure of
// nookEven (the ramp of VO 4.2); two points of Gauss quadrature. `back`: metres by which the surfaces are moved away, to find
// where they end.
float nookOpenRamp(float reach, float end, float even, float spread, float depth, float radius, float back)
{
	float first = clamp((nookUneven(even - spread) + back - depth) / radius, -reach, end);
	float last = clamp((nookUneven(even + spread) + back - depth) / radius, -reach, end);
	float middle = 0.5f * (first + last);
	float offset = 0.28867513f * (last - first);
	float low = clamp(0.5f + 0.5f * (even - nookEven(depth + radius * (middle - offset) - back)) / spread, 0.0f, 1.0f);
	float high = clamp(0.5f + 0.5f * (even - nookEven(depth + radius * (middle + offset) - back)) / spread, 0.0f, 1.0f);
#if NOOK_QUADRATIC
	low *= reach * reach - (middle - offset) * (middle - offset);
	high *= reach * reach - (middle + offset) * (middle + offset);
#endif
	return nookAlong(reach, first) + 0.5f * (low + high) * (last - first);
}

// The level of moments that a sample reads, from 1; 0 is the picture itself. Its texels have 0.3 to 0.6 of the side of the
// area, since larger ones lie too far from the sample. `lod`: log2 of the radius in pixels.
int nookAreaLevel(float lod, vec4 area)
{
	return clamp(int(floor(lod + area.z - 0.75f)), 0, NOOK_LEVELS);
}

// Evaluates one sample, given as (x, y, log2 of the side of its area in radii, weight). Returns the same three numbers as
// nookVoLineAt.
vec3 nookVoAreaAt(ivec2 pixel, vec4 area, vec2 scale, vec3 plane, vec4 around, float w, float depth, float radius,
				  float thick, float lod)
{
	float reach = sqrt(max(0.0f, 1.0f - area.x * area.x - area.y * area.y));
	ivec2 there = nookThere(pixel, nookAcross(around, vec2(area.x, area.y), scale));
	int level = nookAreaLevel(lod, area) - 1;
	if (level < 0)
	{
		return nookVoLineAt(pixel, vec4(area.x, area.y, reach, area.w), scale, plane, around, w, depth, radius, thick);
	}
	int side = 2 << level;
	ivec2 texel = ivec2(there.x / side, there.y / side);
	vec4 moments = nookLevel(texel, level);
	float even = moments.x;
	float variance = moments.y;
	float end = reach;
#if NOOK_USE_NORMAL
	// From the centre of the pixel to the centre of those pixels of the texel that hold depth.
	int x_ends = max(texel.x * side, nook.first.x) + min((texel.x + 1) * side, nook.last.x + 1);
	int y_ends = max(texel.y * side, nook.first.y) + min((texel.y + 1) * side, nook.last.y + 1);
	float x = 0.5f * float(x_ends) - 0.5f - float(pixel.x);
	float y = 0.5f * float(y_ends) - 0.5f - float(pixel.y);
	end = clamp(nookPlaneRise(plane, vec2(x, y), w / radius, 0.0f), -reach, reach);
	// Subtracts the variance that a surface along the tangent plane has within the texel: it does not occlude.
	float steep = (nook.w_slope * nook.w_slope + nook.w_start * nook.w_start) / (max(plane.z, 1e-6f) * w); // nookEven, per pixel
	variance = max(0.0f, variance - (plane.x * plane.x + plane.y * plane.y) * steep * steep * float(side * side - 1) / 12.0f);
#endif
	// An even spread with the variance of the texel. The paper spreads one standard deviation to each side, a third of the variance,
	// which has 2 to 10 % more error.
	float spread = max(sqrt(3.0f * variance), max(1e-6f * abs(even), 1e-30f)); // the last one for sky alone
	float whole = nookAlong(reach, end);
	float open = nookOpenRamp(reach, end, even, spread, depth, radius, 0.0f);
#if NOOK_THICK
	open += whole - nookOpenRamp(reach, end, even, spread, depth, radius, thick);
#endif
	open = whole + (open - whole) * moments.z / max(moments.w, 1.0f); // sky is open
	float share = area.w / max(nookAlong(reach, reach), 1e-20f);
	float missing = clamp(-1.0f - (nookUneven(even + spread) - depth) / radius, 0.0f, 1.0f);
	return vec3(share * open, share * whole, missing);
}
