// SPDX-License-Identifier: MIT
// Visibility by slices: planes that contain the view ray, each with a bit mask of the directions in it that are covered.
// This work is based on: O. Therrien, Y. Levesque, G. Gilet, "Screen Space Indirect Lighting with Visibility Bitmask", The
// Visual Computer 39 (2023), for the masks and the thickness; J. Jimenez, X. Wu, A. Pesce, A. Jarabo, "Practical Real-Time
// Strategies for Accurate Indirect Occlusion", SIGGRAPH 2016 courses, for the slices. Additions of nook: bits of equal weight,
// the falloff, and slices spaced evenly around the view ray.

// Without a tile: number of a pixel in its window of 4 x 4 cells, 0 to 15, which selects the azimuth of its slices. The numbers
// form a Bayer matrix, so that neighbours differ as much as possible.
int nookSliceVariant(ivec2 pixel)
{
	ivec2 cell = ivec2(pixel.x / NOOK_CELL, nookRow(pixel.y) / NOOK_CELL);
	int own = ((cell.y % 4) * 4 + cell.x % 4 + NOOK_VARIANT) % 16;
	int x = own % 4;
	int y = own / 4;
	return 4 * (2 * ((x + y) % 2) + y % 2) + 2 * ((x / 2 + y / 2) % 2) + y / 2;
}

// Reverses the four bits of that number. Both together are evenly distributed in two dimensions (Hammersley); the
// reversed one selects the jitter of the steps.
int nookSliceReverse(int variant)
{
	return 8 * (variant % 2) + 4 * ((variant / 2) % 2) + 2 * ((variant / 4) % 2) + variant / 8;
}

// Angle from the y axis toward the x axis, -pi to pi. It is off by at most 1e-5, and the same on every renderer, unlike atan.
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

// Integral of the weight of the directions in a slice, from the direction to the eye as far as the direction (x, y); y points
// to the eye. It is negative where x is.
// The weight of a direction at angle t from the eye is cos(t - angle) |sin t|, where turn = (sine, cosine, value of `angle`)
// and `angle` is that of the normal within the slice. The integral is sign(t) / 4 (cos(angle) - cos(2 t - angle)) + |t| / 2
// sin(angle).
float nookSliceMeasure(float x, float y, vec3 turn)
{
	float square = x * x + y * y;
	float sign = x < 0.0f ? -1.0f : 1.0f;
	float doubled = ((y * y - x * x) * turn.y + 2.0f * x * y * turn.x) / square;
	return 0.25f * sign * (turn.y - doubled) + 0.5f * abs(nookSliceAngle(x, y)) * turn.x;
}

// Share of the open directions of a slice, weighted by their cosine to the normal, that come before the direction (x, y). side:
// 1 for a direction on the positive half of the slice, -1 for the other.
float nookSliceShare(float x, float y, float side, vec3 turn)
{
	if (x * turn.x + y * turn.y <= 0.0f)
	{
		return side < 0.0f ? 0.0f : 1.0f; // below the tangent plane
	}
	float first = 0.5f * (turn.y - (1.57079633f - turn.z) * turn.x);
	return clamp((nookSliceMeasure(x, y, turn) + first) / (turn.y + turn.z * turn.x), 0.0f, 1.0f);
}

// The lowest `end` bits, set.
uint nookSliceBitsBelow(int end)
{
	if (end > 31)
	{
		return 4294967295u;
	}
	return (1u << uint(end)) - 1u;
}

// Number of bits that are set.
int nookSliceBitCount(uint bits)
{
	uint pairs = bits - ((bits >> 1u) & 1431655765u);
	uint fours = (pairs & 858993459u) + ((pairs >> 2u) & 858993459u);
	uint eights = (fours + (fours >> 4u)) & 252645135u;
	return int((eights * 16843009u) >> 24u);
}

// Sine and cosine of the angle from the eye of the direction before which `share` of a slice lies: the inverse of
// nookSliceShare. turn: as in nookSliceMeasure. The integral is close to a parabola at both ends, as that of the squared sine
// is; this gives a start for two steps of Newton's method, which are off by at most 0.03 degrees where the normal is within 69
// degrees of the eye, and 0.4 degrees at 86.
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

// Integral of the weight times the direction, from the direction to the eye as far as the direction `toward`: components along
// the slice and to the eye.
vec2 nookSliceMoment(vec2 toward, vec3 turn)
{
	float x = toward.x * toward.x * toward.x;
	float y = toward.y * toward.y * toward.y;
	float sign = toward.x < 0.0f ? -1.0f : 1.0f;
	return vec2(turn.y * x + turn.x * (2.0f - 3.0f * toward.y + y), turn.y * (1.0f - y) + turn.x * x) * (sign / 3.0f);
}

// Sums that integral over the directions whose bits from first to end - 1 are set, one run of bits at a time.
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

// Where a step reads depth, as a share of the length of a slice in the picture, `pixels`. `part`, in [0, 1), is a share of the
// way that remains after the first 1.3 pixels: closer than that, the half pixel by which a sample may miss the slice would tilt
// what it sees too much (a remedy of XeGTAO).
float nookSliceStep(float part, float pixels)
{
	float first = 1.3f / max(pixels, 1.3f);
	return first + (1.0f - first) * part;
}

// Evaluates one slice. Returns x: the weight of its open directions, y: the weight of all its directions; for bent normals also
// z and w: the sum of the covered directions, along the slice and to the eye. o: direction of the slice across the view ray, a
// unit vector; v: unit vector to the eye; jitter: in [0, 1).
// A surface at q covers the directions between q and the point behind it, on its line of sight, at the distance of its
// thickness. The thickness is nook.slice_thickness at one radius and 1/32 of that close by, since near surfaces mostly are
// thin. Outside the picture the nearest pixel is read, and has half the weight. Steps are placed at the cubes of evenly spaced
// numbers, so that they are dense near the pixel.
// A surface that covers a bit first has the weight 1 - distance / radius. The part of it that covers the bit lies between this
// step and the previous one, so the distance is 1/3 of that at this step plus 2/3 of that at the previous step. Where a sample
// lies beside the slice, by up to half a pixel or because the picture ends there, it keeps its height above the tangent plane,
// so that planes cover nothing.
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
		// Moved into the slice at its height, a sample beside a grazing slice may end up on the other side: then it is ignored.
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

// First of two axes across v, the direction to the eye, around which slices are evenly spaced; the other one is cross(v, this).
vec3 nookSliceAcross(vec3 v)
{
	return vec3(v.z, 0.0f, -v.x) / sqrt(v.x * v.x + v.z * v.z);
}

// Azimuth of a slice as x, in units of half a turn divided by the number of slices, NOOK_SAMPLES; jitter of its steps as y.
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

// Mean over the slices of a pixel, NOOK_SAMPLES slices with NOOK_STEPS depths on either side. w: visibility; for bent normals
// xyz: the mean of the covered directions, weighted by their cosine.
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

// Visibility of a pixel by slices.
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

// Visibility as w; as xyz the mean of the open directions, weighted by their cosine: that of all directions, 2/3 of the normal,
// minus that of the covered ones. On a plane it points along the normal whatever slices the pixel has. For a filter.
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
