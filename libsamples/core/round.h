// SPDX-License-Identifier: GPL-3.0-or-later
// Rounding to floats: the most that it does to a value, and the nearest float of a double.
#pragma once

namespace nook
{

// Relative: of 32-bit and of 16-bit floats.
inline constexpr double kUnitRoundoff = 0x1p-24;
inline constexpr double kHalfRoundoff = 0x1p-11;

// A double → the nearest 32-bit float, held in a double again.
// Plain casts are not enough: g++ 12 at -O2 and -O3 drops both of them where two neighbouring values are converted there and back
// (its vectoriser takes double → float → double of a pair for no change), so that a pattern would keep bits that no file holds.
// The volatile value keeps the conversion. Checked in tests/test_emit.cpp.
inline double roundToFloat(double value)
{
	const volatile float narrow = static_cast<float>(value);
	return static_cast<double>(narrow);
}

} // namespace nook
