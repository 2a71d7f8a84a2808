// Made by: nook pattern --domain ball --count 12
// Version: nook 0.1.0
// Measures: plane 0.0461607, noise 0.0427326, bias 0.0174567, plane_exact 0.0460069, greatest 0.235168, centre 4.41377e-09, spread 1.64294e-08, smallest_distance 0.774754, energy 81.6139, energy_exponent 3
// SPDX-License-Identifier: MIT
#ifndef NOOK_BALL12_H
#define NOOK_BALL12_H

#ifndef NOOK_MAYBE_UNUSED
#if defined(__GNUC__) || defined(__clang__)
#define NOOK_MAYBE_UNUSED __attribute__((unused))
#else
#define NOOK_MAYBE_UNUSED
#endif
#endif

#define NOOK_BALL12_COUNT 12 // samples

// x, y, z in the unit ball, weight; the weights sum to 1
NOOK_MAYBE_UNUSED static const float nook_ball12_points[NOOK_BALL12_COUNT][4] = {
	{0.27301726f, -0.44455883f, -0.5203414f, 0.083333336f},
	{0.23020115f, 0.69987327f, -0.0105354f, 0.083333336f},
	{-0.48932582f, 0.5045443f, -0.22118185f, 0.083333336f},
	{0.48932582f, -0.5045443f, 0.22118185f, 0.083333336f},
	{0.7013551f, 0.11329524f, -0.19542617f, 0.08333333f},
	{-0.27301726f, 0.44455883f, 0.5203414f, 0.083333336f},
	{-0.11286938f, -0.29981217f, 0.66355056f, 0.08333333f},
	{-0.23020115f, -0.69987327f, 0.010535393f, 0.083333336f},
	{-0.46286404f, -0.2027536f, -0.5362593f, 0.08333333f},
	{0.462864f, 0.2027536f, 0.5362593f, 0.083333336f},
	{-0.7013551f, -0.11329524f, 0.19542617f, 0.08333333f},
	{0.1128694f, 0.29981217f, -0.66355056f, 0.083333336f}
};

#endif // NOOK_BALL12_H
