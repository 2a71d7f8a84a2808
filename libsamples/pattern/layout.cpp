// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/layout.h"

#include "core/lists.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace nook
{
namespace
{

constexpr double kRim = 1.0 - 1e-6;     // greatest radius of a placed point
constexpr double kLimit = 1.0 - 0.5e-6; // greatest radius for an optimiser; a placed point stays below it after rounding

} // namespace

glm::dvec3 placeInDomain(Domain domain, const glm::dvec3& p)
{
	if (domain == Domain::sphere)
	{
		return glm::normalize(p);
	}
	glm::dvec3 q = p;
	if (domain != Domain::ball)
	{
		q.z = 0.0;
	}
	const double r = glm::length(q);
	if (r > kRim)
	{
		q *= kRim / r;
	}
	if (domain == Domain::hemisphere)
	{
		q.z = std::sqrt(1.0 - glm::dot(q, q));
	}
	return q;
}

Layout::Layout(const Recipe& recipe)
	: m_domain(recipe.domain), m_centre(recipe.centre || (recipe.symmetric && recipe.count % 2 != 0)), m_symmetric(recipe.symmetric)
{
	const std::size_t moving = static_cast<std::size_t>(recipe.count) - (m_centre ? 1U : 0U);
	m_free = m_symmetric ? moving / 2 : moving;
}

std::vector<glm::dvec3> Layout::expand(std::span<const glm::dvec3> free) const
{
	std::vector<glm::dvec3> all;
	if (m_centre)
	{
		all.emplace_back(0.0);
	}
	for (const glm::dvec3& p : free)
	{
		all.push_back(p);
		if (m_symmetric)
		{
			all.push_back(-p);
		}
	}
	return all;
}

std::vector<glm::dvec3> Layout::freePoints(std::span<const glm::dvec3> all) const
{
	return listOf(m_free, [&](std::size_t k) { return all[firstFree(k)]; });
}

std::vector<double> Layout::variables(std::span<const glm::dvec3> all) const
{
	std::vector<double> result;
	for (std::size_t k = 0; k < m_free; ++k)
	{
		const glm::dvec3& p = all[firstFree(k)];
		for (std::size_t a = 0; a < dimension(); ++a)
		{
			result.push_back(p[static_cast<int>(a)]);
		}
	}
	return result;
}

bool Layout::points(std::span<const double> variables, std::vector<glm::dvec3>& all) const
{
	std::vector<glm::dvec3> free(m_free);
	for (std::size_t k = 0; k < m_free; ++k)
	{
		glm::dvec3 p(0.0);
		for (std::size_t a = 0; a < dimension(); ++a)
		{
			p[static_cast<int>(a)] = variables[k * dimension() + a];
		}
		const double r2 = glm::dot(p, p);
		if (m_domain == Domain::sphere)
		{
			if (!(r2 > 1e-6 && r2 < 1e6))
			{
				return false;
			}
			p /= std::sqrt(r2);
		}
		else if (!(r2 <= kLimit * kLimit))
		{
			return false;
		}
		if (m_domain == Domain::hemisphere)
		{
			p.z = std::sqrt(1.0 - r2);
		}
		free[k] = p;
	}
	all = expand(free);
	return true;
}

void Layout::pullBack(std::span<const double> variables, std::span<const glm::dvec3> all,
					  std::span<const glm::dvec3> point_gradient, std::span<double> gradient) const
{
	for (std::size_t k = 0; k < m_free; ++k)
	{
		const std::size_t i = firstFree(k);
		const glm::dvec3& p = all[i];
		glm::dvec3 g = point_gradient[i];
		if (m_symmetric)
		{
			g -= point_gradient[i + 1];
		}
		if (m_domain == Domain::sphere)
		{
			glm::dvec3 u(variables[3 * k], variables[3 * k + 1], variables[3 * k + 2]);
			g = (g - glm::dot(g, p) * p) / glm::length(u);
		}
		else if (m_domain == Domain::hemisphere)
		{
			g -= (g.z / p.z) * p; // ∂z/∂x = −x/z
		}
		for (std::size_t a = 0; a < dimension(); ++a)
		{
			gradient[k * dimension() + a] = g[static_cast<int>(a)];
		}
	}
}

void Layout::symmetrise(std::span<double> values) const
{
	if (!m_symmetric)
	{
		return;
	}
	for (std::size_t k = 0; k < m_free; ++k)
	{
		const std::size_t i = firstFree(k);
		values[i] = 0.5 * (values[i] + values[i + 1]);
		values[i + 1] = values[i];
	}
}

} // namespace nook
