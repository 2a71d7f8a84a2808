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

// The inverse of nookEven; very far away at infinity and beyond.
float nookUneven(float even)
{
	return (nook.w_slope + even * nook.w_start) / max(nook.w_start - even * nook.w_slope, 1e-20f);
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

// Surfaces along a line that is 1 / share metres long, spread evenly in the measure of nookEven from even - spread to even + spread
// (the ramp of VO 4.2). x: place of the mean; y, z: the first and the last surface lie at x - y / (1 + z) and x + y / (1 - z).
vec3 nookRamp(float even, float spread, float depth, float share)
{
	float surface = nookUneven(even);
	float w = nook.w_slope * surface + nook.w_start;
	float per_w = spread * w / (nook.w_slope * nook.w_slope + nook.w_start * nook.w_start); // depth per w, near the mean
	return vec3(0.5f + share * (surface - depth), share * per_w * w, nook.w_slope * per_w);
}

// Mean over the surfaces of a ramp of the covered share of a line that ends at `end`; two points of Gauss quadrature.
float nookCoveredRamp(float end, vec3 ramp)
{
	float first = clamp(ramp.x - ramp.y / (1.0f + ramp.z), 0.0f, end);
	float last = clamp(ramp.x + ramp.y / max(1.0f - ramp.z, 1e-6f), 0.0f, end);
	float width = last - first;
	float low = first + 0.21132487f * width;
	float high = first + 0.78867513f * width;
	// Share of the surfaces in front of a place.
	float before_low = clamp(0.5f + 0.5f * (low - ramp.x) / (ramp.y + ramp.z * (low - ramp.x)), 0.0f, 1.0f);
	float before_high = clamp(0.5f + 0.5f * (high - ramp.x) / (ramp.y + ramp.z * (high - ramp.x)), 0.0f, 1.0f);
#if NOOK_QUADRATIC
	before_low *= 6.0f * low * (1.0f - low);
	before_high *= 6.0f * high * (1.0f - high);
#endif
	return nookAlong(end) - nookAlong(last) + 0.5f * width * (before_low + before_high);
}

// The level of moments that a sample reads, from 1; 0 is the picture itself. Its texels have 0.3 to 0.6 of the side of the
// area, since larger ones lie too far from the sample. `lod`: log2 of the radius in pixels.
int nookAreaLevel(float lod, vec4 area)
{
	return clamp(int(floor(lod + area.z - 0.75f)), 0, NOOK_LEVELS);
}

// Variance of nookEven along a tangent plane within a texel, divided by the texel's number of pixels minus 1.
float nookFlatVariance(vec4 plane, float depth)
{
	float w = nook.w_slope * depth + nook.w_start;
	float steep = (nook.w_slope * nook.w_slope + nook.w_start * nook.w_start) / (plane.z * w * w); // nookEven, per metre of plane
	return (plane.x * plane.x + plane.y * plane.y) * steep * steep / 12.0f;
}

// Evaluates one sample, given as (x, y, log2 of the side of its area in radii, weight). Returns the same three numbers as
// nookVoLineAt. lod: log2 of the radius in pixels; flat_variance: nookFlatVariance.
vec3 nookVoAreaAt(ivec2 pixel, vec4 area, vec2 scale, vec4 plane, vec4 around, float depth, float radius, float slack, float thick,
				  float lod, float flat_variance)
{
	float reach = sqrt(max(1e-12f, 1.0f - area.x * area.x - area.y * area.y));
	ivec2 there = nookThere(pixel, nookNear(around, vec2(area.x, area.y), scale));
	int level = nookAreaLevel(lod, area);
	if (level == 0)
	{
		return nookVoLineAt(pixel, vec4(area.x, area.y, reach, area.w), scale, plane, around, depth, radius, slack, thick);
	}
	ivec2 texel = ivec2(there.x >> level, there.y >> level);
	vec4 moments = nookLevel(texel, level - 1);
	float share = 0.5f / (reach * radius);
	float variance = moments.y;
	float end = 1.0f;
#if NOOK_USE_NORMAL
	// From the centre of the pixel to the centre of those pixels of the texel that hold depth.
	int beyond = (1 << level) - 1;
	ivec2 start = ivec2(texel.x << level, texel.y << level);
	int x_ends = max(start.x, nook.first.x) + min(start.x + beyond, nook.last.x);
	int y_ends = max(start.y, nook.first.y) + min(start.y + beyond, nook.last.y);
	vec2 across = vec2(0.5f * float(x_ends) - float(pixel.x), 0.5f * float(y_ends) - float(pixel.y));
	end = clamp(0.5f + share * nookPlaneRise(plane, across, 0.0f), 0.0f, 1.0f);
	// Subtracts the variance that a surface along the tangent plane has within the texel: it does not occlude.
	variance = max(0.0f, variance - flat_variance * float((1 << (2 * level)) - 1));
#endif
	// An even spread with the variance of the texel. The paper spreads one standard deviation to each side, a third of the
	// variance, which has 2 to 10 % more error.
	float spread = max(sqrt(3.0f * variance), max(1e-6f * abs(moments.x), 1e-30f)); // the last one for sky alone
	vec3 ramp = nookRamp(moments.x, spread, depth, share);
	float covered = nookCoveredRamp(end, ramp);
#if NOOK_THICK
	covered -= nookCoveredRamp(end, vec3(ramp.x + share * thick, ramp.y, ramp.z));
#endif
	float missing = 0.0f;
#if NOOK_PAIRED
	missing = clamp(-1.0f - (nookUneven(moments.x + spread) - depth) / radius, 0.0f, 1.0f);
#endif
	// Sky is open.
	return vec3(area.w * covered * moments.z / max(moments.w, 1.0f), area.w * nookAlong(end), missing);
}
