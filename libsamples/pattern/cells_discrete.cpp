// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's discrete cells (VO §4.5): each cell of a regular grid belongs to its nearest point. Kept for comparison and to test
// the exact cells.
#include "core/math.h"
#include "pattern/cells.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>

namespace nook
{
namespace
{

constexpr int kPlaneCells = 512;
constexpr int kSpaceCells = 128;
constexpr int kBlock = 8;         // cells along the edge of a block, within which few points can be nearest
constexpr double kBulge = 0.0015; // how far a block on the sphere bulges beyond its corners

class Accumulator
{
public:
	explicit Accumulator(std::span<const glm::dvec3> points, bool planar)
		: m_points(points.begin(), points.end()), m_sums(points.size())
	{
		for (glm::dvec3& p : m_points)
		{
			p.z = planar ? 0.0 : p.z;
		}
	}

	// The points that can be nearest to anything in a box, in index order.
	std::vector<std::size_t> near(const glm::dvec3& centre, const glm::dvec3& half) const
	{
		std::vector<std::size_t> result;
		double least = 1e300; // upper bound of the nearest point's distance
		for (const glm::dvec3& p : m_points)
		{
			const glm::dvec3 far = glm::abs(p - centre) + half;
			least = std::min(least, glm::dot(far, far));
		}
		for (std::size_t i = 0; i < m_points.size(); ++i)
		{
			const glm::dvec3 away = glm::max(glm::abs(m_points[i] - centre) - half, glm::dvec3(0.0));
			if (glm::dot(away, away) <= least * (1.0 + 1e-9)) // tolerance for rounding
			{
				result.push_back(i);
			}
		}
		return result;
	}

	// Assigns a row of cells to the nearest of `candidates`; ties go to the first. at(i) is a cell's position, mass(x) its mass (0
	// outside).
	template <class At, class Mass> void addRun(int first, int last, At at, Mass mass, const std::vector<std::size_t>& candidates)
	{
		if (candidates.size() == 1)
		{
			Sum sum = m_sums[candidates.front()]; // a copy, so that the next cell need not wait for memory
			double total = m_total;
			for (int i = first; i < last; ++i)
			{
				const glm::dvec3 x = at(i);
				const double m = mass(x);
				sum.mass += m;
				sum.moment += m * x;
				total += m;
			}
			m_sums[candidates.front()] = sum;
			m_total = total;
			return;
		}
		for (int i = first; i < last; ++i)
		{
			const glm::dvec3 x = at(i);
			if (const double m = mass(x); m > 0.0)
			{
				Sum& sum = m_sums[nearestOf(candidates, x)];
				sum.mass += m;
				sum.moment += m * x;
				m_total += m;
			}
		}
	}

	Cells result() const
	{
		Cells cells;
		for (std::size_t i = 0; i < m_points.size(); ++i)
		{
			const Sum& sum = m_sums[i];
			cells.integrals.push_back(sum.mass / m_total);
			cells.centroids.push_back(sum.mass > 0.0 ? sum.moment / sum.mass : m_points[i]);
		}
		return cells;
	}

private:
	struct Sum
	{
		double mass = 0.0;
		glm::dvec3 moment{0.0};
	};

	std::size_t nearestOf(const std::vector<std::size_t>& candidates, const glm::dvec3& x) const
	{
		std::size_t nearest = candidates.front();
		double least = 1e300;
		for (const std::size_t i : candidates)
		{
			const glm::dvec3 d = m_points[i] - x;
			const double distance2 = glm::dot(d, d);
			nearest = distance2 < least ? i : nearest;
			least = distance2 < least ? distance2 : least;
		}
		return nearest;
	}

