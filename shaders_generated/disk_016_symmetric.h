// Made by: nook pattern --domain disk --count 16 --symmetric
// Version: nook 0.1.0
// Measures: plane 0.010163, noise 0.00755294, bias 0.00680004, plane_exact 0.0101946, greatest 0.106427, cliff 0.0316316, cliff_greatest 0.122627, centre 1.39016e-17, crease 0.0129281, spread 0.0780503, smallest_distance 0.34162, energy 543.73, energy_exponent 3
// SPDX-License-Identifier: MIT
#ifndef NOOK_DISK16_SYMMETRIC_H
#define NOOK_DISK16_SYMMETRIC_H

#ifndef NOOK_MAYBE_UNUSED
#if defined(__GNUC__) || defined(__clang__)
#define NOOK_MAYBE_UNUSED __attribute__((unused))
#else
#define NOOK_MAYBE_UNUSED
#endif
#endif

#define NOOK_DISK16_SYMMETRIC_COUNT 16 // samples

// x, y, half length of the line sqrt(1 - x^2 - y^2), weight; the weights sum to 1
NOOK_MAYBE_UNUSED static const float nook_disk16_symmetric_points[NOOK_DISK16_SYMMETRIC_COUNT][4] = {
	{-0.3034077f, 0.1558026f, 0.9400369f, 0.06841151f},
	{0.3034077f, -0.1558026f, 0.9400369f, 0.06841151f},
	{-0.72999686f, 0.19345267f, 0.6555003f, 0.058360003f},
	{0.72999686f, -0.19345267f, 0.6555003f, 0.058360003f},
	{-0.038065452f, 0.7587064f, 0.65031964f, 0.05629023f},
	{0.038065452f, -0.7587064f, 0.65031964f, 0.05629023f},
	{0.28628963f, 0.18538861f, 0.9400369f, 0.06841151f},
	{-0.28628963f, -0.18538861f, 0.9400369f, 0.06841151f},
	{-0.47009322f, 0.5859907f, 0.66002065f, 0.060642175f},
	{0.47009322f, -0.5859907f, 0.66002065f, 0.060642175f},
	{0.4090801f, 0.6301002f, 0.66002065f, 0.060642175f},
	{-0.4090801f, -0.6301002f, 0.66002065f, 0.060642175f},
	{-0.01726798f, 0.3441789f, 0.93874526f, 0.0688824f},
	{0.01726798f, -0.3441789f, 0.93874526f, 0.0688824f},
	{0.7069681f, 0.2655474f, 0.6555003f, 0.058360003f},
	{-0.7069681f, -0.2655474f, 0.6555003f, 0.058360003f}
};

#endif // NOOK_DISK16_SYMMETRIC_H
