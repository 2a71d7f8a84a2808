// SPDX-License-Identifier: GPL-3.0-or-later
// Mean distances that make up the squared error: from a sample to the domain (U) and between two samples (K). For energy.cpp.
#pragma once

#include "core/math.h"

#include <algorithm>
#include <array>

#include <glm/vec3.hpp>

namespace nook::kernels
{

// ---- Mean distance from a sample to the domain, by the sample's squared radius (hemisphere: by its height).

struct Potential
{
	double value;
	double slope; // derivative by r²; for the hemisphere by z
};

// Ball: E|x − Y| = 3/4 + r²/2 − r⁴/20. Disk: its mean over the line |z| ≤ a, a² = 1 − r².
inline Potential ballPotential(double r2)
{
	return {0.75 + 0.5 * r2 - 0.05 * r2 * r2, 0.5 - 0.1 * r2};
}

inline Potential linePotential(double r2)
{
	const double a2 = 1.0 - r2;
	const double fourth = r2 * r2 + 2.0 / 3.0 * r2 * a2 + 0.2 * a2 * a2;
	const double fourth_slope = 2.0 * r2 + 2.0 / 3.0 * (1.0 - 2.0 * r2) - 0.4 * a2;
	return {0.75 + 0.5 * (r2 + a2 / 3.0) - 0.05 * fourth, 1.0 / 3.0 - 0.05 * fourth_slope};
}

// Plane distances to the projected ball: (π/2) times the mean over φ of E|s − Y₁| = 3/8 + ¾s² − s⁴/8, s = r cos φ.
inline Potential cliffPotential(double r2)
{
	return {0.5 * kPi * (0.375 + 0.375 * r2 - 3.0 / 64.0 * r2 * r2), 0.5 * kPi * (0.375 - 3.0 / 32.0 * r2)};
}

// Hemisphere: |x − y| and the clamped cosine expanded in Legendre polynomials (Funk–Hecke). The terms decay like n^−4.5.
inline constexpr int kLegendreTerms = 160;

struct CosineSeries
{
	std::array<double, kLegendreTerms + 1> coefficient{};
	double self = 0.0; // E|Y − Y'|
};

inline CosineSeries makeCosineSeries()
{
	CosineSeries series;
	double even = 0.125; // ∫₀¹ t P_n dt for n = 2, then by its two-term recurrence
	for (int n = 0; n <= kLegendreTerms; ++n)
	{
		double projection = n == 0 ? 0.5 : n == 1 ? 1.0 / 3.0 : 0.0;
		if (n >= 2 && n % 2 == 0)
		{
			projection = even;
			even *= -(n - 1.0) / (n + 4.0);
		}
		const double eigenvalue = -16.0 / ((2.0 * n - 1.0) * (2.0 * n + 1.0) * (2.0 * n + 3.0)); // divided by π
		const auto k = static_cast<std::size_t>(n);
		series.coefficient[k] = 0.5 * (2.0 * n + 1.0) * projection * eigenvalue;
		series.self += series.coefficient[k] * 2.0 * projection;
	}
	return series;
}

inline const CosineSeries& cosineSeries()
{
	static const CosineSeries series = makeCosineSeries();
	return series;
}

inline Potential hemispherePotential(double z)
{
	const CosineSeries& series = cosineSeries();
	double p0 = 1.0; // P_{n−1}, P_n and their derivatives
	double p1 = z;
	double d0 = 0.0;
	double d1 = 1.0;
	Potential sum{series.coefficient[0] + series.coefficient[1] * z, series.coefficient[1]};
	for (int n = 2; n <= kLegendreTerms; ++n)
	{
		const double p2 = ((2.0 * n - 1.0) * z * p1 - (n - 1.0) * p0) / n;
		const double d2 = d0 + (2.0 * n - 1.0) * p1;
		p0 = p1;
		p1 = p2;
		d0 = d1;
		d1 = d2;
		sum.value += series.coefficient[static_cast<std::size_t>(n)] * p1;
		sum.slope += series.coefficient[static_cast<std::size_t>(n)] * d1;
	}
	return sum;
}

// ---- Mean distance between two samples.

struct PairDistance
{
	double value;
	double by_rho2; // ∂/∂ρ², ρ the distance in the plane (points: the distance)
	double by_a;    // ∂/∂ the first line's half length
	double by_b;    // ∂/∂ the second's
};

// Mean of √(ρ² + (z−z')²) over |z| ≤ a, |z'| ≤ b: [G(a+b) − G(a−b)]/(2ab), G'' = √(ρ² + t²),
// G = s³/6 + ρ²(tL − s)/2, s = √(ρ²+t²), L = asinh(t/ρ).
struct Antiderivative
{
	double value;
	double slope; // derivative by t
	double by_rho2;
};

inline Antiderivative antiderivative(double rho2, double inverse_rho, double t)
{
	const double s = std::sqrt(rho2 + t * t);
	const double l = logOf((t + s) * inverse_rho);
	const double tls = t * l - s;
	return {s * s * s / 6.0 + 0.5 * rho2 * tls, 0.5 * (t * s + rho2 * l), 0.5 * tls};
}

inline constexpr double kShortLine =
	1e-4; // below this half length the closed form loses precision, and a line equals a point to 1e-9
inline constexpr double kLeastRho2 = 1e-24; // keeps the logarithm finite where its factor is 0

inline PairDistance longLineDistance(double rho2, double a, double b)
{
	rho2 = rho2 < kLeastRho2 ? kLeastRho2 : rho2;
	const double inverse_rho = 1.0 / std::sqrt(rho2);
	const Antiderivative plus = antiderivative(rho2, inverse_rho, a + b);
	const Antiderivative minus = antiderivative(rho2, inverse_rho, std::fabs(a - b));
	const double minus_slope = a < b ? -minus.slope : minus.slope;
	const double scale = 0.5 / (a * b);
	const double value = scale * (plus.value - minus.value);
	return {value, scale * (plus.by_rho2 - minus.by_rho2), scale * (plus.slope - minus_slope) - value / a,
			scale * (plus.slope + minus_slope) - value / b};
}

inline PairDistance lineDistance(double rho2, double a, double b)
{
	if (a >= kShortLine && b >= kShortLine)
	{
		return longLineDistance(rho2, a, b);
	}
	// One line is a point: the mean of √(ρ² + z²) over the other, or just ρ.
	rho2 = std::max(rho2, kLeastRho2);
	const double t = std::max(a, b);
	if (t < kShortLine)
	{
		const double rho = std::sqrt(rho2);
		return {rho, 0.5 / rho, 0.0, 0.0};
	}
	const Antiderivative g = antiderivative(rho2, 1.0 / std::sqrt(rho2), t);
	const double l = (2.0 * g.by_rho2 + std::sqrt(rho2 + t * t)) / t;
	const double value = g.slope / t;
	const double by_t = (std::sqrt(rho2 + t * t) - value) / t;
	return {value, 0.5 * l / t, a < b ? 0.0 : by_t, a < b ? by_t : 0.0};
}

inline PairDistance pointDistance(double rho2)
{
	const double rho = std::sqrt(rho2);
	return {rho, rho > 0.0 ? 0.5 / rho : 0.0, 0.0, 0.0};
}

// Mean distance between random points of two spheres of radii r and s around the origin: r + s²/(3r) for r ≥ s; derivative by r².
inline PairDistance shellDistance(double r2, double s2)
{
	const double r = std::sqrt(r2);
	const double s = std::sqrt(s2);
	if (r >= s)
	{
		return r > 0.0 ? PairDistance{r + s2 / (3.0 * r), (0.5 - s2 / (6.0 * r2)) / r, 0.0, 0.0} : PairDistance{0.0, 0.0, 0.0, 0.0};
	}
	return {s + r2 / (3.0 * s), 1.0 / (3.0 * s), 0.0, 0.0};
}

// Slices, written like the others: K = −2 Π (3/2 − d (1 − d)) over both periodic axes, whose mean is −2 (4/3)².
inline constexpr double kTorusMean = 16.0 / 9.0;

struct TorusDistance
{
	double value;
	glm::dvec3 gradient; // by the difference
};

inline TorusDistance torusDistance(const glm::dvec3& difference)
{
	const double x = difference.x - std::floor(difference.x); // 0 to 1
	const double y = difference.y - std::floor(difference.y);
	const double along_x = 1.5 - x * (1.0 - x);
	const double along_y = 1.5 - y * (1.0 - y);
	return {-2.0 * along_x * along_y, {2.0 * (1.0 - 2.0 * x) * along_y, 2.0 * (1.0 - 2.0 * y) * along_x, 0.0}};
}

} // namespace nook::kernels

namespace nook
{

// Many pairs of lines at once, with the bits of the functions above. A weight is the line's weight times the pair's.
struct LinePairs
{
	static constexpr std::size_t kMost = 64;

	template <class T> using Of = std::array<T, kMost>;
	Of<double> rho2; // squared distance in the plane
	Of<double> half_a, half_b;
	Of<double> weight_a, weight_b;

	// Results: the distance K, and the growth of w_b K along a's point (its gradient is −along_a · (p_a − p_b) + turn_a · p_a) and
	// of w_a K along b's.
	Of<double> distance;
	Of<double> along_a, along_b;
	Of<double> turn_a, turn_b;
};

// Computes the first `count` pairs; the values after them are unspecified.
void findTerms(LinePairs& pairs, std::size_t count);

} // namespace nook
