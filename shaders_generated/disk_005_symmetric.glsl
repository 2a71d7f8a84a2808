// Made by: nook pattern --domain disk --count 5 --symmetric
// Version: nook 0.1.0
// Measures: plane 0.032388, noise 0.0278491, bias 0.016535, plane_exact 0.0323349, greatest 0.279876, cliff 0.076984, cliff_greatest 0.294872, centre 7.45058e-09, crease 0.0532995, spread 0.0137834, smallest_distance 0.650081, energy 20.6176, energy_exponent 3
// SPDX-License-Identifier: MIT
// Include it in a shader of GLSL 1.30, GLSL ES 3.00 or later; older versions have no constant arrays and get none.
#ifndef NOOK_DISK5_SYMMETRIC_GLSL
#define NOOK_DISK5_SYMMETRIC_GLSL
#if __VERSION__ >= 130

#define NOOK_DISK5_SYMMETRIC_COUNT 5 // samples

// x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1
const highp vec4 nook_disk5_symmetric_points[NOOK_DISK5_SYMMETRIC_COUNT] = vec4[NOOK_DISK5_SYMMETRIC_COUNT](
	vec4(0.0, 0.0, 1.0, 0.19448666),
	vec4(0.47331598, 0.44561976, 0.7598651, 0.20137833),
	vec4(-0.47331598, -0.44561976, 0.7598651, 0.20137833),
	vec4(-0.44561976, 0.47331598, 0.7598651, 0.20137833),
	vec4(0.44561976, -0.47331598, 0.7598651, 0.20137833)
);

#endif
#endif // NOOK_DISK5_SYMMETRIC_GLSL
