// Made by: nook pattern --domain disk --count 9 --symmetric
// Version: nook 0.1.0
// Measures: plane 0.0179666, noise 0.0105553, bias 0.0145391, plane_exact 0.0178809, greatest 0.168743, cliff 0.0492446, cliff_greatest 0.183739, centre 7.45058e-09, crease 0.0307776, spread 0.176687, smallest_distance 0.504203, energy 106.473, energy_exponent 3
// SPDX-License-Identifier: MIT
// Include it in a shader of GLSL 1.30, GLSL ES 3.00 or later; older versions have no constant arrays and get none.
#ifndef NOOK_DISK9_SYMMETRIC_GLSL
#define NOOK_DISK9_SYMMETRIC_GLSL
#if __VERSION__ >= 130

#define NOOK_DISK9_SYMMETRIC_COUNT 9 // samples

// x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1
const highp vec4 nook_disk9_symmetric_points[NOOK_DISK9_SYMMETRIC_COUNT] = vec4[NOOK_DISK9_SYMMETRIC_COUNT](
	vec4(0.0, 0.0, 1.0, 0.16663848),
	vec4(0.64999133, -0.10720851, 0.7523414, 0.10417019),
	vec4(-0.64999133, 0.10720851, 0.7523414, 0.10417019),
	vec4(0.10720851, 0.64999133, 0.7523414, 0.10417019),
	vec4(-0.10720851, -0.64999133, 0.7523414, 0.10417019),
	vec4(-0.38380542, 0.53542113, 0.7523414, 0.10417019),
	vec4(0.38380542, -0.53542113, 0.7523414, 0.10417019),
	vec4(0.53542113, 0.38380542, 0.7523414, 0.10417019),
	vec4(-0.53542113, -0.38380542, 0.7523414, 0.10417019)
);

#endif
#endif // NOOK_DISK9_SYMMETRIC_GLSL
