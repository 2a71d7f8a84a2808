// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths that pictures may be made of.
#pragma once

namespace nook
{

// The kernels square lengths, and pixels a metre of a picture of 65 536 pixels, in 32-bit floats.
inline constexpr double kLeastLength_m = 1e-12;
inline constexpr double kMostLength_m = 1e12;

inline bool isLength(double length_m) // false for NaN
{
	return length_m >= kLeastLength_m && length_m <= kMostLength_m;
}

} // namespace nook
