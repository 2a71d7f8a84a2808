// Made by: nook pattern --domain ball --count 12
// Version: nook 0.1.0
// Measures: plane 0.0461607, noise 0.0427326, bias 0.0174567, plane_exact 0.0460069, greatest 0.235168, centre 4.41377e-09, spread 1.64294e-08, smallest_distance 0.774754, energy 81.6139, energy_exponent 3
// SPDX-License-Identifier: MIT
// Include it in a shader of GLSL 1.30, GLSL ES 3.00 or later; older versions have no constant arrays and get none.
#ifndef NOOK_BALL12_GLSL
#define NOOK_BALL12_GLSL
#if __VERSION__ >= 130

#define NOOK_BALL12_COUNT 12 // samples

// x, y, z in the unit ball, weight; the weights sum to 1
const highp vec4 nook_ball12_points[NOOK_BALL12_COUNT] = vec4[NOOK_BALL12_COUNT](
	vec4(0.27301726, -0.44455883, -0.5203414, 0.083333336),
	vec4(0.23020115, 0.69987327, -0.0105354, 0.083333336),
	vec4(-0.48932582, 0.5045443, -0.22118185, 0.083333336),
	vec4(0.48932582, -0.5045443, 0.22118185, 0.083333336),
	vec4(0.7013551, 0.11329524, -0.19542617, 0.08333333),
	vec4(-0.27301726, 0.44455883, 0.5203414, 0.083333336),
	vec4(-0.11286938, -0.29981217, 0.66355056, 0.08333333),
	vec4(-0.23020115, -0.69987327, 0.010535393, 0.083333336),
	vec4(-0.46286404, -0.2027536, -0.5362593, 0.08333333),
	vec4(0.462864, 0.2027536, 0.5362593, 0.083333336),
	vec4(-0.7013551, -0.11329524, 0.19542617, 0.08333333),
	vec4(0.1128694, 0.29981217, -0.66355056, 0.083333336)
);

#endif
#endif // NOOK_BALL12_GLSL
