// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers of 80 bits that know by how much the same computation in 32 bits may be off (running error analysis: N. J. Higham,
// "Accuracy and Stability of Numerical Algorithms", 2002, 3.3): wherever a kernel compares or rounds to a whole number, what comes
// out may differ in 32 bits if the two sides are closer than that, and the case is marked as unsure.
//
// The shared kernels are compiled with these numbers in place of floats (wide_kernels.h): a twin that does the same steps, exactly.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <type_traits>

namespace nook::stress
{

// Since they were last reset, did rounding decide anything; was any number on the way none. One a thread.
inline thread_local bool wide_unsure = false;
inline thread_local bool wide_broken = false;

inline constexpr double kUnit = 0x1p-24; // unit roundoff of 32-bit floats

struct Wide
{
	long double value = 0.0L;
	double error = 0.0; // of the 32-bit computation, at most (first order)

	Wide() = default;
	Wide(float v) : value(v) {} // NOLINT: literals of the kernels are floats
	explicit Wide(int v) : value(v), error(std::abs(v) < (1 << 24) ? 0.0 : std::abs(static_cast<double>(v)) * kUnit) {}
	explicit Wide(unsigned v) : value(v), error(v < (1U << 24U) ? 0.0 : v * kUnit) {}
	Wide(long double v, double e) : value(v), error(e) {}

	// Cut off, which is a decision as well.
	template <class Whole>
	requires std::is_same_v<Whole, int> || std::is_same_v<Whole, unsigned>
	explicit operator Whole() const
	{
		const auto most = static_cast<long double>(error);
		wide_unsure = wide_unsure || std::trunc(value - most) != std::trunc(value + most);
		return static_cast<Whole>(value);
	}
};

// A result of 32-bit arithmetic: half a unit of the last place more, and what becomes of denormals. Of exact numbers, what rounding
// really does.
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

inline Wide operator+(const Wide& a, const Wide& b)
{
	return rounded(a.value + b.value, a.error + b.error);
}
inline Wide operator-(const Wide& a, const Wide& b)
{
	return rounded(a.value - b.value, a.error + b.error);
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
inline Wide operator-(const Wide& a)
{
	return {-a.value, a.error};
}
inline Wide& operator+=(Wide& a, const Wide& b)
{
	return a = a + b;
}
inline Wide& operator-=(Wide& a, const Wide& b)
{
	return a = a - b;
}
inline Wide& operator*=(Wide& a, const Wide& b)
{
	return a = a * b;
}

// Marks the case where the two are too close to be told apart in 32 bits; equal and without error they are equal there, too.
inline void decide(const Wide& a, const Wide& b)
{
	const double errors = a.error + b.error;
	if (errors > 0.0 && !(std::fabs(static_cast<double>(a.value - b.value)) > errors))
	{
		wide_unsure = true;
	}
}

inline bool operator<(const Wide& a, const Wide& b)
{
	decide(a, b);
	return a.value < b.value;
}
inline bool operator>(const Wide& a, const Wide& b)
{
	return b < a;
}
inline bool operator<=(const Wide& a, const Wide& b)
{
	decide(a, b);
	return a.value <= b.value;
}
inline bool operator>=(const Wide& a, const Wide& b)
{
	return b <= a;
}
inline bool operator==(const Wide& a, const Wide& b)
{
	decide(a, b);
	return a.value == b.value;
}

// Continuous: no decision, whichever is taken.
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
// Of functions of the library, 4 units of the last place.
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
	const double to = static_cast<double>(std::pow(a.value + static_cast<long double>(a.error), b.value) - p);
	return {p, std::fabs(to) + size * 16.0 * kUnit * (1.0 + sizeOf(b)) + 1e-45};
}
inline Wide sin(const Wide& a)
{
	return {std::sin(a.value), a.error + 4.0 * kUnit};
}
inline Wide cos(const Wide& a)
{
	return {std::cos(a.value), a.error + 4.0 * kUnit};
}

// Vectors, as far as the kernels use them.
struct WideVec2
{
	Wide x, y;

