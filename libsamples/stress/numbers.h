// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers of all sizes, and those that break things: ±0, denormals, powers of two, numbers beside each other.
#pragma once

#include "core/random.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace nook::stress
{

inline constexpr double kDecades = 26.575424759098897; // log2(10⁸)

// From 2^least to 2^most, as likely in each octave: (1 + f) 2^e, so that all machines agree without a power function.
inline double octaves(Random& random, double least, double most)
{
	const double exponent = least + (most - least) * random.uniform();
	const double whole = std::floor(exponent);
	return std::ldexp(1.0 + (exponent - whole), static_cast<int>(whole));
}

// 10^U(−8, 8).
inline double anySize(Random& random)
{
	return octaves(random, -kDecades, kDecades);
}

inline double between(Random& random, double least, double most)
{
	return least + (most - least) * random.uniform();
}

inline double signOf(Random& random)
{
	return random.below(2) == 0 ? 1.0 : -1.0;
}

// A coordinate around `size`: mostly anything up to it, sometimes ±0, a denormal, a power of two, exactly the size.
inline float hardFloat(Random& random, double size)
{
	switch (random.below(16))
	{
	case 0: return random.below(2) == 0 ? 0.0F : -0.0F;
	case 1: return std::bit_cast<float>(1U + random.below(0x7fffffU)) * static_cast<float>(signOf(random));
	case 2: return static_cast<float>(std::ldexp(signOf(random), static_cast<int>(std::floor(std::log2(size)))));
	case 3: return static_cast<float>(signOf(random) * size);
	case 4: return static_cast<float>(signOf(random) * size * octaves(random, -kDecades, 0.0));
	default: return static_cast<float>(between(random, -size, size));
	}
}

inline glm::dvec3 randomDirection(Random& random)
{
	glm::dvec3 v;
	do
	{
		v = 2.0 * glm::dvec3(random.uniform(), random.uniform(), random.uniform()) - 1.0;
	} while (glm::dot(v, v) > 1.0 || glm::dot(v, v) < 1e-4);
	return glm::normalize(v);
}

// A unit direction; one in four along an axis, or almost.
inline glm::dvec3 hardDirection(Random& random)
{
	glm::dvec3 v = randomDirection(random);
	if (random.below(4) == 0)
	{
		const double off = random.below(2) == 0 ? 0.0 : octaves(random, -kDecades, -3.0);
		const auto axis = static_cast<int>(random.below(3));
		const double sign = signOf(random);
		v *= off;
		v[axis] = sign;
	}
	return glm::normalize(v);
}

} // namespace nook::stress
