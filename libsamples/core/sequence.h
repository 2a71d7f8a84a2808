// SPDX-License-Identifier: GPL-3.0-or-later
// Low-discrepancy sequences.
#pragma once

#include <cmath>

namespace nook
{

// Halton's sequence in one dimension, in (0, 1): the digits of index (from 1) in `base`, mirrored at the point.
inline double radicalInverse(unsigned index, unsigned base)
{
	double result = 0.0;
	double digit = 1.0 / base;
	for (; index > 0; index /= base)
	{
		result += digit * (index % base);
		digit /= base;
	}
	return result;
}

// Fractional part, in [0, 1).
inline double fraction(double x)
{
	return x - std::floor(x);
}

} // namespace nook
