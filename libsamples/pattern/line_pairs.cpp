// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled with -fno-trapping-math (CMakeLists.txt), so that both sides of a condition may be evaluated and the loops vectorise.

#include "pattern/energy_kernels.h"

namespace nook
{
namespace
{

constexpr std::size_t kVector = 8; // pairs; a partial vector takes as long as a full one

[[gnu::always_inline]] inline void setTerms(LinePairs& pairs, std::size_t i, const kernels::PairDistance& k)
{
	pairs.distance[i] = k.value;
	pairs.along_a[i] = 2.0 * pairs.weight_b[i] * k.by_rho2;
	pairs.along_b[i] = 2.0 * pairs.weight_a[i] * k.by_rho2;
	pairs.turn_a[i] = pairs.weight_b[i] * k.by_a / pairs.half_a[i];
	pairs.turn_b[i] = pairs.weight_a[i] * k.by_b / pairs.half_b[i];
}

[[gnu::always_inline]] inline void findLong(LinePairs& pairs, std::size_t count)
{
	for (std::size_t i = 0; i < count; ++i)
	{
		setTerms(pairs, i, kernels::longLineDistance(pairs.rho2[i], pairs.half_a[i], pairs.half_b[i]));
	}
}

[[gnu::flatten]] void findLongPlain(LinePairs& pairs, std::size_t count)
{
	findLong(pairs, count);
}

// Twice the width that every x86-64 processor has. On Windows g++ does not align the stack for it.
#if defined(__x86_64__) && !defined(_WIN32)
[[gnu::flatten, gnu::target("avx2")]] void findLongWide(LinePairs& pairs, std::size_t count)
{
	findLong(pairs, count);
}

bool hasWide()
{
	static const bool has = __builtin_cpu_supports("avx2") != 0;
	return has;
}
#else
bool hasWide()
{
	return false;
}

void findLongWide(LinePairs& pairs, std::size_t count)
{
	findLong(pairs, count);
}
#endif

// Handles pairs where one line is a point.
void findShort(LinePairs& pairs, std::size_t i)
{
	setTerms(pairs, i, kernels::lineDistance(pairs.rho2[i], pairs.half_a[i], pairs.half_b[i]));
	pairs.turn_a[i] = pairs.half_a[i] > 0.0 ? pairs.turn_a[i] : 0.0;
	pairs.turn_b[i] = pairs.half_b[i] > 0.0 ? pairs.turn_b[i] : 0.0;
}

} // namespace

void findTerms(LinePairs& pairs, std::size_t count)
{
	const std::size_t filled = (count + kVector - 1) / kVector * kVector;
	for (std::size_t i = count; i < filled; ++i)
	{
		pairs.rho2[i] = pairs.half_a[i] = pairs.half_b[i] = pairs.weight_a[i] = pairs.weight_b[i] = 1.0;
	}
	hasWide() ? findLongWide(pairs, filled) : findLongPlain(pairs, filled);
	for (std::size_t i = 0; i < count; ++i)
	{
		if (!(pairs.half_a[i] >= kernels::kShortLine && pairs.half_b[i] >= kernels::kShortLine))
		{
			findShort(pairs, i);
		}
	}
}

} // namespace nook
