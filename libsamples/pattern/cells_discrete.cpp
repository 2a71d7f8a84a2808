// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's discrete cells (VO §4.5): every cell of a regular grid goes to its nearest point. Kept as the comparison and as the
// slow, obvious twin of the exact cells.
#include "core/math.h"
#include "pattern/cells.h"

#include <glm/geometric.hpp>

namespace nook
{
namespace
{

constexpr int kPlaneCells = 512;
constexpr int kSpaceCells = 128;

class Accumulator
{
public:
	explicit Accumulator(std::span<const glm::dvec3> points, bool planar)
		: m_points(points.begin(), points.end()), m_mass(points.size(), 0.0), m_moment(points.size(), glm::dvec3(0.0))
	{
		for (glm::dvec3& p : m_points)
		{
			p.z = planar ? 0.0 : p.z;
		}
	}

	void add(const glm::dvec3& x, double mass)
	{
		std::size_t nearest = 0;
		double least = 1e300;
		for (std::size_t i = 0; i < m_points.size(); ++i)
		{
			const glm::dvec3 d = m_points[i] - x;
			const double distance2 = glm::dot(d, d);
			if (distance2 < least)
			{
				least = distance2;
				nearest = i;
			}
		}
		m_mass[nearest] += mass;
		m_moment[nearest] += mass * x;
		m_total += mass;
	}

	Cells result() const
	{
		Cells cells;
		for (std::size_t i = 0; i < m_points.size(); ++i)
		{
			cells.integrals.push_back(m_mass[i] / m_total);
			cells.centroids.push_back(m_mass[i] > 0.0 ? m_moment[i] / m_mass[i] : m_points[i]);
		}
		return cells;
	}

private:
	std::vector<glm::dvec3> m_points;
	std::vector<double> m_mass;
	std::vector<glm::dvec3> m_moment;
	double m_total = 0.0;
};

double middle(int k, int count)
{
	return -1.0 + 2.0 * (k + 0.5) / count;
}

void addPlane(Domain domain, Accumulator& sum)
{
	for (int row = 0; row < kPlaneCells; ++row)
	{
		for (int column = 0; column < kPlaneCells; ++column)
		{
			const glm::dvec3 x(middle(column, kPlaneCells), middle(row, kPlaneCells), 0.0);
			const double height2 = 1.0 - glm::dot(x, x);
			if (height2 > 0.0)
			{
				sum.add(x, domain == Domain::disk ? std::sqrt(height2) : 1.0);
			}
		}
	}
}

void addSpace(Accumulator& sum)
{
	for (int k = 0; k < kSpaceCells; ++k)
	{
		for (int j = 0; j < kSpaceCells; ++j)
		{
			for (int i = 0; i < kSpaceCells; ++i)
			{
				const glm::dvec3 x(middle(i, kSpaceCells), middle(j, kSpaceCells), middle(k, kSpaceCells));
				if (glm::dot(x, x) <= 1.0)
				{
					sum.add(x, 1.0);
				}
			}
		}
	}
}

// Equal steps in height and azimuth have equal areas (Archimedes).
void addSphere(Accumulator& sum)
{
	for (int j = 0; j < kPlaneCells; ++j)
	{
		const double z = middle(j, kPlaneCells);
		const double r = std::sqrt((1.0 - z) * (1.0 + z));
		for (int i = 0; i < kPlaneCells; ++i)
		{
			const SinCos turn = sinCosOf(2.0 * kPi * (i + 0.5) / kPlaneCells);
			sum.add({r * turn.cos, r * turn.sin, z}, 1.0);
		}
	}
}

} // namespace

Cells discreteCells(Domain domain, std::span<const glm::dvec3> points)
{
	Accumulator sum(points, isPlanar(domain));
	switch (domain)
	{
	case Domain::ball: addSpace(sum); break;
	case Domain::sphere: addSphere(sum); break;
	case Domain::disk:
	case Domain::hemisphere: addPlane(domain, sum); break;
	case Domain::slice: break; // without cells
	}
	return sum.result();
}

} // namespace nook