	WideVec2() = default;
	WideVec2(Wide x_, Wide y_) : x(x_), y(y_) {}
	explicit WideVec2(const glm::ivec2& v) : x(v.x), y(v.y) {}
	explicit WideVec2(const glm::vec2& v) : x(v.x), y(v.y) {}
	template <class F> WideVec2 map(const WideVec2& o, F f) const
	{
		return {f(x, o.x), f(y, o.y)};
	}
	static WideVec2 of(const Wide& s)
	{
		return {s, s};
	}
};
struct WideVec3
{
	Wide x, y, z;

	WideVec3() = default;
	WideVec3(Wide x_, Wide y_, Wide z_) : x(x_), y(y_), z(z_) {}
	explicit WideVec3(const glm::vec3& v) : x(v.x), y(v.y), z(v.z) {}
	template <class F> WideVec3 map(const WideVec3& o, F f) const
	{
		return {f(x, o.x), f(y, o.y), f(z, o.z)};
	}
	static WideVec3 of(const Wide& s)
	{
		return {s, s, s};
	}
};
struct WideVec4
{
	Wide x, y, z, w;

	WideVec4() = default;
	WideVec4(Wide x_, Wide y_, Wide z_, Wide w_) : x(x_), y(y_), z(z_), w(w_) {}
	explicit WideVec4(const glm::vec4& v) : x(v.x), y(v.y), z(v.z), w(v.w) {}
	template <class F> WideVec4 map(const WideVec4& o, F f) const
	{
		return {f(x, o.x), f(y, o.y), f(z, o.z), f(w, o.w)};
	}
	static WideVec4 of(const Wide& s)
	{
		return {s, s, s, s};
	}
};

template <class V>
concept WideVector = std::is_same_v<V, WideVec2> || std::is_same_v<V, WideVec3> || std::is_same_v<V, WideVec4>;

template <WideVector V> V operator+(const V& a, const V& b)
{
	return a.map(b, [](const Wide& p, const Wide& q) { return p + q; });
}
template <WideVector V> V operator-(const V& a, const V& b)
{
	return a.map(b, [](const Wide& p, const Wide& q) { return p - q; });
}
template <WideVector V> V operator*(const V& a, const Wide& s)
{
	return a.map(V::of(s), [](const Wide& p, const Wide& q) { return p * q; });
}
template <WideVector V> V operator*(const Wide& s, const V& a)
{
	return a * s;
}
template <WideVector V> V operator/(const V& a, const Wide& s)
{
	return a.map(V::of(s), [](const Wide& p, const Wide& q) { return p / q; });
}
template <WideVector V> V operator*(const V& a, const V& b)
{
	return a.map(b, [](const Wide& p, const Wide& q) { return p * q; });
}
template <WideVector V> V operator/(const V& a, const V& b)
{
	return a.map(b, [](const Wide& p, const Wide& q) { return p / q; });
}
template <WideVector V> V abs(const V& a)
{
	return a.map(a, [](const Wide& p, const Wide&) { return abs(p); });
}
inline WideVec3 cross(const WideVec3& a, const WideVec3& b)
{
	return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <WideVector V> V operator-(const V& a)
{
	return a.map(a, [](const Wide& p, const Wide&) { return -p; });
}
template <WideVector V> V& operator+=(V& a, const V& b)
{
	return a = a + b;
}
template <WideVector V> V min(const V& a, const V& b)
{
	return a.map(b, [](const Wide& p, const Wide& q) { return min(p, q); });
}
template <WideVector V> V max(const V& a, const V& b)
{
	return a.map(b, [](const Wide& p, const Wide& q) { return max(p, q); });
}
template <WideVector V> V clamp(const V& a, const V& least, const V& most)
{
	return min(max(a, least), most);
}
template <WideVector V> V floor(const V& a)
{
	return a.map(a, [](const Wide& p, const Wide&) { return floor(p); });
}
inline Wide dot(const WideVec2& a, const WideVec2& b)
{
	return a.x * b.x + a.y * b.y;
}
inline Wide dot(const WideVec3& a, const WideVec3& b)
{
	return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Wide dot(const WideVec4& a, const WideVec4& b)
{
	return a.x * b.x + a.y * b.y + (a.z * b.z + a.w * b.w);
}

} // namespace nook::stress
