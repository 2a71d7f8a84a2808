// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding to floats: error bounds, and the nearest float of a double.
#pragma once

namespace nook
{

// Relative error bounds of rounding to 32-bit and 16-bit floats.
inline constexpr double kUnitRoundoff = 0x1p-24;
inline constexpr double kHalfRoundoff = 0x1p-11;

// Rounds a double to the nearest 32-bit float, returned as a double.
// Plain casts are not enough: at -O2 and -O3 g++ 12 drops both casts when it vectorises two neighbouring conversions (double →
// float → double), so a pattern would keep bits that no file holds. The volatile value prevents that. Checked in
// tests/test_emit.cpp.
inline double roundToFloat(double value)
{
	const volatile float narrow = static_cast<float>(value);
	return static_cast<double>(narrow);
}

// std::bit_cast, which libc++ 13 lacks.

template <class To, class From> constexpr To bitsAs(const From& value)
{
	static_assert(sizeof(To) == sizeof(From));
	return __builtin_bit_cast(To, value);
}

// Range of lengths that can be rendered.

// The kernels square lengths and pixels per metre (pictures up to 65 536 pixels) in 32-bit floats.
inline constexpr double kLeastLength_m = 1e-12;
inline constexpr double kMostLength_m = 1e12;

inline bool isLength(double length_m) // false for NaN
{
	return length_m >= kLeastLength_m && length_m <= kMostLength_m;
}

// The z range that device depth 0 to 1 maps to.

enum class ClipRange
{
	minus_one_to_one, // z_ndc = 2 × device − 1: OpenGL's default
	zero_to_one,      // z_ndc = device: Direct3D, Vulkan, Metal, and reversed depth
};

} // namespace nook
