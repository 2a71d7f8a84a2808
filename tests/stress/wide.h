// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: N. J. Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 3.3 (running error
// analysis).
//
// The shared kernels, compiled with numbers of 80 bits that carry a bound on the rounding error of the same computation in 32 bits.
// Where a kernel compares two numbers, or rounds to a whole number, closer than that bound, the case is marked as unsure.
#pragma once

#include "methods/kernels.h"

#include <cmath>
#include <compare>
#include <type_traits>

namespace nook::stress
{

// Per thread, since the last reset: rounding decided a comparison; an intermediate result was NaN.
inline thread_local bool wide_unsure = false;
inline thread_local bool wide_broken = false;

inline constexpr double kUnit = 0x1p-24; // unit roundoff of 32-bit floats

struct Wide
{
	long double value;
	double error; // of the 32-bit computation, at most (first order)

	Wide() = default;                       // trivial, as glm's vectors need it
	Wide(float v) : value(v), error(0.0) {} // NOLINT: literals of the kernels are floats
	explicit Wide(int v) : value(v), error(std::abs(v) < (1 << 24) ? 0.0 : std::abs(static_cast<double>(v)) * kUnit) {}
	explicit Wide(unsigned v) : value(v), error(v < (1U << 24U) ? 0.0 : v * kUnit) {}
	Wide(long double v, double e) : value(v), error(e) {}

