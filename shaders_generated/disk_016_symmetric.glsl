// Made by: nook pattern --domain disk --count 16 --symmetric
// Version: nook 0.1.0
// Measures: plane 0.010163, noise 0.00755294, bias 0.00680004, plane_exact 0.0101946, greatest 0.106427, cliff 0.0316316, cliff_greatest 0.122627, centre 1.39016e-17, crease 0.0129281, spread 0.0780503, smallest_distance 0.34162, energy 543.73, energy_exponent 3
// SPDX-License-Identifier: MIT
// Include it in a shader of GLSL 1.30, GLSL ES 3.00 or later; older versions have no constant arrays and get none.
#ifndef NOOK_DISK16_SYMMETRIC_GLSL
#define NOOK_DISK16_SYMMETRIC_GLSL
#if __VERSION__ >= 130

#define NOOK_DISK16_SYMMETRIC_COUNT 16 // samples

// x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1
const highp vec4 nook_disk16_symmetric_points[NOOK_DISK16_SYMMETRIC_COUNT] = vec4[NOOK_DISK16_SYMMETRIC_COUNT](
	vec4(-0.3034077, 0.1558026, 0.9400369, 0.06841151),
	vec4(0.3034077, -0.1558026, 0.9400369, 0.06841151),
	vec4(-0.72999686, 0.19345267, 0.6555003, 0.058360003),
	vec4(0.72999686, -0.19345267, 0.6555003, 0.058360003),
	vec4(-0.038065452, 0.7587064, 0.65031964, 0.05629023),
	vec4(0.038065452, -0.7587064, 0.65031964, 0.05629023),
	vec4(0.28628963, 0.18538861, 0.9400369, 0.06841151),
	vec4(-0.28628963, -0.18538861, 0.9400369, 0.06841151),
	vec4(-0.47009322, 0.5859907, 0.66002065, 0.060642175),
	vec4(0.47009322, -0.5859907, 0.66002065, 0.060642175),
	vec4(0.4090801, 0.6301002, 0.66002065, 0.060642175),
	vec4(-0.4090801, -0.6301002, 0.66002065, 0.060642175),
	vec4(-0.01726798, 0.3441789, 0.93874526, 0.0688824),
	vec4(0.01726798, -0.3441789, 0.93874526, 0.0688824),
	vec4(0.7069681, 0.2655474, 0.6555003, 0.058360003),
	vec4(-0.7069681, -0.2655474, 0.6555003, 0.058360003)
);

#endif
#endif // NOOK_DISK16_SYMMETRIC_GLSL
