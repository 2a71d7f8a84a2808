// SPDX-License-Identifier: MIT
// Visibility on slices: planes that hold the view ray, each with a mask of bits for the directions of it that are covered.
// This work is based on: O. Therrien, Y. Levesque, G. Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", The Visual
// Computer 39 (2023), for the masks and the thickness; J. Jimenez, X. Wu, A. Pesce, A. Jarabo, "Practical Real-Time Strategies for
// Accurate Indirect Occlusion", SIGGRAPH 2016 courses, for the slices; bits worth the same, falloff and slices even around the view
// ray are our own.

// Without a tile: which of the sixteen variants of a window of 4 x 4 cells a pixel has. The place of its cell in a Bayer matrix, so
// that neighbours differ most.
int nookSliceVariant(ivec2 pixel)
{
	ivec2 cell = ivec2(pixel.x / NOOK_CELL, nookRow(pixel.y) / NOOK_CELL);
	int own = ((cell.y % 4) * 4 + cell.x % 4 + NOOK_VARIANT) % 16;
	int x = own % 4;
	int y = own / 4;
	return 4 * (2 * ((x + y) % 2) + y % 2) + 2 * ((x / 2 + y / 2) % 2) + y / 2;
}

// The same number with its four bits in reverse: the two together are even in both (Hammersley).
int nookSliceReverse(int variant)
{
	return 8 * (variant % 2) + 4 * ((variant / 2) % 2) + 2 * ((variant / 4) % 2) + variant / 8;
}

// Angle from the axis of y towards x, -pi to pi; at most 1e-5 off, the same on every renderer.
float nookSliceAngle(float x, float y)
{
	float longer = max(abs(x), abs(y));
	float t = min(abs(x), abs(y)) / max(longer, 1e-30f);
	float s = t * t;
	float angle =
		t * (0.99997726f + s * (-0.33262347f + s * (0.19354346f + s * (-0.11643287f + s * (0.05265332f - s * 0.0117212f)))));
	if (abs(x) > abs(y))
	{
		angle = 1.57079633f - angle;
	}
	if (y < 0.0f)
	{
		angle = 3.14159265f - angle;
	}
	return x < 0.0f ? -angle : angle;
}

// The measure of a direction of a slice at the angle t from the eye is cos(t - angle) |sin t|, with (sine, cosine and angle of the
// normal within the slice) as turn; this is its integral from the eye to the direction (x, y), negative where x is: sign(t) / 4
// (cos(angle) - cos(2 t - angle)) + |t| / 2 sin(angle). y points to the eye.
float nookSliceMeasure(float x, float y, vec3 turn)
{
	float square = x * x + y * y;
	float sign = x < 0.0f ? -1.0f : 1.0f;
	float doubled = ((y * y - x * x) * turn.y + 2.0f * x * y * turn.x) / square;
	return 0.25f * sign * (turn.y - doubled) + 0.5f * abs(nookSliceAngle(x, y)) * turn.x;
}

// Which share of a slice's open directions, by their cosine to the normal, lies before the direction (x, y).
// side: 1 for what lies that way along the slice, -1 for the other.
float nookSliceShare(float x, float y, float side, vec3 turn)
{
	if (x * turn.x + y * turn.y <= 0.0f)
	{
		return side < 0.0f ? 0.0f : 1.0f; // under the tangent plane
	}
	float first = 0.5f * (turn.y - (1.57079633f - turn.z) * turn.x);
	return clamp((nookSliceMeasure(x, y, turn) + first) / (turn.y + turn.z * turn.x), 0.0f, 1.0f);
}

uint nookSliceBitsBelow(int end)
{
	if (end > 31)
	{
		return 4294967295u;
	}
	return (1u << uint(end)) - 1u;
}

int nookSliceBitCount(uint bits)
{
	uint pairs = bits - ((bits >> 1u) & 1431655765u);
	uint fours = (pairs & 858993459u) + ((pairs >> 2u) & 858993459u);
	uint eights = (fours + (fours >> 4u)) & 252645135u;
	return int((eights * 16843009u) >> 24u);
}