	// Truncation decides between two numbers, too.
	template <class Whole>
	requires std::is_same_v<Whole, int> || std::is_same_v<Whole, unsigned>
	explicit operator Whole() const
	{
		const auto most = static_cast<long double>(error);
		wide_unsure = wide_unsure || std::trunc(value - most) != std::trunc(value + most);
		return static_cast<Whole>(value);
	}
};

// A result of 32-bit arithmetic: adds half a unit of the last place, and what denormals lose. Exact operands: the actual rounding.
inline Wide rounded(long double value, double error)
{
	wide_broken = wide_broken || std::isnan(value);
	if (error == 0.0)
	{
		const double off = std::fabs(static_cast<double>(value - static_cast<long double>(static_cast<float>(value))));
		return {value, std::isnan(off) ? HUGE_VAL : off};
	}
	const double sum = error + std::fabs(static_cast<double>(value)) * kUnit + 1e-45;
	return {value, std::isnan(sum) ? HUGE_VAL : sum};
}

inline double sizeOf(const Wide& a)
{
	return std::fabs(static_cast<double>(a.value));
}

// A sum with 1.5 * 2^23, near which floats have a spacing of 1, is a whole number (nookNear).
inline constexpr long double kWholeNumbers = 0x1.8p23L;

inline Wide operator+(const Wide& a, const Wide& b)
{
	if (a.value == kWholeNumbers && std::fabs(b.value) < 0x1p22L)
	{
		const long double whole = std::nearbyint(b.value);
		wide_unsure = wide_unsure || std::fabs(static_cast<double>(b.value - whole)) + b.error >= 0.5;
		return {kWholeNumbers + whole, 0.0};
	}
	return rounded(a.value + b.value, a.error + b.error);
}
inline Wide operator-(const Wide& a)
{
	return {-a.value, a.error};
}
inline Wide operator-(const Wide& a, const Wide& b)
{
	return a + -b;
}
inline Wide operator*(const Wide& a, const Wide& b)
{
	return rounded(a.value * b.value, a.error * sizeOf(b) + b.error * sizeOf(a) + a.error * b.error);
}
inline Wide operator/(const Wide& a, const Wide& b)
{
	const long double quotient = a.value / b.value;
	const double least = sizeOf(b) - b.error;
	if (!(least > 0.0))
	{
		wide_broken = wide_broken || std::isnan(quotient);
		return {quotient, HUGE_VAL};
	}
	return rounded(quotient, (a.error + std::fabs(static_cast<double>(quotient)) * b.error) / least);
}
inline Wide& operator+=(Wide& a, const Wide& b)
{
	return a = a + b;
}
inline Wide& operator-=(Wide& a, const Wide& b)
{
	return a = a - b;
}
inline Wide& operator/=(Wide& a, const Wide& b)
{
	return a = a / b;
}
inline Wide& operator*=(Wide& a, const Wide& b)
{
	return a = a * b;
}

// Marks the case as unsure where 32 bits cannot tell the two apart. Equal numbers without error are equal in 32 bits, too.
inline void decide(const Wide& a, const Wide& b)
{
	const double errors = a.error + b.error;
	if (errors > 0.0 && !(std::fabs(static_cast<double>(a.value - b.value)) > errors))
	{
		wide_unsure = true;
	}
}

inline bool operator==(const Wide& a, const Wide& b)
{
	decide(a, b);
	return a.value == b.value;
}
inline std::partial_ordering operator<=>(const Wide& a, const Wide& b)
{
	decide(a, b);
	return a.value <=> b.value;
}

// Maximum and minimum are continuous, so either choice is right.
inline Wide max(const Wide& a, const Wide& b)
{
	if (std::fabs(static_cast<double>(a.value - b.value)) > a.error + b.error)
	{
		return a.value > b.value ? a : b;
	}
	return {std::fmax(a.value, b.value), std::fmax(a.error, b.error)};
}
inline Wide min(const Wide& a, const Wide& b)
{
	return -max(-a, -b);
}
inline Wide clamp(const Wide& a, const Wide& least, const Wide& most)
{
	Wide result = min(max(a, least), most);
	result.error = std::fmin(result.error, sizeOf(most - least) + least.error + most.error);
	return result;
}
inline Wide abs(const Wide& a)
{
	return {std::fabs(a.value), a.error};
}
inline Wide sqrt(const Wide& a)
{
	const long double root = std::sqrt(a.value);
	// |√(a + e) − √a| ≤ min(e / (2 √(a − e)), √e)
	const double least = static_cast<double>(a.value) - a.error;
	const double of_error =
		least > 0.0 ? std::fmin(0.5 * a.error / std::sqrt(least), std::sqrt(a.error)) : std::sqrt(a.error) * 1.5;
	return rounded(root, of_error);
}
inline Wide floor(const Wide& a)
{
	const long double whole = std::floor(a.value);
	const auto below = static_cast<double>(a.value - whole);
	if (a.error > 0.0 && (below <= a.error || 1.0 - below <= a.error))
	{
		wide_unsure = true;
	}
	return {whole, 0.0};
}
// Library functions are taken to be right to 4 units of the last place.
inline Wide exp(const Wide& a)
{
	const long double e = std::exp(a.value);
	return {e, static_cast<double>(e) * (std::expm1(std::fmin(a.error, 1.0)) + 4.0 * kUnit) + 1e-45};
}
inline Wide log2(const Wide& a)
{
	if (a.value == 1.0L && a.error == 0.0)
	{
		return {0.0L, 0.0};
	}
	const long double l = std::log2(a.value);
	return {l, 1.5 * a.error / std::fmax(sizeOf(a) - a.error, 1e-300) + 4.0 * kUnit * std::fabs(static_cast<double>(l)) + 1e-45};
}
inline Wide pow(const Wide& a, const Wide& b)
{
	const long double p = std::pow(a.value, b.value);
	const auto size = static_cast<double>(p);
	const long double above = std::pow(a.value + static_cast<long double>(a.error), b.value) - p;
	const long double below = p - std::pow(std::fmax(a.value - static_cast<long double>(a.error), 0.0L), b.value);
	const auto to = static_cast<double>(std::fmax(std::fabs(above), std::fabs(below)));
	return {p, to + size * 16.0 * kUnit * (1.0 + sizeOf(b)) + 1e-45};
}
inline Wide sin(const Wide& a)
{
	return {std::sin(a.value), a.error + 4.0 * kUnit};
}
inline Wide cos(const Wide& a)
{
	return {std::cos(a.value), a.error + 4.0 * kUnit};
}

// Vectors are glm's. These overloads are more specialised than glm's own, which accept standard numbers only.
template <int n> using WideVec = glm::vec<n, Wide, glm::defaultp>;

template <int n, class F> WideVec<n> mapped(WideVec<n> a, const WideVec<n>& b, F f)
{
	for (int i = 0; i < n; ++i)
	{
		a[i] = f(a[i], b[i]);
	}
	return a;
}
template <int n> WideVec<n> operator*(const WideVec<n>& a, float s)
{
	return a * Wide(s);
}
template <int n> WideVec<n> operator*(float s, const WideVec<n>& a)
{
	return Wide(s) * a;
}
template <int n> WideVec<n> operator/(float s, const WideVec<n>& a)
{
	return Wide(s) / a;
}
template <int n> WideVec<n> operator+(float s, const WideVec<n>& a)
{
	return Wide(s) + a;
}
template <int n> WideVec<n> operator+(const WideVec<n>& a, float s)
{
	return a + Wide(s);
}
template <int n> WideVec<n> operator-(float s, const WideVec<n>& a)
{
	return Wide(s) - a;
}
template <int n> WideVec<n> operator-(const WideVec<n>& a, float s)
{
	return a - Wide(s);
}
template <int n> WideVec<n> sqrt(const WideVec<n>& a)
{
	return mapped(a, a, [](const Wide& p, const Wide&) { return sqrt(p); });
}
template <int n> WideVec<n> abs(const WideVec<n>& a)
{
	return mapped(a, a, [](const Wide& p, const Wide&) { return abs(p); });
}
template <int n> WideVec<n> floor(const WideVec<n>& a)
{
	return mapped(a, a, [](const Wide& p, const Wide&) { return floor(p); });
}
template <int n> WideVec<n> min(const WideVec<n>& a, const WideVec<n>& b)
{
	return mapped(a, b, [](const Wide& p, const Wide& q) { return min(p, q); });
}
template <int n> WideVec<n> max(const WideVec<n>& a, const WideVec<n>& b)
{
	return mapped(a, b, [](const Wide& p, const Wide& q) { return max(p, q); });
}
template <int n> WideVec<n> clamp(const WideVec<n>& a, const WideVec<n>& least, const WideVec<n>& most)
{
	return min(max(a, least), most);
}
inline WideVec<3> cross(const WideVec<3>& a, const WideVec<3>& b)
{
	return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <int n> Wide dot(const WideVec<n>& a, const WideVec<n>& b)
{
	if constexpr (n == 4)
	{
		return a.x * b.x + a.y * b.y + (a.z * b.z + a.w * b.w);
	}
	Wide sum = a.x * b.x + a.y * b.y;
	if constexpr (n == 3)
	{
		sum += a.z * b.z;
	}
	return sum;
}

#if defined(__clang__)
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wkeyword-macro"
#endif
// ShadeBlock in wide numbers, with the same member names.
struct WideBlock
{
	using vec2 = WideVec<2>;
	using vec3 = WideVec<3>;
	using vec4 = WideVec<4>;
	using ivec2 = glm::ivec2;

	explicit WideBlock(const ShadeBlock& narrow) : from(narrow) {}

	const ShadeBlock from;
#define float Wide
#define NOOK_FIELD(type, name, meaning) type name{from.name};
	NOOK_MODULE_MEMBERS(NOOK_FIELD)
	NOOK_OWN_MEMBERS(NOOK_FIELD)
#undef NOOK_FIELD
#undef float
#define NOOK_FIELD(name, value, meaning) int name = from.name;
	NOOK_SHADE_CONSTANTS(NOOK_FIELD)
#undef NOOK_FIELD
};

namespace wide_kernels
{

using glm::clamp;
using glm::ivec2;
using glm::ivec3;
using glm::ivec4;
using glm::max;
using glm::min;
using glm::uint;
using glm::uvec4;
using stress::clamp;
using stress::max;
using stress::min;
using vec2 = WideVec<2>;
using vec3 = WideVec<3>;
using vec4 = WideVec<4>;

// The twin of shade_kernels::Kernels, whose pictures it reads.
class Kernels
{
public:
	explicit Kernels(const shade_kernels::Kernels& kernels) : nook(kernels.nook), m_kernels(kernels) {}

	WideBlock nook;

#define float Wide

	float nookDepth(ivec2 pixel) const
	{
		return m_kernels.nookDepth(pixel);
	}
	vec3 nookNormal(ivec2 pixel) const
	{
		return vec3(m_kernels.nookNormal(pixel));
	}
	int nookVariant(ivec2 pixel) const
	{
		return m_kernels.nookVariant(pixel);
	}
	vec4 nookSample(int row, int i) const
	{
		return vec4(m_kernels.nookSample(row, i));
	}
	float nookVisibility(ivec2 cell) const
	{
		return m_kernels.nookVisibility(cell);
	}
	vec4 nookPacked(ivec2 cell) const
	{
		return vec4(m_kernels.nookPacked(cell));
	}
	vec4 nookLevel(ivec2 texel, int level) const
	{
		return vec4(m_kernels.nookLevel(texel, level));
	}
	uvec4 nookTable(ivec2 texel, int table) const
	{
		return m_kernels.nookTable(texel, table);
	}
	vec4 nookRange(int i) const
	{
		return vec4(m_kernels.nookRange(i));
	}

	static uint floatBitsToUint(const Wide& value)
	{
		return bitsAs<uint>(static_cast<decltype(0.0F)>(value.value));
	}
	static Wide uintBitsToFloat(uint bits)
	{
		return bitsAs<decltype(0.0F)>(bits);
	}
	static int bitCount(uint bits)
	{
		return shade_kernels::Kernels::bitCount(bits);
	}

#include "methods/twins/alchemy.h"
#include "methods/twins/aov_sparse.h"
#include "methods/twins/camera.h"
#include "methods/twins/depth.h"
#include "methods/twins/depth_levels.h"
#include "methods/twins/published_bitmask.h"
#include "methods/twins/published_crytek.h"
#include "methods/twins/published_gtao.h"
#include "methods/twins/published_hbao.h"
#include "methods/twins/published_sao.h"
#include "methods/twins/published_volumetric.h"
#include "methods/twins/reconstruct.h"
#include "methods/twins/shape.h"
#include "methods/twins/slices.h"
#include "methods/twins/statvo.h"
#include "methods/twins/statvo_tables.h"
#include "methods/twins/tables.h"
#include "methods/twins/vo.h"
#include "methods/twins/vo_area.h"
#include "methods/twins/vo_sum.h"

#undef float

private:
	const shade_kernels::Kernels& m_kernels;
};

} // namespace wide_kernels
} // namespace nook::stress
#if defined(__clang__)
#pragma clang diagnostic pop
#endif
