// Made by: nook pattern --domain disk --count 9 --symmetric
// Version: nook 0.1.0
// Measures: plane 0.0179666, noise 0.0105553, bias 0.0145391, plane_exact 0.0178809, greatest 0.168743, cliff 0.0492446, cliff_greatest 0.183739, centre 7.45058e-09, crease 0.0307776, spread 0.176687, smallest_distance 0.504203, energy 106.473, energy_exponent 3
// SPDX-License-Identifier: MIT
#ifndef NOOK_DISK9_SYMMETRIC_H
#define NOOK_DISK9_SYMMETRIC_H

#ifndef NOOK_MAYBE_UNUSED
#if defined(__GNUC__) || defined(__clang__)
#define NOOK_MAYBE_UNUSED __attribute__((unused))
#else
#define NOOK_MAYBE_UNUSED
#endif
#endif

#define NOOK_DISK9_SYMMETRIC_COUNT 9 // samples

// x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1
NOOK_MAYBE_UNUSED static const float nook_disk9_symmetric_points[NOOK_DISK9_SYMMETRIC_COUNT][4] = {
	{0.0f, 0.0f, 1.0f, 0.16663848f},
	{0.64999133f, -0.10720851f, 0.7523414f, 0.10417019f},
	{-0.64999133f, 0.10720851f, 0.7523414f, 0.10417019f},
	{0.10720851f, 0.64999133f, 0.7523414f, 0.10417019f},
	{-0.10720851f, -0.64999133f, 0.7523414f, 0.10417019f},
	{-0.38380542f, 0.53542113f, 0.7523414f, 0.10417019f},
	{0.38380542f, -0.53542113f, 0.7523414f, 0.10417019f},
	{0.53542113f, 0.38380542f, 0.7523414f, 0.10417019f},
	{-0.53542113f, -0.38380542f, 0.7523414f, 0.10417019f}
};

#endif // NOOK_DISK9_SYMMETRIC_H
