// SPDX-License-Identifier: GPL-3.0-or-later
#include "pattern/cells.h"

#include "core/convex_clip.h"
#include "core/lists.h"
#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

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
	const double mean = sumOver(integrals, [count](double integral) { return integral / count; });
	const double variance =
		sumOver(integrals, [mean, count](double integral) { return (integral - mean) * (integral - mean) / count; });
	return std::sqrt(variance) / mean;
}

namespace
{

constexpr int kCircleSides = 192;           // deviates from the circle by 1.3e-4 of its radius: a twentieth of a pixel
constexpr double kArcStep = 0.06;           // radians of great circle per segment
constexpr std::size_t kAllAgainstAll = 200; // with fewer points, finding neighbours does not pay

// For each point, the points that may cut its cell; a point without a cell is its own only neighbour.
std::vector<std::vector<std::size_t>> possibleNeighbours(const Pattern& pattern)
{
	const std::size_t count = pattern.count();
	std::vector<std::vector<std::size_t>> lists(count);
	if (count <= kAllAgainstAll)
	{
		lists.assign(count, listOf(count, [](std::size_t j) { return j; }));
		return lists;
	}
	const Cells cells = exactCells(pattern.domain, pattern.points, pattern.powers);
	for (const Facet& facet : cells.facets)
	{
		lists[static_cast<std::size_t>(facet.a)].push_back(static_cast<std::size_t>(facet.b));
		lists[static_cast<std::size_t>(facet.b)].push_back(static_cast<std::size_t>(facet.a));
	}
	for (std::size_t i = 0; i < count; ++i)
	{
		if (cells.integrals[i] <= 0.0)
		{
			lists[i] = {i};
		}
	}
	return lists;
}

double powerOf(const Pattern& pattern, std::size_t i)
{
	return pattern.powers.empty() ? 0.0 : pattern.powers[i];
}

CellPolygon unitCircle()
{
	const auto cornerOf = [](std::size_t i)
	{
		const SinCos turn = sinCosOf(2.0 * kPi * static_cast<double>(i) / kCircleSides);
		return glm::dvec2(turn.cos, turn.sin);
	};
	return listOf(kCircleSides, cornerOf);
}

// Power diagram of plane points; reach[i] is the power of point i.
std::vector<CellPolygon> powerPolygons(const Pattern& pattern, const std::vector<double>& reach)
{
	const std::vector<std::vector<std::size_t>> neighbours = possibleNeighbours(pattern);
	std::vector<CellPolygon> polygons(pattern.count());
	CellPolygon scratch;
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		if (neighbours[i].size() == 1 && neighbours[i].front() == i && pattern.count() > 1)
		{
			continue;
		}
		const glm::dvec2 p{pattern.points[i]};
		polygons[i] = unitCircle();
		for (const std::size_t j : neighbours[i])
		{
			if (j == i)
			{
				continue;
			}
			const glm::dvec2 q{pattern.points[j]};
			// |x − p|² − reach_i ≤ |x − q|² − reach_j
			const glm::dvec2 normal = 2.0 * (q - p);
			const double offset = glm::dot(q, q) - reach[j] - glm::dot(p, p) + reach[i];
			clipConvex(
				polygons[i], scratch, [&](const glm::dvec2& x) { return offset - glm::dot(normal, x); }, OnEdge{});
		}
	}
	return polygons;
}

// The first plane that cuts the hemisphere leaves a lune whose edge on that plane is half a great circle. A corner half way splits
// it into two quarters, which segments can represent.
void splitHalfCircle(std::vector<glm::dvec3>& polygon, const glm::dvec3& plane_normal)
{
	for (std::size_t k = 0; k < polygon.size(); ++k)
	{
		const glm::dvec3& a = polygon[k];
		const glm::dvec3& b = polygon[k + 1 < polygon.size() ? k + 1 : 0];
		if (glm::dot(a, b) < -1.0 + 1e-9)
		{
			const glm::dvec3 half = glm::normalize(glm::cross(plane_normal, a));
			polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(k) + 1, half.z < 0.0 ? -half : half);
			return;
		}
	}
}

// Appends the projected great-circle arc from a to b, without b.
void appendArc(CellPolygon& outline, const glm::dvec3& a, const glm::dvec3& b)
{
	const double angle = 2.0 * asinOf(std::fmin(1.0, 0.5 * glm::length(b - a)));
	const int steps = std::max(1, static_cast<int>(std::ceil(angle / kArcStep)));
	for (int k = 0; k < steps; ++k)
	{
		const double u = angle * k / steps;
		const glm::dvec3 x = steps == 1 ? a : glm::normalize(sinCosOf(angle - u).sin * a + sinCosOf(u).sin * b);
		outline.emplace_back(x.x, x.y);
	}
}

} // namespace

std::vector<CellPolygon> planeCellPolygons(const Pattern& pattern)
{
	return powerPolygons(pattern, listOf(pattern.count(), [&](std::size_t i) { return powerOf(pattern, i); }));
}

std::vector<CellPolygon> sectionPolygons(const Pattern& pattern)
{
	return powerPolygons(pattern, listOf(pattern.count(), [&](std::size_t i)
										 { return powerOf(pattern, i) - pattern.points[i].z * pattern.points[i].z; }));
}

std::vector<CellPolygon> spherePolygons(const Pattern& pattern, const glm::dmat3& view)
{
	const std::vector<std::vector<std::size_t>> neighbours = possibleNeighbours(pattern);
	// The cell of i is where scaled_i · x is greatest.
	const std::vector<glm::dvec3> scaled = listOf(
		pattern.count(), [&](std::size_t i) -> glm::dvec3 { return expOf(powerOf(pattern, i)) * (pattern.points[i] * view); });
	std::vector<CellPolygon> outlines(pattern.count());
	std::vector<glm::dvec3> scratch;
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		// The hemisphere facing the viewer: four quarters of its rim.
		std::vector<glm::dvec3> polygon{{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, -1.0, 0.0}};
		for (const std::size_t j : neighbours[i])
		{
			const glm::dvec3 normal = scaled[i] - scaled[j];
			clipConvex(
				polygon, scratch, [&](const glm::dvec3& x) { return glm::dot(normal, x); },
				[](const glm::dvec3& a, const glm::dvec3& b, double t, bool) { return glm::normalize(a + t * (b - a)); });
			splitHalfCircle(polygon, normal);
		}
		for (std::size_t k = 0; k < polygon.size(); ++k)
		{
			appendArc(outlines[i], polygon[k], polygon[k + 1 < polygon.size() ? k + 1 : 0]);
		}
	}
	return outlines;
}

} // namespace nook
