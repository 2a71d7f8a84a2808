// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/sample_set.h"

#include "core/lists.h"
#include "core/math.h"
#include "pattern/methods.h"

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr std::size_t kNeighbours = 4;

double cubeRoot(double x)
{
	return x > 0.0 ? powOf(x, 1.0 / 3.0) : 0.0;
}

// Solves x³ = u from a nearby start: Halley's iteration, which triples the digits; two steps leave 1e-7 for u within a quarter of
// the start's cube.
float cubeRootNear(float start, float u)
{
	float x = start;
	for (int i = 0; i < 2; ++i)
	{
		const float cube = x * x * x;
		x *= (cube + 2.0F * u) / (2.0F * cube + u);
	}
	return x;
}

// In [0, 1)³; the first coordinate is the index. The others step by powers of the root of g³ = g + 1, as the golden ratio does in
// one dimension (M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
std::vector<glm::dvec3> lattice(int count)
{
	const double g = 1.32471795724474602596;
	return mapped(countingFrom(0, static_cast<std::size_t>(count)),
				  [=](int i) { return glm::dvec3((i + 0.5) / count, fraction(i / g), fraction(i / (g * g))); });
}

// Unit vectors in the disk, in order of radius.
std::vector<glm::dvec3> azimuths(int count)
{
	Recipe recipe{.domain = Domain::hemisphere, .count = count, .method = Method::vogel};
	std::vector<glm::dvec3> points = vogelPoints(Layout(recipe));
	std::transform(points.begin(), points.end(), points.begin(),
				   [](const glm::dvec3& p) { return glm::normalize(glm::dvec3(p.x, p.y, 0.0)); });
	return points;
}

// Unit vectors; the lattice's first coordinate is the quantile of the radius.
std::vector<glm::dvec3> ballDirections(int count)
{
	std::vector<glm::dvec3> points = lattice(count);
	for (glm::dvec3& p : points)
	{
		const double z = 1.0 - 2.0 * p.y;
		const double across = std::sqrt(std::max(0.0, 1.0 - z * z));
		const SinCos a = sinCosOf(2.0 * kPi * p.z);
		p = {across * a.cos, across * a.sin, z};
	}
	return points;
}

} // namespace

SampleSet::SampleSet(SampleDomain domain, int count) : m_domain(domain), m_count(count)
{
	assert(count >= 1 && count <= kMaxSamples);
	for (const glm::dvec3& p : domain == SampleDomain::hemisphere ? azimuths(count)
							   : domain == SampleDomain::ball     ? ballDirections(count)
																  : lattice(count))
	{
		m_x.push_back(static_cast<float>(p.x));
		m_y.push_back(static_cast<float>(p.y));
		m_z.push_back(static_cast<float>(p.z));
		m_radii.push_back(static_cast<float>(cubeRoot((static_cast<double>(m_radii.size()) + 0.5) / count)));
	}
	findPairs();
}

// Pairs every sample with its kNeighbours nearest.
void SampleSet::findPairs()
{
	static_assert(kMaxSamples <= 65536);
	const auto count = static_cast<std::size_t>(m_count);
	std::vector<glm::vec3> points(count);
	for (std::size_t i = 0; i < count; ++i)
	{
		const float disk_radius = std::sqrt((static_cast<float>(i) + 0.5F) / static_cast<float>(m_count));
		const float radius = m_domain == SampleDomain::hemisphere ? disk_radius
							 : m_domain == SampleDomain::ball     ? m_radii[i]
																  : 1.0F;
		points[i] = radius * glm::vec3(m_x[i], m_y[i], m_z[i]);
	}
	const std::size_t kept = std::min(kNeighbours, count - 1);
	std::vector<std::pair<float, uint16_t>> near(count);
	for (std::size_t i = 0; i < count && kept > 0; ++i)
	{
		for (std::size_t j = 0; j < count; ++j)
		{
			glm::vec3 apart = points[i] - points[j];
			if (m_domain == SampleDomain::box)
			{
				apart -= glm::round(apart);
			}
			near[j] = {glm::dot(apart, apart), static_cast<uint16_t>(j)};
		}
		near[i].first = std::numeric_limits<float>::infinity();
		const auto middle = near.begin() + static_cast<std::ptrdiff_t>(kept);
		std::partial_sort(near.begin(), middle, near.end());
		for (auto n = near.begin(); n != middle; ++n)
		{
			m_pairs.push_back({std::min(static_cast<uint16_t>(i), n->second), std::max(static_cast<uint16_t>(i), n->second)});
		}
	}
	const auto key = [](const Pair& pair)
	{
		return pair.first * 65536U + pair.second;
	};
	std::sort(m_pairs.begin(), m_pairs.end(), [key](const Pair& a, const Pair& b) { return key(a) < key(b); });
	const auto end = std::unique(m_pairs.begin(), m_pairs.end(), [key](const Pair& a, const Pair& b) { return key(a) == key(b); });
	m_pairs.erase(end, m_pairs.end());
}