// With (sine, cosine and angle of the normal within the slice) as turn, the direction (sine and cosine of its angle from the eye)
// before which `share` of the slice lies, by the cosine; the inverse of nookSliceShare. Both ends of the measure are parabolas, as
// those of the squared sine: that starts two steps of Newton's, which leave 0.03 degrees where the normal is within 69 degrees of the
// eye, 0.4 at 86 (a test).
vec2 nookSliceToward(float share, vec3 turn)
{
	float first = 0.5f * (turn.y - (1.57079633f - turn.z) * turn.x);
	float wanted = share * (turn.y + turn.z * turn.x) - first;
	float side = wanted < 0.0f ? -1.0f : 1.0f;
	float sine = side * turn.x;
	float last = 1.57079633f + side * turn.z;
	float whole = max(0.5f * (turn.y + last * sine), 1e-12f);
	float part = clamp(abs(wanted) / whole, 0.0f, 1.0f);
	float angle = last * nookSliceAngle(sqrt(part), sqrt(1.0f - part)) / 1.57079633f;
	for (int i = 0; i < 2; ++i)
	{
		float x = sin(angle);
		float y = cos(angle);
		float doubled = (y * y - x * x) * turn.y + 2.0f * x * y * sine;
		float off = 0.25f * (turn.y - doubled) + 0.5f * angle * sine - abs(wanted);
		angle = clamp(angle - off / max((y * turn.y + x * sine) * x, 1e-2f), 0.0f, last);
	}
	return vec2(side * sin(angle), cos(angle));
}

// The integral of the measure times the direction, along the slice and to the eye, from the eye to that direction.
vec2 nookSliceMoment(vec2 toward, vec3 turn)
{
	float x = toward.x * toward.x * toward.x;
	float y = toward.y * toward.y * toward.y;
	float sign = toward.x < 0.0f ? -1.0f : 1.0f;
	return vec2(turn.y * x + turn.x * (2.0f - 3.0f * toward.y + y), turn.y * (1.0f - y) + turn.x * x) * (sign / 3.0f);
}

// The same over the directions of some bits, first to end - 1: run by run.
vec2 nookSliceSum(uint bits, int first, int end, vec3 turn)
{
	vec2 sum = vec2(0.0f, 0.0f);
	uint before = 0u;
	for (int i = first; i <= end; ++i)
	{
		uint now = 0u;
		if (i < end)
		{
			now = (bits >> uint(i)) & 1u;
		}
		if (now != before)
		{
			vec2 moment = nookSliceMoment(nookSliceToward(float(i) / 32.0f, turn), turn);
			sum = sum + moment * (float(before) - float(now));
		}
		before = now;
	}
	return sum;
}

// Where a step reads depth, as a part of a slice's way in the picture, which is `pixels` long: `part` of what is left beyond 1.3
// pixels, within which half a pixel beside the slice tilts what is seen most (XeGTAO). part: [0, 1).
float nookSliceStep(float part, float pixels)
{
	float first = 1.3f / max(pixels, 1.3f);
	return first + (1.0f - first) * part;
}

// What one slice leaves open, and what it is worth, by the cosine: x the open part, y all; with bent normals, z and w the sum of the
// directions that are closed, along the slice and to the eye. o: the slice's direction across the view,
// a unit vector like v, which points to the eye. jitter: [0, 1).
// A surface at q covers what lies between the direction to it and the one to what is its thickness behind it on its line of sight:
// nook.slice_thickness at the reach, 1/32 of it close by, since what is near is mostly thin. Beyond the picture the border's pixel is
// read, and counts half of what it would in the picture. Steps lie at the cube of even shares, so that near ones are dense.
// These numbers were tried on the levels of docs/reference/recipes.md.
// What covers a bit first counts 1 - distance / radius, at a distance two thirds of the way back from what is seen there to where the
// step before would have seen it: the surface between the two steps is what covers it. Off the slice, by up to half a pixel or because the
// picture ends there, a surface keeps its height over the tangent plane, so that planes cover nothing.
vec4 nookSlice(ivec2 pixel, vec3 n, vec3 centre, float radius, vec2 scale, vec3 sight, vec3 v, vec3 o, float jitter)
{
	vec3 beside = cross(o, v);
	vec2 within = vec2(dot(n, o), dot(n, v));
	float square = max(dot(within, within), 1e-4f);
	float aside = dot(n, beside) / square;
	float facing = max(within.y, 0.0f);
	float size = max(sqrt(within.x * within.x + facing * facing), 1e-6f);
	vec3 turn = vec3(within.x / size, facing / size, nookSliceAngle(within.x, facing));
	vec2 way = vec2(o.x - o.z * sight.x, o.y - o.z * sight.y) * radius;
	vec2 across = way * scale;
	float pixels = sqrt(dot(across, across));
	uint covered = 0u;
	float closed = 0.0f;
	vec2 lost = vec2(0.0f, 0.0f);
	for (int k = 0; k < 2 * NOOK_STEPS; ++k)
	{
		float side = k % 2 == 0 ? 1.0f : -1.0f;
		float moved = jitter + 0.5f * float(k % 2);
		float share = (float(k / 2) + moved - floor(moved)) / float(NOOK_STEPS);
		float place = nookSliceStep(share * share * share, pixels);
		ivec2 wanted = nookBeside(pixel, way * (side * place), scale);
		ivec2 there = nookInside(wanted);
		float surface = nookDepth(there);
		vec3 d = (nookPosition(there, surface) - centre) / radius;
		float apart = dot(d, d);
		float slide = dot(d, beside) * aside;
		float x = dot(d, o) + slide * within.x;
		float y = dot(d, v) + slide * within.y;
		// Kept at its height, a depth half a pixel beside a grazing slice may come to lie on the other side: then it says nothing.
		if (surface < NOOK_SKY && apart < 1.0f && x * side > 0.0f)
		{
			vec3 away = nookPosition(there, 1.0f) - nookPosition(there, 0.0f);
			float thick = nook.slice_thickness * (0.03125f + 0.96875f * sqrt(apart)) / sqrt(dot(away, away));
			float front = nookSliceShare(x, y, side, turn);
			float back = nookSliceShare(x + thick * dot(away, o), y + thick * dot(away, v), side, turn);
			int first = int(floor(32.0f * min(front, back) + 0.5f));
			int end = int(floor(32.0f * max(front, back) + 0.5f));
			uint fresh = nookSliceBitsBelow(end) & ~nookSliceBitsBelow(first) & ~covered;
			covered = covered | fresh;
			float last = max(share - 1.0f / float(NOOK_STEPS), 0.0f);
			float before = nookSliceStep(last * last * last, pixels) / place;
			float known = there == wanted ? 1.0f : 0.5f;
			float counts = known * (1.0f - (1.0f + 2.0f * before) / 3.0f * sqrt(apart));
			closed += float(nookSliceBitCount(fresh)) * counts;
#if NOOK_BENT
			lost = lost + nookSliceSum(fresh, first, end, turn) * counts;
#endif
		}
	}
	float whole = sqrt(square) * (turn.y + turn.z * turn.x);
	return vec4(whole * (1.0f - closed / 32.0f), whole, lost.x * sqrt(square), lost.y * sqrt(square));
}