	std::vector<glm::dvec3> m_points;
	std::vector<Sum> m_sums;
	double m_total = 0.0;
};

double middle(int k, int count)
{
	return -1.0 + 2.0 * (k + 0.5) / count;
}

// Adds count.x × count.y × count.z cells in rows along x; at(i, j, k) is a cell's position, mass(x) its mass (0 outside).
template <class At, class Mass> void addCells(Accumulator& sum, const glm::ivec3& count, At at, Mass mass)
{
	const glm::ivec3 blocks = (count + kBlock - 1) / kBlock;
	const auto near_block = [&](int block_i, int block_j, int first_k)
	{
		const glm::ivec3 first(block_i * kBlock, block_j * kBlock, first_k);
		const glm::ivec3 last = glm::min(first + kBlock, count) - 1;
		glm::dvec3 low(1.0);
		glm::dvec3 high(-1.0);
		for (int corner = 0; corner < 8; ++corner)
		{
			const glm::dvec3 x =
				at(corner % 2 == 0 ? first.x : last.x, corner / 2 % 2 == 0 ? first.y : last.y, corner / 4 == 0 ? first.z : last.z);
			low = glm::min(low, x);
			high = glm::max(high, x);
		}
		const glm::dvec3 centre = 0.5 * (low + high);
		const glm::dvec3 half = 0.5 * (high - low) + kBulge;
		const glm::dvec3 inmost = glm::max(glm::abs(centre) - half, glm::dvec3(0.0));
		return glm::dot(inmost, inmost) > 1.0 ? std::vector<std::size_t>{} : sum.near(centre, half);
	};
	std::vector<std::vector<std::size_t>> near; // per block of the current layer
	for (int k = 0; k < count.z; ++k)
	{
		for (int block = 0; k % kBlock == 0 && block < blocks.x * blocks.y; ++block)
		{
			near.resize(static_cast<std::size_t>(blocks.x * blocks.y));
			near[static_cast<std::size_t>(block)] = near_block(block % blocks.x, block / blocks.x, k);
		}
		for (int j = 0; j < count.y; ++j)
		{
			const auto at_column = [&](int i)
			{
				return at(i, j, k);
			};
			for (int block = 0; block < blocks.x; ++block)
			{
				const std::vector<std::size_t>& candidates = near[static_cast<std::size_t>(j / kBlock * blocks.x + block)];
				if (!candidates.empty()) // empty if the whole block lies outside
				{
					sum.addRun(block * kBlock, std::min((block + 1) * kBlock, count.x), at_column, mass, candidates);
				}
			}
		}
	}
}

void addPlane(Domain domain, Accumulator& sum)
{
	const auto at = [](int i, int j, int)
	{
		return glm::dvec3(middle(i, kPlaneCells), middle(j, kPlaneCells), 0.0);
	};
	addCells(sum, {kPlaneCells, kPlaneCells, 1}, at,
			 [domain](const glm::dvec3& x)
			 {
				 const double height2 = 1.0 - glm::dot(x, x);
				 return height2 > 0.0 ? domain == Domain::disk ? std::sqrt(height2) : 1.0 : 0.0;
			 });
}

void addSpace(Accumulator& sum)
{
	const auto at = [](int i, int j, int k)
	{
		return glm::dvec3(middle(i, kSpaceCells), middle(j, kSpaceCells), middle(k, kSpaceCells));
	};
	addCells(sum, glm::ivec3(kSpaceCells), at, [](const glm::dvec3& x) { return glm::dot(x, x) <= 1.0 ? 1.0 : 0.0; });
}

// Equal steps in height and azimuth have equal areas (Archimedes).
void addSphere(Accumulator& sum)
{
	std::vector<SinCos> turns;
	for (int i = 0; i < kPlaneCells; ++i)
	{
		turns.push_back(sinCosOf(2.0 * kPi * (i + 0.5) / kPlaneCells));
	}
	const auto at = [&turns](int i, int j, int)
	{
		const double z = middle(j, kPlaneCells);
		const double r = std::sqrt((1.0 - z) * (1.0 + z));
		const SinCos& turn = turns[static_cast<std::size_t>(i)];
		return glm::dvec3(r * turn.cos, r * turn.sin, z);
	};
	addCells(sum, {kPlaneCells, kPlaneCells, 1}, at, [](const glm::dvec3&) { return 1.0; });
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
	case Domain::slice: break; // has no cells
	}
	return sum.result();
}

} // namespace nook