// Half the squared difference of two neighbours estimates the variance within a cell; were the samples independent within their
// cells, the mean's variance would be the sum of w² times that (collapsed strata: Cochran, "Sampling Techniques", 1977, 5A.12). The
// spiral is better than that, hence the factor. A feature smaller than a cell may hide between all samples, so one more pair counts
// as different: the error is never 0.
double SampleSet::squaredError(std::span<const float> values) const
{
	assert(values.size() == static_cast<std::size_t>(m_count));
	double sum = 0.0;
	// Most points are entirely open or entirely closed.
	if (std::any_of(values.begin(), values.end(), [&](float v) { return v != values[0]; }))
	{
		for (const Pair pair : m_pairs)
		{
			const float apart = values[pair.first] - values[pair.second];
			sum += static_cast<double>(apart * apart);
		}
		sum *= 0.5 * m_count / static_cast<double>(m_pairs.size());
	}
	// Tuned on builtin:courtyard and builtin:suburb, every measure and falloff, 16 to 4096 samples, so that the RMS of the errors
	// against 65,536 samples is at most about that of the stated ones. A lattice of few points is less even.
	const double scale = m_domain == SampleDomain::hemisphere ? 0.4 : 0.45 * (1.0 + 10.0 / m_count);
	return scale * (sum + 0.5) / (static_cast<double>(m_count) * m_count);
}

void SampleSet::place(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const
{
	switch (m_domain)
	{
	case SampleDomain::hemisphere: placeDirections(random, x, y, z); break;
	case SampleDomain::ball: placeInBall(random, x, y, z); break;
	case SampleDomain::box: placeInBox(random, x, y, z); break;
	}
}

void SampleSet::placeDirections(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const
{
	const auto shift = static_cast<float>(random.uniform());
	const SinCos turn = sinCosOf(2.0 * kPi * random.uniform());
	const auto c = static_cast<float>(turn.cos);
	const auto s = static_cast<float>(turn.sin);
	const float step = 1.0F / static_cast<float>(m_count);
	for (std::size_t i = 0; i < static_cast<std::size_t>(m_count); ++i)
	{
		const float area = (static_cast<float>(i) + shift) * step; // r², uniform on the disk
		const float radius = std::sqrt(area);
		x[i] = radius * (c * m_x[i] - s * m_y[i]);
		y[i] = radius * (s * m_x[i] + c * m_y[i]);
		z[i] = std::sqrt(std::max(0.0F, 1.0F - area));
	}
}

void SampleSet::placeInBall(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const
{
	const double shift = random.uniform();
	// A uniform rotation from three uniform numbers (K. Shoemake, "Uniform Random Rotations", Graphics Gems III, 1992).
	const double u = random.uniform();
	const SinCos a = sinCosOf(2.0 * kPi * random.uniform());
	const SinCos b = sinCosOf(2.0 * kPi * random.uniform());
	const glm::dquat rotation(std::sqrt(u) * b.cos, std::sqrt(1.0 - u) * a.sin, std::sqrt(1.0 - u) * a.cos, std::sqrt(u) * b.sin);
	const glm::mat3 turn(glm::mat3_cast(rotation));
	for (std::size_t i = 0; i < static_cast<std::size_t>(m_count); ++i)
	{
		const float quantile = (static_cast<float>(i) + static_cast<float>(shift)) / static_cast<float>(m_count);
		const float radius =
			i < 2 ? static_cast<float>(cubeRoot(static_cast<double>(quantile))) : cubeRootNear(m_radii[i], quantile);
		const glm::vec3 p = radius * (turn * glm::vec3(m_x[i], m_y[i], m_z[i]));
		x[i] = p.x;
		y[i] = p.y;
		z[i] = p.z;
	}
}

void SampleSet::placeInBox(Random& random, std::span<float> x, std::span<float> y, std::span<float> z) const
{
	// Axes are also permuted and reversed: a lattice resolves planes across some directions poorly, and a level's walls all have
	// the same few.
	static constexpr std::array<std::array<std::size_t, 3>, 6> kOrders{
		{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
	const std::array<std::size_t, 3>& order = kOrders[random.below(6)];
	const std::array<const std::vector<float>*, 3> from{&m_x, &m_y, &m_z};
	const std::array<std::span<float>, 3> to{x, y, z};
	for (std::size_t axis = 0; axis < 3; ++axis)
	{
		const double shift = random.uniform();
		const double sign = random.below(2) == 0 ? 1.0 : -1.0;
		const std::vector<float>& coordinates = *from[order[axis]];
		for (std::size_t i = 0; i < coordinates.size(); ++i)
		{
			to[axis][i] = static_cast<float>(sign * (2.0 * fraction(static_cast<double>(coordinates[i]) + shift) - 1.0));
		}
	}
}

} // namespace nook
