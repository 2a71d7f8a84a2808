// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/cells.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>

namespace nook
{

Cells exactCells(Domain domain, std::span<const glm::dvec3> points, std::span<const double> powers)
{
	assert(powers.empty() || powers.size() == points.size());
	Cells cells = domain == Domain::ball     ? detail::spaceCells(points, powers)
				  : domain == Domain::sphere ? detail::directionCells(points, powers)
											 : detail::planeCells(domain, points, powers);
	std::stable_sort(cells.facets.begin(), cells.facets.end(),
					 [](const Facet& l, const Facet& r) { return std::pair(l.a, l.b) < std::pair(r.a, r.b); });
	return cells;
}

void addCellGradient(Domain domain, std::span<const glm::dvec3> points, std::span<const Facet> facets,
					 std::span<const double> integral_gradient, std::span<glm::dvec3> point_gradient)
{
	for (const Facet& facet : facets)
	{
		const auto a = static_cast<std::size_t>(facet.a);
		const auto b = static_cast<std::size_t>(facet.b);
		glm::dvec3 pa = points[a];
		glm::dvec3 pb = points[b];
		if (isPlanar(domain))
		{
			pa.z = 0.0;
			pb.z = 0.0;
		}
		// When p_b moves by δ, the border moves into cell b's side by ∫ (x − p_b)·δ / |p_a − p_b|: Reynolds' theorem on the
		// level set |x − p_a|² − |x − p_b|² = 0. On the sphere the level set is x·(p_b − p_a) = 0.
		const double scale = (integral_gradient[b] - integral_gradient[a]) / glm::length(pa - pb);
		const double inside = domain == Domain::sphere ? 0.0 : facet.mass;
		point_gradient[b] += scale * (facet.moment - inside * pb);
		point_gradient[a] -= scale * (facet.moment - inside * pa);
	}
}

double relativeSpread(std::span<const double> integrals)
{
	const auto count = static_cast<double>(integrals.size());
	double mean = 0.0;
	for (const double integral : integrals)
	{
		mean += integral / count;
	}
	double variance = 0.0;
	for (const double integral : integrals)
	{
		variance += (integral - mean) * (integral - mean) / count;
	}
	return std::sqrt(variance) / mean;
}

} // namespace nook
