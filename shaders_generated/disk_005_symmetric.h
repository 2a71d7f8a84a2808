// Made by: nook pattern --domain disk --count 5 --symmetric
// Version: nook 0.1.0
// Measures: plane 0.032388, noise 0.0278491, bias 0.016535, plane_exact 0.0323349, greatest 0.279876, cliff 0.076984, cliff_greatest 0.294872, centre 7.45058e-09, crease 0.0532995, spread 0.0137834, smallest_distance 0.650081, energy 20.6176, energy_exponent 3
// SPDX-License-Identifier: MIT
#ifndef NOOK_DISK5_SYMMETRIC_H
#define NOOK_DISK5_SYMMETRIC_H

#ifndef NOOK_MAYBE_UNUSED
#if defined(__GNUC__) || defined(__clang__)
#define NOOK_MAYBE_UNUSED __attribute__((unused))
#else
#define NOOK_MAYBE_UNUSED
#endif
#endif

#define NOOK_DISK5_SYMMETRIC_COUNT 5 // samples

// x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1
NOOK_MAYBE_UNUSED static const float nook_disk5_symmetric_points[NOOK_DISK5_SYMMETRIC_COUNT][4] = {
	{0.0f, 0.0f, 1.0f, 0.19448666f},
	{0.47331598f, 0.44561976f, 0.7598651f, 0.20137833f},
	{-0.47331598f, -0.44561976f, 0.7598651f, 0.20137833f},
	{-0.44561976f, 0.47331598f, 0.7598651f, 0.20137833f},
	{0.44561976f, -0.47331598f, 0.7598651f, 0.20137833f}
};

#endif // NOOK_DISK5_SYMMETRIC_H
