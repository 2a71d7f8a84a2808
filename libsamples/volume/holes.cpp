// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/holes.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <vector>

namespace nook::detail
{
namespace
{

// Twice the area that a closed line can bound at most.
double boundedBy(std::span<const uint32_t> loop, std::span<const glm::dvec3> positions)
{
	const glm::dvec3 apex = positions[loop[0]];
	double length = 0.0;
	double cone = 0.0;
	for (std::size_t i = 0; i < loop.size(); ++i)
	{
		const glm::dvec3 a = positions[loop[i]];
		const glm::dvec3 b = positions[loop[(i + 1) % loop.size()]];
		length += glm::length(b - a);
		cone += glm::length(glm::cross(a - apex, b - apex));
	}
	return std::min(cone, length * length / (2.0 * kPi));
}

// One piece's edges by where they begin.
class Walk
{
public:
	Walk(std::span<const OpenEdge> edges, std::span<const glm::dvec3> positions)
		: m_edges(edges.begin(), edges.end()), m_positions(positions)
	{
		std::stable_sort(m_edges.begin(), m_edges.end(), [](const OpenEdge& a, const OpenEdge& b) { return a.from < b.from; });
		for (std::size_t i = 0; i < m_edges.size(); ++i)
		{
			if (i == 0 || m_edges[i].from != m_edges[i - 1].from)
			{
				m_vertices.push_back(m_edges[i].from);
				m_next.push_back(i);
			}
		}
		m_ends.assign(m_next.begin() + (m_next.empty() ? 0 : 1), m_next.end());
		m_ends.push_back(m_edges.size());
		m_place.assign(m_vertices.size(), 0);
	}

	// Along edges that are left; where the way comes back to a vertex of its own, that loop is done.
	double area()
	{
		double area = 0.0;
		for (std::size_t first = 0; first < m_vertices.size(); ++first)
		{
			while (m_next[first] < m_ends[first])
			{
				area += areaFrom(first);
			}
		}
		return area;
	}

private:
	double areaFrom(std::size_t at)
	{
		double area = 0.0;
		m_way.assign(1, m_vertices[at]);
		m_place[at] = 1;
		while (at < m_vertices.size() && m_next[at] < m_ends[at])
		{
			const uint32_t to = m_edges[m_next[at]++].to;
			at = indexOf(to);
			if (at < m_vertices.size() && m_place[at] != 0)
			{
				const std::size_t begin = m_place[at] - 1;
				area += boundedBy(std::span(m_way).subspan(begin), m_positions);
				forget(begin + 1);
				continue;
			}
			m_way.push_back(to);
			if (at < m_vertices.size())
			{
				m_place[at] = m_way.size();
			}
		}
		area += boundedBy(m_way, m_positions); // what does not close counts as if it did; one vertex is nothing
		forget(0);
		return area;
	}

	void forget(std::size_t begin)
	{
		for (std::size_t i = begin; i < m_way.size(); ++i)
		{
			const std::size_t index = indexOf(m_way[i]);
			if (index < m_vertices.size())
			{
				m_place[index] = 0;
			}
		}
		m_way.resize(begin);
	}

	// As many as there are where no edge begins.
	std::size_t indexOf(uint32_t vertex) const
	{
		const auto found = std::lower_bound(m_vertices.begin(), m_vertices.end(), vertex);
		return found != m_vertices.end() && *found == vertex ? static_cast<std::size_t>(found - m_vertices.begin())
															 : m_vertices.size();
	}

	std::vector<OpenEdge> m_edges;
	std::span<const glm::dvec3> m_positions;
	std::vector<uint32_t> m_vertices; // that edges begin at, ascending
	std::vector<std::size_t> m_next;  // edge of each that is left
	std::vector<std::size_t> m_ends;
	std::vector<std::size_t> m_place; // of each in the way, from 1; 0: not in it
	std::vector<uint32_t> m_way;
};

} // namespace

void addHoles(std::span<const OpenEdge> edges, std::span<const glm::dvec3> positions, std::span<double> holes)
{
	for (std::size_t begin = 0; begin < edges.size();)
	{
		std::size_t end = begin + 1;
		while (end < edges.size() && edges[end].piece == edges[begin].piece)
		{
			++end;
		}
		holes[edges[begin].piece] += Walk(edges.subspan(begin, end - begin), positions).area();
		begin = end;
	}
}

} // namespace nook::detail
