// SPDX-License-Identifier: GPL-3.0-or-later
// Elementary functions made only of + − × ÷ and √, which IEEE 754 rounds the same way everywhere.
// The C library's sin, log and pow differ in the last bit between versions and processors, and over thousands of relaxation
// steps that bit leads to another pattern. The error bounds are checked in tests/test_core.cpp.
#pragma once

#include "core/round.h"

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <numbers>

namespace nook
{

inline constexpr double kPi = std::numbers::pi;

// Natural logarithm of a positive, finite, normal number; relative error below 4e-16 (absolute near 1).
inline double logOf(double x)
{
	const auto bits = bitsAs<uint64_t>(x);
	// Builds the number without an int conversion, which few processors have for vectors: 2⁵² + exponent, less 2⁵².
	double exponent = bitsAs<double>((bits >> 52U) | 0x4330000000000000ULL) - (0x1p52 + 1023.0);
	double m = bitsAs<double>((bits & 0x000fffffffffffffULL) | 0x3ff0000000000000ULL); // in [1, 2)
	const bool is_large = m > std::numbers::sqrt2;
	m *= is_large ? 0.5 : 1.0;
	exponent += is_large ? 1.0 : 0.0;
	// log m = 2 atanh f = 2 (f + f³/3 + …), |f| ≤ 0.172, so the term after f²¹ is below 1e-17.
	const double f = (m - 1.0) / (m + 1.0);
	const double s = f * f;
	double sum = 1.0 / 21.0;
	for (const double coefficient :
		 {1.0 / 19.0, 1.0 / 17.0, 1.0 / 15.0, 1.0 / 13.0, 1.0 / 11.0, 1.0 / 9.0, 1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0})
	{
		sum = sum * s + coefficient;
	}
	// ln 2 in two parts: the high one has 21 trailing zero bits, so exponent × high is exact.
	const double ln2_high = 0x1.62e42fee00000p-1;
	const double ln2_low = 0x1.a39ef35793c76p-33;
	return exponent * ln2_high + (2.0 * f * sum + exponent * ln2_low);
}

// e^x for |x| < 700; relative error below 4e-16.
inline double expOf(double x)
{
	const double k = std::floor(x * std::numbers::log2e + 0.5);
	const double r = (x - k * 0x1.62e42fee00000p-1) - k * 0x1.a39ef35793c76p-33;
	double sum = 1.0; // Taylor to r¹⁴/14!, |r| ≤ 0.347
	for (const double inverse : {1.0 / 14, 1.0 / 13, 1.0 / 12, 1.0 / 11, 1.0 / 10, 1.0 / 9, 1.0 / 8, 1.0 / 7, 1.0 / 6, 1.0 / 5,
								 1.0 / 4, 1.0 / 3, 1.0 / 2, 1.0})
	{
		sum = 1.0 + sum * (r * inverse);
	}
	return sum * bitsAs<double>(static_cast<uint64_t>(static_cast<int64_t>(k) + 1023) << 52U);
}

// x^p for a positive x.
inline double powOf(double x, double p)
{
	return expOf(p * logOf(x));
}

struct SinCos
{
	double sin;
	double cos;
};

// Sine and cosine of an angle in radians, |angle| < 1e5; absolute error below 4e-16.
inline SinCos sinCosOf(double angle_rad)
{
	const double quarter = std::floor(angle_rad * (2.0 / kPi) + 0.5);
	const double r = (angle_rad - quarter * 0x1.921fb54400000p+0) - quarter * 0x1.0b4611a626331p-34;
	const double s = r * r;
	double sine = 1.0; // Taylor to r¹⁷ and r¹⁸, |r| ≤ π/4
	for (const double inverse : {1.0 / 272, 1.0 / 210, 1.0 / 156, 1.0 / 110, 1.0 / 72, 1.0 / 42, 1.0 / 20, 1.0 / 6})
	{
		sine = 1.0 - sine * (s * inverse);
	}
	sine *= r;
	double cosine = 1.0;
	for (const double inverse : {1.0 / 306, 1.0 / 240, 1.0 / 182, 1.0 / 132, 1.0 / 90, 1.0 / 56, 1.0 / 30, 1.0 / 12, 1.0 / 2})
	{
		cosine = 1.0 - cosine * (s * inverse);
	}
	switch (static_cast<int64_t>(quarter) & 3)
	{
	case 0: return {sine, cosine};
	case 1: return {cosine, -sine};
	case 2: return {-sine, -cosine};
	default: return {-cosine, sine};
	}
}

// Angle of (x, y) in (−π, π]; atan2Of(0, 0) is 0. Relative error below 1e-15.
inline double atan2Of(double y, double x)
{
	const double ax = std::fabs(x);
	const double ay = std::fabs(y);
	const double large = ax > ay ? ax : ay;
	if (large == 0.0)
	{
		return 0.0;
	}
	double t = (ax > ay ? ay : ax) / large; // in [0, 1]
	// Two half-angle steps bring t below tan(π/16); the series then needs terms to t²³.
	t = t / (1.0 + std::sqrt(1.0 + t * t));
	t = t / (1.0 + std::sqrt(1.0 + t * t));
	const double s = t * t;
	double sum = 1.0 / 23.0;
	for (const double coefficient :
		 {1.0 / 21, 1.0 / 19, 1.0 / 17, 1.0 / 15, 1.0 / 13, 1.0 / 11, 1.0 / 9, 1.0 / 7, 1.0 / 5, 1.0 / 3, 1.0})
	{
		sum = coefficient - sum * s;
	}
	double angle = 4.0 * t * sum;
	if (ay > ax)
	{
		angle = 0.5 * kPi - angle;
	}
	if (x < 0.0)
	{
		angle = kPi - angle;
	}
	return y < 0.0 ? -angle : angle;
}

// Inverse sine; clamps arguments that rounding carried past ±1.
inline double asinOf(double x)
{
	const double c2 = (1.0 - x) * (1.0 + x);
	return atan2Of(x, c2 > 0.0 ? std::sqrt(c2) : 0.0);
}

} // namespace nook
