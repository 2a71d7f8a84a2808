// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: T. Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985 (farthest-first order), and
// G. Croes, "A method for solving traveling-salesman problems", 1958 (2-opt).
#include "pattern/methods.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace nook
{
namespace
{

// A point and its opposite move together: the distance between two such pairs is the smallest between their points.
class Distances
{
public:
	Distances(const Layout& layout, const Points& free) : m_layout(layout), m_free(free) {}

	double operator()(std::size_t a, std::size_t b) const
	{
		const double straight = glm::distance(m_free[a], m_free[b]);
		return m_layout.symmetric() ? std::min(straight, glm::distance(m_free[a], -m_free[b])) : straight;
	}

private:
	const Layout& m_layout;
	const Points& m_free;
};

// Each next point is the one farthest from all previous ones; the first is nearest to the centre.
std::vector<std::size_t> farthestFirst(const Layout& layout, const Points& free)
{
	const Distances distance(layout, free);
	const glm::dvec3 middle(0.0, 0.0, isDirectional(layout.domain()) ? 1.0 : 0.0);
	std::vector<double> gap(free.size());
	std::size_t next = 0;
	for (std::size_t i = 0; i < free.size(); ++i)
	{
		gap[i] = layout.hasCentre() ? glm::length(free[i]) : 4.0;
		if (glm::distance(free[i], middle) < glm::distance(free[next], middle))
		{
			next = i;
		}
	}
	if (layout.hasCentre() && !free.empty())
	{
		next = static_cast<std::size_t>(std::max_element(gap.begin(), gap.end()) - gap.begin());
	}
	std::vector<std::size_t> order;
	std::vector<char> taken(free.size(), 0);
	while (order.size() < free.size())
	{
		order.push_back(next);
		taken[next] = 1;
		std::size_t farthest = next;
		double greatest = -1.0;
		for (std::size_t i = 0; i < free.size(); ++i)
		{
			gap[i] = std::min(gap[i], distance(i, order.back()));
			if (taken[i] == 0 && gap[i] > greatest)
			{
				greatest = gap[i];
				farthest = i;
			}
		}
		next = farthest;
	}
	return order;
}

// A short path through all points: nearest neighbour, then 2-opt until it no longer shortens.
std::vector<std::size_t> shortPath(const Layout& layout, const Points& free)
{
	const Distances distance(layout, free);
	std::vector<std::size_t> path;
	std::vector<char> taken(free.size(), 0);
	std::size_t next = 0;
	while (path.size() < free.size())
	{
		path.push_back(next);
		taken[next] = 1;
		double least = 1e300;
		for (std::size_t i = 0; i < free.size(); ++i)
		{
			const double d = taken[i] != 0 ? 1e300 : distance(i, path.back());
			if (d < least)
			{
				least = d;
				next = i;
			}
		}
	}
	bool shorter = true;
	for (int pass = 0; shorter && pass < 20; ++pass)
	{
		shorter = false;
		for (std::size_t i = 1; i < path.size(); ++i)
		{
			for (std::size_t j = i + 1; j < path.size(); ++j)
			{
				const double before = distance(path[i - 1], path[i]) + (j + 1 < path.size() ? distance(path[j], path[j + 1]) : 0.0);
				const double after = distance(path[i - 1], path[j]) + (j + 1 < path.size() ? distance(path[i], path[j + 1]) : 0.0);
				if (after < before - 1e-12)
				{
					std::reverse(path.begin() + static_cast<std::ptrdiff_t>(i), path.begin() + static_cast<std::ptrdiff_t>(j) + 1);
					shorter = true;
				}
			}
		}
	}
	return path;
}

} // namespace

Points reorder(Order order, const Layout& layout, const Points& points)
{
	if (order == Order::none)
	{
		return points;
	}
	const Points free = layout.freePoints(points);
	const std::vector<std::size_t> indices = order == Order::progressive ? farthestFirst(layout, free) : shortPath(layout, free);
	Points sorted;
	for (const std::size_t i : indices)
	{
		sorted.push_back(free[i]);
	}
	return layout.expand(sorted);
}

} // namespace nook
