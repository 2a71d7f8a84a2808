// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/vicinity.h"

#include <glm/common.hpp>

#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr double kCellsOfReach = 4.0; // smaller cells are tighter, but there are more of them
constexpr double kMostCells = 1 << 18;

} // namespace

Vicinity::Vicinity(const Bounds& bounds, double reach_m) : m_bounds(bounds), m_cell_m(reach_m / kCellsOfReach)
{
	assert(reach_m > 0.0 && bounds.least.x <= bounds.most.x);
	const glm::dvec3 size = bounds.most - bounds.least;
	const auto cellsAt = [&size](double cell_m)
	{
		return glm::floor(size / cell_m) + 1.0;
	};
	glm::dvec3 cells = cellsAt(m_cell_m);
	while (!(cells.x * cells.y * cells.z <= kMostCells))
	{
		m_cell_m *= 1.25;
		cells = cellsAt(m_cell_m);
	}
	m_cells = glm::ivec3(cells);
	// The distance between a point and what it reaches on each axis, including rounding of the last bits.
	m_reach_cells = static_cast<int>(reach_m / m_cell_m + 1e-6) + 1;
	m_size = {static_cast<std::size_t>(m_cells.x) + 1, static_cast<std::size_t>(m_cells.y) + 1,
			  static_cast<std::size_t>(m_cells.z) + 1};
	m_sums.assign(m_size[0] * m_size[1] * m_size[2], 0);
}

glm::ivec3 Vicinity::cellOf(glm::dvec3 point) const
{
	return glm::ivec3(glm::clamp((point - m_bounds.least) / m_cell_m, glm::dvec3(0.0), glm::dvec3(m_cells - 1)));
}

std::size_t Vicinity::placeOf(glm::ivec3 cell) const
{
	const auto along = [&cell](int axis)
	{
		return static_cast<std::size_t>(cell[axis] + 1);
	};
	return (along(2) * m_size[1] + along(1)) * m_size[0] + along(0);
}

void Vicinity::add(glm::dvec3 point)
{
	m_sums[placeOf(cellOf(point))] = 1;
}

void Vicinity::count()
{
	std::size_t stride = 1;
	for (const std::size_t size : m_size)
	{
		// The plane of zeros restarts the sum for each row.
		for (std::size_t i = stride; i < m_sums.size(); ++i)
		{
			m_sums[i] += i / stride % size == 0 ? 0 : m_sums[i - stride];
		}
		stride *= size;
	}
}

bool Vicinity::touches(const Bounds& box) const
{
	const glm::ivec3 least = glm::max(cellOf(box.least) - m_reach_cells, glm::ivec3(0)) - 1;
	const glm::ivec3 most = glm::min(cellOf(box.most) + m_reach_cells, m_cells - 1);
	const auto sum = [this](int x, int y, int z)
	{
		return m_sums[placeOf({x, y, z})];
	};
	// Modulo 2^32 throughout, which does not affect differences.
	return sum(most.x, most.y, most.z) - sum(least.x, most.y, most.z) - sum(most.x, least.y, most.z) -
			   sum(most.x, most.y, least.z) + sum(least.x, least.y, most.z) + sum(least.x, most.y, least.z) +
			   sum(most.x, least.y, least.z) - sum(least.x, least.y, least.z) !=
		   0;
}

} // namespace nook
