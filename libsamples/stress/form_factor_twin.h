// SPDX-License-Identifier: GPL-3.0-or-later
// A slow and obvious twin of methods/kernels/form_factor.glsl in numbers of any precision, and polygons that are hard for 32 bits.
#pragma once

#include "core/random.h"
#include "stress/numbers.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nook::stress
{

template <class T> using Vector = std::array<T, 3>;

template <class T> T dotOf(const Vector<T>& a, const Vector<T>& b)
{
	return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class T> Vector<T> crossOf(const Vector<T>& a, const Vector<T>& b)
{
	return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Vector<long double> wideOf(const glm::vec3& v)
{
	return {v.x, v.y, v.z};
}
inline Vector<long double> wideOf(const glm::dvec3& v)
{
	return {v.x, v.y, v.z};
}

// AOV eq. 4 with the arc tangent, of the polygon that the tangent plane leaves (Sutherland and Hodgman), absolute.
template <class T, class Corner> T referenceFormFactor(const std::vector<Corner>& corners, const glm::vec3& normal)
{
	using std::atan2;
	using std::sqrt;
	const auto wide = [](const auto& v)
	{
		return Vector<T>{T(v.x), T(v.y), T(v.z)};
	};
	Vector<T> n = wide(normal);
	const T size = sqrt(dotOf(n, n));
	for (T& component : n)
	{
		component /= size;
	}
	std::vector<Vector<T>> kept;
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const Vector<T> a = wide(corners[i]);
		const Vector<T> b = wide(corners[(i + 1) % corners.size()]);
		const T ha = dotOf(a, n);
		const T hb = dotOf(b, n);
		if (ha >= 0)
		{
			kept.push_back(a);
		}
		if ((ha > 0 && hb < 0) || (ha < 0 && hb > 0))
		{
			const T share = ha / (ha - hb);
			kept.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])});
		}
	}
	T sum = 0;
	for (std::size_t i = 0; i < kept.size(); ++i)
	{
		const Vector<T>& a = kept[i];
		const Vector<T>& b = kept[(i + 1) % kept.size()];
		const Vector<T> c = crossOf(a, b);
		const T length = sqrt(dotOf(c, c));
		if (length > 0)
		{
			sum += atan2(length, dotOf(a, b)) * dotOf(n, c) / length;
		}
	}
	const T pi = atan2(T(0), T(-1));
	return (sum < 0 ? -sum : sum) / (2 * pi);
}

// A convex polygon around its receiver, which is at the origin.
struct HardPolygon
{
	std::vector<glm::vec3> corners; // metres
	glm::vec3 normal{0, 0, 1};      // of the receiver
	float side = 1.0F;              // 1: the receiver is in front
	double size_m = 1.0;            // of the polygon
	double away_m = 1.0;            // no nearer to the polygon than this
};

// Kinds: 0 anything; 1 needles of down to 1e-7 of their length; 2 the receiver in line with an edge, or over a corner; 3 in the
// polygon's plane, or almost; 4 normals at right angles to the polygon, or with corners in the tangent plane; 5 close to a large
// one.
inline constexpr int kHardKinds = 6;

inline double logUniform(Random& random, double least, double most)
{
	return least * std::pow(most / least, random.uniform());
}

// In the polygon's frame: across, across, height.
inline glm::dvec3 hardReceiver(Random& random, int kind, double size_m, const std::vector<glm::dvec2>& outline)
{
	const double far = size_m * logUniform(random, kind == 5 ? 1e-4 : 0.05, kind == 5 ? 0.1 : 100.0);
	glm::dvec3 at = far * randomDirection(random);
	at.z = std::fabs(at.z) + 1e-3 * far;
	if (kind == 0 || kind == 1)
	{
		at.z = std::max(at.z, 0.1 * far);
	}
	if (kind == 2)
	{
		const glm::dvec2 over = random.uniform() < 0.5 ? outline[0] : 2.5 * outline[0] - 1.5 * outline[1];
		at = glm::dvec3(over.x, over.y, far * 0.2);
	}
	if (kind == 3)
	{
		const double angle = 6.283185307179586 * random.uniform();
		const double out = 0.55 * size_m + far;
		at = glm::dvec3(out * std::cos(angle), out * std::sin(angle),
						random.uniform() < 0.3 ? 0.0 : out * logUniform(random, 1e-9, 1e-2));
	}
	if (kind == 5)
	{
		at = glm::dvec3(0.6 * (outline[0].x + outline[1].x), 0.6 * (outline[0].y + outline[1].y), far);
	}
	return at;
}

inline HardPolygon hardPolygon(Random& random, int kind)
{
	HardPolygon hard;
	hard.size_m = logUniform(random, 1e-4, kind == 5 ? 1e4 : 100.0);
	const glm::dvec3 front = randomDirection(random);
	const glm::dvec3 u = glm::normalize(glm::cross(front, randomDirection(random)));
	const glm::dvec3 v = glm::cross(front, u);
	const double width = kind == 1 ? logUniform(random, 1e-7, 1.0) : 0.2 + 0.8 * random.uniform();
	const int count = 3 + static_cast<int>(random.uniform() * 6.0);
	std::vector<glm::dvec2> outline; // counter-clockwise about `front`
	const double first = 6.283185307179586 * random.uniform();
	for (int i = 0; i < count; ++i)
	{
		const double angle = first + 6.283185307179586 * (i + 0.8 * random.uniform()) / count;
		outline.push_back(0.5 * hard.size_m * glm::dvec2(std::cos(angle), width * std::sin(angle)));
	}
	const glm::dvec3 at = hardReceiver(random, kind, hard.size_m, outline);
	for (const glm::dvec2& p : outline)
	{
		hard.corners.push_back(glm::vec3(u * (p.x - at.x) + v * (p.y - at.y) - front * at.z));
	}
	hard.away_m = kind == 3 ? 0.05 * hard.size_m : std::fabs(at.z);
	hard.normal = glm::vec3(randomDirection(random));
	if (kind == 4)
	{
		const glm::dvec3 edge(hard.corners[0] - hard.corners[1]);
		const glm::dvec3 to(hard.corners[0]);
		hard.normal = glm::vec3(random.uniform() < 0.3   ? glm::normalize(glm::cross(front, edge))
								: random.uniform() < 0.5 ? glm::normalize(glm::cross(edge, to))
														 : glm::normalize(glm::cross(to, randomDirection(random))));
	}
	if (random.uniform() < 0.3)
	{
		std::reverse(hard.corners.begin(), hard.corners.end());
		hard.side = -1.0F;
	}
	return hard;
}

} // namespace nook::stress
