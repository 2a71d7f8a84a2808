// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/symmetry.h"

#include "core/math.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cassert>

namespace nook
{
namespace
{

using Points = std::vector<glm::dvec3>;

// Weights of samples that a symmetry exchanges agree within this share: a rotation that moves a heavy sample onto a light one is
// none.
constexpr double kWeightTolerance = 0.05;

struct Matcher
{
	const Pattern& pattern;
	double tolerance;

	template <class Move> bool maps(const Move& move) const
	{
		for (std::size_t i = 0; i < pattern.points.size(); ++i)
		{
			const glm::dvec3 moved = move(pattern.points[i]);
			bool found = false;
			for (std::size_t j = 0; j < pattern.points.size() && !found; ++j)
			{
				const glm::dvec3 d = pattern.points[j] - moved;
				const double weight_gap = std::fabs(pattern.weights[j] - pattern.weights[i]);
				found = glm::dot(d, d) <= tolerance * tolerance && weight_gap <= kWeightTolerance * pattern.weights[i];
			}
			if (!found)
			{
				return false;
			}
		}
		return true;
	}
};

bool isAntipodal(const Matcher& matcher)
{
	return matcher.maps([](const glm::dvec3& p) { return -p; });
}

int planeOrder(const Matcher& matcher)
{
	const int count = static_cast<int>(matcher.pattern.count());
	for (int order = count; order >= 2; --order)
	{
		const SinCos turn = sinCosOf(2.0 * kPi / order);
		if (matcher.maps([&](const glm::dvec3& p)
						 { return glm::dvec3(turn.cos * p.x - turn.sin * p.y, turn.sin * p.x + turn.cos * p.y, p.z); }))
		{
			return order;
		}
	}
	return 1;
}

// A mirror line carries the outermost sample to some sample (or to itself), so only those lines need a try.
bool planeMirrored(const Matcher& matcher)
{
	const Points& points = matcher.pattern.points;
	const auto radius2 = [](const glm::dvec3& p)
	{
		return p.x * p.x + p.y * p.y;
	};
	const glm::dvec3 first =
		*std::max_element(points.begin(), points.end(), [&](const auto& a, const auto& b) { return radius2(a) < radius2(b); });
	const double angle = atan2Of(first.y, first.x);
	for (const glm::dvec3& other : points)
	{
		const SinCos twice = sinCosOf(angle + atan2Of(other.y, other.x)); // twice the mirror's angle
		if (matcher.maps([&](const glm::dvec3& p)
						 { return glm::dvec3(twice.cos * p.x + twice.sin * p.y, twice.sin * p.x - twice.cos * p.y, p.z); }))
		{
			return true;
		}
	}
	return false;
}

glm::dmat3 frame(const glm::dvec3& a, const glm::dvec3& b)
{
	const glm::dvec3 x = glm::normalize(a);
	const glm::dvec3 z = glm::normalize(glm::cross(a, b));
	return {x, glm::cross(z, x), z};
}

// Rotations that differ by less than about 6°; those of one group on up to 128 samples differ by more.
bool isNear(const glm::dmat3& a, const glm::dmat3& b)
{
	return glm::distance(a[0], b[0]) < 0.1 && glm::distance(a[1], b[1]) < 0.1;
}

// A rotation is fixed by where two samples go that are not in line with the centre.
int spaceOrder(const Matcher& matcher)
{
	const Points& points = matcher.pattern.points;
	const double tolerance = matcher.tolerance;
	const auto far = std::max_element(points.begin(), points.end(),
									  [](const auto& a, const auto& b) { return glm::dot(a, a) < glm::dot(b, b); });
	const glm::dvec3 a = *far;
	glm::dvec3 b = a;
	double widest = 0.1; // of |a × b|: below it two samples hardly fix a rotation
	for (const glm::dvec3& p : points)
	{
		const double width = glm::length(glm::cross(a, p));
		if (width > widest)
		{
			widest = width;
			b = p;
		}
	}
	if (b == a)
	{
		return 1; // one sample, or samples on one line: every rotation about it is a symmetry, none worth a count
	}
	const glm::dmat3 from = glm::transpose(frame(a, b));
	std::vector<glm::dmat3> found;
	for (const glm::dvec3& p : points)
	{
		for (const glm::dvec3& q : points)
		{
			const bool fits = std::fabs(glm::length(p) - glm::length(a)) <= tolerance &&
							  std::fabs(glm::length(q) - glm::length(b)) <= tolerance &&
							  std::fabs(glm::distance(p, q) - glm::distance(a, b)) <= 2.0 * tolerance;
			if (fits && glm::length(glm::cross(p, q)) > 0.05)
			{
				const glm::dmat3 rotation = frame(p, q) * from;
				// Samples nearer to one another than the tolerance would have one rotation counted twice.
				const bool known =
					std::any_of(found.begin(), found.end(), [&](const glm::dmat3& other) { return isNear(rotation, other); });
				if (!known && matcher.maps([&](const glm::dvec3& v) { return rotation * v; }))
				{
					found.push_back(rotation);
				}
			}
		}
	}
	return std::max(static_cast<int>(found.size()), 1);
}

std::vector<Ring> findRings(const Pattern& pattern, double tolerance)
{
	std::vector<std::pair<double, double>> samples; // radius, weight
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		const glm::dvec3& p = pattern.points[i];
		const double radius =
			isPlanar(pattern.domain) ? std::sqrt(p.x * p.x + p.y * p.y) : (pattern.domain == Domain::sphere ? p.z : glm::length(p));
		samples.emplace_back(radius, pattern.weights[i]);
	}
	std::sort(samples.begin(), samples.end());
	std::vector<Ring> rings;
	double previous = 0.0;
	for (const auto& [radius, weight] : samples)
	{
		if (rings.empty() || radius - previous > tolerance)
		{
			rings.push_back({});
		}
		Ring& ring = rings.back();
		ring.radius += (radius - ring.radius) / (ring.samples + 1);
		ring.samples += 1;
		ring.weight += weight;
		previous = radius;
	}
	return rings;
}

} // namespace

Symmetry findSymmetry(const Pattern& pattern, double tolerance)
{
	assert(!pattern.points.empty() && pattern.weights.size() == pattern.points.size());
	const Matcher matcher{pattern, tolerance};
	Symmetry symmetry;
	symmetry.rings = findRings(pattern, tolerance);
	if (isPlanar(pattern.domain))
	{
		symmetry.order = planeOrder(matcher);
		symmetry.mirrored = planeMirrored(matcher);
		symmetry.antipodal = pattern.domain == Domain::disk && isAntipodal(matcher);
	}
	else
	{
		symmetry.order = spaceOrder(matcher);
		symmetry.antipodal = isAntipodal(matcher);
	}
	return symmetry;
}

} // namespace nook
