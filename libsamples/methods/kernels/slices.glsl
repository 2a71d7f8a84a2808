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
	int own = ((cell.y & 3) * 4 + (cell.x & 3) + NOOK_VARIANT) & 15;
	int y = own >> 2;
	int either = own ^ y;
	return (either & 1) * 8 + (y & 1) * 4 + (either & 2) + (y >> 1);
}

// Reverses the four bits of that number. Both together are evenly distributed in two dimensions (Hammersley); the
// reversed one selects the jitter of the steps.
int nookSliceReverse(int variant)
{
	return (variant & 1) * 8 + (variant & 2) * 2 + ((variant >> 1) & 2) + (variant >> 3);
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

// Coefficients of t - sin(t) cos(t), the area that a chord cuts off the unit circle, divided by (1 - cos(t))^1.5, as a quadratic in
// 1 - cos(t). A minimax fit: the area is off by at most 0.012.
vec3 nookSliceSegment()
{
	return vec3(1.7659278f, -0.0540733f, -0.1357357f);
}

// Constants of a slice for nookSliceSector, from the sine and cosine of the angle of the normal from the eye. x: sectors per unit
// of the integral of the weight; y: 1/2 plus the number of sectors on the lower side of the direction to the eye; z: weight of all
// directions.
// The weight of a direction at the angle t from the eye is cos(t - angle) |sin t|. Its integral from the eye to t is
// sign(t) / 2 sin(t)^2 cos(angle) + (|t| - sin |t| cos t) / 2 sin(angle).
vec3 nookSliceSectors(float sine, float cosine)
{
	vec3 fit = nookSliceSegment();
	float below = 1.0f - sine;
	float above = 1.0f + sine;
	float plane = 0.5f * cosine * cosine * cosine;
	float lower = plane - 0.5f * sine * below * sqrt(below) * (fit.x + below * (fit.y + below * fit.z));
	float upper = plane + 0.5f * sine * above * sqrt(above) * (fit.x + above * (fit.y + above * fit.z));
	float whole = max(lower + upper, 1e-6f);
	float each = 31.0f / whole;
	return vec3(each, 0.5f + each * lower, whole);
}

// Numbers of the sectors of a slice, 31 of equal weight, that come before four directions, rounded: x and z on the positive side, y
// and w on the negative one. cosine: of their angles t to the eye; edge: 1 - cos(t) of the tangent plane; tilt: sectors.x times half
// the cosine of the normal's angle, negative on the negative side; fit: nookSliceSegment times sectors.x times half the sine;
// start: sectors.y.
ivec4 nookSliceSector(vec4 cosine, vec4 edge, vec4 tilt, vec3 fit, float start)
{
	vec4 less = min(1.0f - cosine, edge);
	vec4 curve = sqrt(abs(less)) * (fit.x + less * (fit.y + less * fit.z));
	return ivec4(start + less * (2.0f * tilt - tilt * less + curve));
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
#if NOOK_NATIVE_BITS
	return bitCount(bits);
#else
	uint pairs = bits - ((bits >> 1u) & 1431655765u);
	uint fours = (pairs & 858993459u) + ((pairs >> 2u) & 858993459u);
	uint eights = (fours + (fours >> 4u)) & 252645135u;
	return int((eights * 16843009u) >> 24u);
#endif
}

// Sine and cosine of the angle from the eye of the direction before which `share` of the weight of a slice lies. turn: as in
// nookSliceMeasure. The integral is close to a parabola at both ends, as that of the squared sine is; this gives a start for two
// steps of Newton's method, which are off by at most 0.03 degrees where the normal is within 69 degrees of the eye, and 0.4
// degrees at 86.
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
			vec2 moment = nookSliceMoment(nookSliceToward(float(i) / 31.0f, turn), turn);
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
// z and w: the sum of the covered directions, along the slice and to the eye. across, up, v: a frame, with v the unit vector to
// the eye; facing: the normal in that frame; azimuth: cosine and sine of the angle of the slice from `across`; sight: what a
// point on the line of sight moves by per metre toward the eye; jitter: in [0, 1).
// A surface covers the directions between it and a point behind it. The thickness is nook.slice_thickness at one radius and 1/32
// of that close by, since near surfaces mostly are thin. Outside the picture the nearest pixel is read, and has half the weight.
// Steps are placed at the cubes of evenly spaced numbers, so that they are dense near the pixel.
// A surface that covers a sector first has the weight 1 - distance / radius. The part of it that covers the sector lies between
// this step and the previous one, so the distance is 1/3 of that at this step plus 2/3 of that at the previous step. Where a
// sample lies beside the slice, by up to half a pixel or because the picture ends there, it keeps its height above the tangent
// plane, so that planes cover nothing. Moved into the slice at that height, a sample beside a grazing slice may end up on the
// other side: then it is ignored.
// Both sides are computed together, as x and y of vectors, and do not wait for each other.
vec4 nookSlice(ivec2 pixel, float depth, float radius, vec2 scale, vec3 sight, vec3 across, vec3 up, vec3 v, vec3 facing,
			   vec2 azimuth, float jitter)
{
	vec3 o = across * azimuth.x + up * azimuth.y;
	vec3 beside = across * azimuth.y - up * azimuth.x;
	vec2 within = vec2(facing.x * azimuth.x + facing.y * azimuth.y, facing.z);
	float square = max(dot(within, within), 1e-4f);
	float aside = (facing.x * azimuth.y - facing.y * azimuth.x) / square;
	float front = max(within.y, 0.0f);
	float size = max(sqrt(within.x * within.x + front * front), 1e-6f);
	float sine = within.x / size;
	float cosine = front / size;
	vec3 sectors = nookSliceSectors(sine, cosine);
	vec3 fit = nookSliceSegment() * (0.5f * sine * sectors.x);
	float tilted = 0.5f * cosine * sectors.x;
	vec3 bent = vec3(sine, cosine, 0.0f);
#if NOOK_BENT
	bent.z = nookSliceAngle(within.x, front);
#endif
	// A depth z seen (i, j) pixels away lies at -sight (z - depth) + radius w (texel.x i, texel.y j, 0) from the surface, with the
	// clip-space w at z. Its parts along the slice and to the eye, in radii, are linear in (i, j).
	vec2 texel = nookTexel() / radius;
	vec3 along = o + beside * (aside * within.x);
	vec3 toward = v + beside * (aside * within.y);
	vec2 x_of = vec2(along.x * texel.x, along.y * texel.y);
	vec2 y_of = vec2(toward.x * texel.x, toward.y * texel.y);
	vec4 around = nookAround(pixel);
	float deeper = sqrt(dot(sight, sight)) / radius;
	float level = deeper * depth;
	float deepest = min(depth + 8.0f * radius, NOOK_SKY);
	vec2 way = vec2((o.x - o.z * sight.x) * radius * scale.x, (o.z * sight.y - o.y) * radius * scale.y);
	float pixels = sqrt(dot(way, way));
	float behind = 0.03125f * nook.slice_thickness;
	float thicker = 0.96875f * nook.slice_thickness;
	vec2 start = vec2(jitter / float(NOOK_STEPS), (jitter + (jitter < 0.5f ? 0.5f : -0.5f)) / float(NOOK_STEPS));
	vec2 side = vec2(1.0f, -1.0f);
	vec4 edge = vec4(1.0f + sine, 1.0f - sine, 1.0f + sine, 1.0f - sine);
	vec4 tilt = vec4(tilted, -tilted, tilted, -tilted);
	// The surfaces of a step lie evenly between the previous step and itself. With up to four steps, which are far apart, rays agree
	// better where more of them lie at the previous one.
	float nearer = NOOK_STEPS > 4 ? 0.5f : 2.0f / 3.0f;
	float farther = NOOK_STEPS > 4 ? 0.5f : 1.0f / 3.0f;
	uint open = 2147483647u;
	float closed = 0.0f;
	float nearest = nookSliceStep(0.0f, pixels);
	vec2 before = vec2(nearest, nearest); // places of the previous steps
	vec2 lost = vec2(0.0f, 0.0f);
	for (int k = 0; k < NOOK_STEPS; ++k)
	{
		vec2 share = start + float(k) / float(NOOK_STEPS);
		vec2 place = nearest + (1.0f - nearest) * (share * share * share); // nookSliceStep
		vec2 wanted_x = 12582912.0f + way.x * (side * place); // as in nookNear
		vec2 wanted_y = 12582912.0f + way.y * (side * place);
		vec2 near_x = clamp(wanted_x, vec2(around.x, around.x), vec2(around.z, around.z));
		vec2 near_y = clamp(wanted_y, vec2(around.y, around.y), vec2(around.w, around.w));
		vec2 i = near_x - 12582912.0f;
		vec2 j = near_y - 12582912.0f;
		float positive = nookDepth(nookThere(pixel, vec2(near_x.x, near_y.x)));
		float negative = nookDepth(nookThere(pixel, vec2(near_x.y, near_y.y)));
		vec2 z = vec2(min(positive, deepest), min(negative, deepest));
		vec2 at = nook.w_slope * z + nook.w_start;
		vec2 x = at * (x_of.x * i + x_of.y * j); // exactly 0 for the pixel itself
		vec2 y = at * (y_of.x * i + y_of.y * j) + (level - deeper * z);
		vec2 squared = x * x + 1e-12f;
		vec2 apart = y * y + squared;
		vec2 inverse = 1.0f / sqrt(apart);
		vec2 distance = apart * inverse;
		vec2 back = y - (behind + thicker * distance);
		vec2 near = y * inverse;
		vec2 far = back / sqrt(back * back + squared);
		ivec4 sector = nookSliceSector(vec4(near.x, near.y, far.x, far.y), edge, tilt, fit, sectors.y);
		ivec2 first = ivec2(sector.x, min(sector.y, sector.w));
		ivec2 end = ivec2(max(sector.x, sector.z), sector.y);
		uint ahead = ((1u << uint(end.x)) - (1u << uint(first.x))) & open;
		ahead = z.x < deepest && apart.x < 1.0f && x.x > 0.0f ? ahead : 0u;
		open = open - ahead;
		uint opposite = ((1u << uint(end.y)) - (1u << uint(first.y))) & open;
		opposite = z.y < deepest && apart.y < 1.0f && x.y < 0.0f ? opposite : 0u;
		open = open - opposite;
		vec2 known = vec2(near_x.x == wanted_x.x && near_y.x == wanted_y.x ? 1.0f : 0.5f,
						  near_x.y == wanted_x.y && near_y.y == wanted_y.y ? 1.0f : 0.5f);
		vec2 counts = known * (1.0f - (farther + nearer * before / place) * distance);
		before = place;
		closed += float(nookSliceBitCount(ahead)) * counts.x;
		closed += float(nookSliceBitCount(opposite)) * counts.y;
#if NOOK_BENT
		lost = lost + nookSliceSum(ahead, first.x, end.x, bent) * counts.x;
		lost = lost + nookSliceSum(opposite, first.y, end.y, bent) * counts.y;
#endif
	}
	float whole = sqrt(square) * sectors.z;
	return vec4(whole * (1.0f - closed / 31.0f), whole, lost.x * sqrt(square), lost.y * sqrt(square));
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
vec4 nookSliceMean(ivec2 pixel, float depth, vec3 n)
{
	float radius = nookRadius(nook.radius, depth);
	vec2 scale = nookScale(depth);
	vec3 sight = nookSight(pixel);
	vec3 v = sight / sqrt(dot(sight, sight));
	vec3 across = nookSliceAcross(v);
	vec3 up = cross(v, across);
	vec3 facing = vec3(dot(n, across), dot(n, up), dot(n, v));
	vec2 sum = vec2(0.0f, 0.0f);
	vec3 lost = vec3(0.0f, 0.0f, 0.0f);
	for (int i = 0; i < NOOK_SAMPLES; ++i)
	{
		vec2 own = nookSliceSample(pixel, i);
		float angle = own.x * 3.14159265f / float(NOOK_SAMPLES);
		vec2 azimuth = vec2(cos(angle), sin(angle));
		vec4 slice = nookSlice(pixel, depth, radius, scale, sight, across, up, v, facing, azimuth, own.y);
		sum = sum + vec2(slice.x, slice.y);
		lost = lost + (across * azimuth.x + up * azimuth.y) * slice.z + v * slice.w;
	}
	float open = sum.y > 0.0f ? sum.x / sum.y : 1.0f;
	lost = lost / max(sum.y, 1e-12f);
	return vec4(lost.x, lost.y, lost.z, open);
}

// Visibility of a pixel by slices.
float nookSlices(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	vec3 n = nookNormal(pixel); // fetched together with the depth
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float open = nookSliceMean(pixel, depth, n).w;
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
	vec3 n = nookNormal(pixel);
	vec4 mean = nookSliceMean(pixel, depth, n);
	return vec4(n.x * 2.0f / 3.0f - mean.x, n.y * 2.0f / 3.0f - mean.y, n.z * 2.0f / 3.0f - mean.z, mean.w);
}