// Slices are even around v, which points to the eye: the first of two axes across it, the other is cross(v, this).
vec3 nookSliceAcross(vec3 v)
{
	return vec3(v.z, 0.0f, -v.x) / sqrt(v.x * v.x + v.z * v.z);
}

// The azimuth of a slice as x, in parts of a half turn of which there are NOOK_SAMPLES, and the jitter of its steps as y.
vec2 nookSliceSample(ivec2 pixel, int i)
{
#if NOOK_TILED
	vec4 given = nookSample(nookVariant(pixel), i);
	return vec2(given.x * float(NOOK_SAMPLES), given.y);
#else
	int variant = nookSliceVariant(pixel);
	return vec2(float(i) + (float(variant) + 0.5f) / 16.0f, (float(nookSliceReverse(variant)) + 0.5f) / 16.0f);
#endif
}

// NOOK_SAMPLES slices, each with NOOK_STEPS depths on either side, near ones dense; slices are even around the view ray. w: what is
// open; with bent normals, xyz: the mean of the closed directions, by the cosine, each as long as it is closed.
vec4 nookSliceMean(ivec2 pixel, float depth)
{
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth);
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	vec3 sight = nookPosition(pixel, 0.0f) - nookPosition(pixel, 1.0f);
	vec3 v = sight / sqrt(dot(sight, sight));
	vec3 across = nookSliceAcross(v);
	vec3 up = cross(v, across);
	vec2 sum = vec2(0.0f, 0.0f);
	vec3 lost = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec2 own = nookSliceSample(pixel, i);
		float angle = own.x * 3.14159265f / float(NOOK_SAMPLES);
		vec3 o = across * cos(angle) + up * sin(angle);
		vec4 slice = nookSlice(pixel, n, centre, radius, scale, sight, v, o, own.y);
		sum = sum + vec2(slice.x, slice.y);
		lost = lost + o * slice.z + v * slice.w;
	}
	float open = sum.y > 0.0f ? sum.x / sum.y : 1.0f;
	lost = lost / max(sum.y, 1e-12f);
	return vec4(lost.x, lost.y, lost.z, open);
}

float nookSlices(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float open = nookSliceMean(pixel, depth).w;
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	return open;
}

// Visibility as w, and as xyz the mean of the open directions, by the cosine, each as long as it is open: all directions together,
// 2/3 of the normal, without those that are closed. Whatever its slices, a pixel of a plane has its normal. For a filter.
vec4 nookSlicesOpen(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return vec4(0.0f, 0.0f, 0.0f, 1.0f);
	}
	vec4 mean = nookSliceMean(pixel, depth);
	vec3 n = nookNormal(pixel);
	return vec4(n.x * 2.0f / 3.0f - mean.x, n.y * 2.0f / 3.0f - mean.y, n.z * 2.0f / 3.0f - mean.z, mean.w);
}
