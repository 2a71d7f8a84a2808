// SPDX-License-Identifier: GPL-3.0-or-later
// Separates a pattern's free points from those that follow: a fixed centre first, then the free points, each followed by its
// opposite if the pattern is symmetric.
#pragma once

#include "pattern/recipe.h"

#include <span>
#include <vector>

namespace nook
{

// The nearest valid position: disk z = 0, directions unit length, hemisphere lifted from (x, y); radii at most 1 − 1e-6 (sphere:
// exactly 1).
glm::dvec3 placeInDomain(Domain domain, const glm::dvec3& p);

class Layout
{
public:
	explicit Layout(const Recipe& recipe);

	std::size_t freeCount() const
	{
		return m_free;
	}

	bool hasCentre() const
	{
		return m_centre;
	}

	bool symmetric() const
	{
		return m_symmetric;
	}

	Domain domain() const
	{
		return m_domain;
	}

	// Number of variables per free point: (x, y) or (x, y, z).
	std::size_t dimension() const
	{
		return isPlanar(m_domain) ? 2 : 3;
	}

	std::vector<glm::dvec3> expand(std::span<const glm::dvec3> free) const;    // all points
	std::vector<glm::dvec3> freePoints(std::span<const glm::dvec3> all) const; // its inverse

	// Converts to an optimiser's variables (dimension × freeCount) and back. False if a point leaves the domain.
	std::vector<double> variables(std::span<const glm::dvec3> all) const;
	bool points(std::span<const double> variables, std::vector<glm::dvec3>& all) const;

	// Converts the gradient by every point (in space) to the gradient by the variables.
	void pullBack(std::span<const double> variables, std::span<const glm::dvec3> all, std::span<const glm::dvec3> point_gradient,
				  std::span<double> gradient) const;

	// Replaces values of opposite points with their mean.
	void symmetrise(std::span<double> values) const;

private:
	std::size_t firstFree(std::size_t k) const
	{
		return (m_centre ? 1U : 0U) + (m_symmetric ? 2 * k : k);
	}

	Domain m_domain;
	bool m_centre;
	bool m_symmetric;
	std::size_t m_free;
};

} // namespace nook
