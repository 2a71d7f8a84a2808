// SPDX-License-Identifier: GPL-3.0-or-later
// Four numbers, vectors or points at once, in vector types of GCC and Clang.
#pragma once

#include "core/math.h"

#include <glm/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace nook
{

using Floats = float __attribute__((vector_size(16)));
using Ints = int32_t __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(32)));

struct Vectors
{
	Floats x;
	Floats y;
	Floats z;
};

inline Floats dotOf(const Vectors& a, const Vectors& b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}

inline Vectors operator*(const Vectors& a, const Floats& b)
{
	return {a.x * b, a.y * b, a.z * b};
}

inline Vectors allOf(glm::vec3 v)
{
	return {Floats{} + v.x, Floats{} + v.y, Floats{} + v.z};
}

inline Floats magnitudeOf(const Floats& v)
{
	return v < 0.0F ? -v : v;
}

inline bool anyOf(const Ints& lanes)
{
	const auto halves = bitsAs<std::array<uint64_t, 2>>(lanes);
	return (halves[0] | halves[1]) != 0;
}

inline Floats rootOf(const Floats& a)
{
	return Floats{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

// nookUnit()
inline Floats unitOf(const Vectors& a)
{
	return 1.0F / rootOf(dotOf(a, a) > 1e-30F ? dotOf(a, a) : Floats{} + 1e-30F);
}

// The lanes of both in a row, without the first.
inline Floats nextOf(const Floats& a, const Floats& b)
{
	return Floats{a[1], a[2], a[3], b[0]};
}

inline Vectors nextOf(const Vectors& a, const Vectors& b)
{
	return {nextOf(a.x, b.x), nextOf(a.y, b.y), nextOf(a.z, b.z)};
}

inline void setLane(Vectors& to, std::size_t lane, glm::vec3 v)
{
	to.x[lane] = v.x;
	to.y[lane] = v.y;
	to.z[lane] = v.z;
}

inline glm::vec3 laneOf(const Vectors& a, std::size_t lane)
{
	return {a.x[lane], a.y[lane], a.z[lane]};
}

inline Vectors chosen(const Ints& which, const Vectors& a, const Vectors& b)
{
	return {which ? a.x : b.x, which ? a.y : b.y, which ? a.z : b.z};
}

// Points relative to the centre of all corners, to 48 bits.
struct Points
{
	Vectors high;
	Vectors low;
};

inline void setLane(Points& points, std::size_t lane, glm::dvec3 point)
{
	const glm::vec3 high(point);
	setLane(points.high, lane, high);
	setLane(points.low, lane, glm::vec3(point - glm::dvec3(high)));
}

inline Vectors operator-(const Points& a, const Points& b)
{
	return {(a.high.x - b.high.x) + (a.low.x - b.low.x), (a.high.y - b.high.y) + (a.low.y - b.low.y),
			(a.high.z - b.high.z) + (a.low.z - b.low.z)};
}

} // namespace nook
