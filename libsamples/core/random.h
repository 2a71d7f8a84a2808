// SPDX-License-Identifier: GPL-3.0-or-later
// Seeded random numbers: the same sequence on every compiler and library.
// This work is based on: M. O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms
// for Random Number Generation", 2014 (the generator XSH-RR 64/32).
#pragma once

#include <cmath>
#include <cstdint>

namespace nook
{

// The finaliser of SplitMix64 (G. Steele, D. Lea, C. Flood, "Fast Splittable Pseudorandom Number Generators", 2014): each bit of
// the input changes about half of the bits of the result.
inline uint64_t mixBits(uint64_t x)
{
	x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9ULL;
	x = (x ^ (x >> 27U)) * 0x94d049bb133111ebULL;
	return x ^ (x >> 31U);
}

// The number at an index of SplitMix64's sequence that starts at a seed.
inline uint64_t splitMix(uint64_t seed, uint64_t index)
{
	return mixBits(seed + 0x9e3779b97f4a7c15ULL * (index + 1));
}

class Random
{
public:
	// Generators with different streams are independent under the same seed.
	explicit Random(uint64_t seed, uint64_t stream = 0) : m_increment((stream << 1U) | 1U)
	{
		next();
		m_state += seed;
		next();
	}

	// 32 uniform bits.
	uint32_t next()
	{
		const uint64_t old = m_state;
		m_state = old * 6364136223846793005ULL + m_increment;
		const auto shifted = static_cast<uint32_t>(((old >> 18U) ^ old) >> 27U);
		const auto turn = static_cast<uint32_t>(old >> 59U);
		return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
	}

	// Uniform in [0, 1), 53 bits.
	double uniform()
	{
		const uint64_t high = next() >> 5U;
		const uint64_t low = next() >> 6U;
		return static_cast<double>((high << 26U) | low) * 0x1p-53;
	}

	// Uniform integer in [0, bound), bound ≥ 1, without the bias of a plain remainder.
	uint32_t below(uint32_t bound)
	{
		const uint32_t threshold = (0U - bound) % bound;
		for (;;)
		{
			const uint32_t r = next();
			if (r >= threshold)
			{
				return r % bound;
			}
		}
	}

private:
	uint64_t m_state = 0;
	uint64_t m_increment;
};

// Low-discrepancy sequences.

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
