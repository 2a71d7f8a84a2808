// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of directions on the unit sphere, density 1/4π: spherical Voronoi diagrams or, with powers, the spherical Laguerre diagram
// (Sugihara, "Laguerre Voronoi diagram on the sphere", 2002), whose borders are also great circles.
#include "core/convex_clip.h"
#include "core/lists.h"
#include "core/math.h"
#include "pattern/cells.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace nook::detail
{
namespace
{

constexpr double kSphereDensity = 0.25 / kPi;

struct ArcCorner
{
	glm::dvec3 x;
	int label; // the neighbour across the arc that starts here
};

// Keeps the part of a convex spherical polygon (arcs of at most a quarter turn) where n·x ≥ 0; n is a unit vector.
void clip(std::vector<ArcCorner>& polygon, std::vector<ArcCorner>& scratch, const glm::dvec3& n, int label)
{
	clipConvex(
		polygon, scratch, [&](const ArcCorner& corner) { return glm::dot(n, corner.x); },
		[&](const ArcCorner& a, const ArcCorner& b, double t, bool leaves) {
			return ArcCorner{glm::normalize(a.x + t * (b.x - a.x)), leaves ? label : a.label};
		});
	// The new arc may be up to half a turn long; split it so that it stays well defined.
	for (std::size_t k = 0; k < polygon.size(); ++k)
	{
		const glm::dvec3 a = polygon[k].x;
		const glm::dvec3 b = polygon[k + 1 < polygon.size() ? k + 1 : 0].x;
		if (polygon[k].label == label && glm::dot(a, b) < -1e-3)
		{
			const double angle = std::fabs(atan2Of(glm::dot(n, glm::cross(a, b)), glm::dot(a, b)));
			const SinCos half = sinCosOf(0.5 * angle);
			polygon.insert(polygon.begin() + static_cast<std::ptrdiff_t>(k) + 1,
						   {glm::normalize(half.cos * a + half.sin * glm::cross(n, a)), label});
			break;
		}
	}
}

// The hemisphere around `axis` as four quarter arcs.
void startPolygon(const glm::dvec3& axis, int label, std::vector<ArcCorner>& polygon)
{
	const glm::dvec3 helper = std::fabs(axis.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
	const glm::dvec3 u = glm::normalize(glm::cross(helper, axis));
	const glm::dvec3 v = glm::cross(axis, u);
	polygon = {{u, label}, {v, label}, {-u, label}, {-v, label}};
}

// Signed area of a spherical triangle (Van Oosterom and Strackee 1983).
double triangleArea(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
	const double volume = glm::dot(a, glm::cross(b, c));
	return 2.0 * atan2Of(volume, 1.0 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

// Girard: a full turn less the turning angles at the corners. `normals` are those of the arcs' planes, inward.
double turningArea(const std::vector<ArcCorner>& polygon, const std::vector<glm::dvec3>& normals)
{
	double area = 2.0 * kPi;
	for (std::size_t k = 0; k < polygon.size(); ++k)
	{
		const std::size_t before = k > 0 ? k - 1 : polygon.size() - 1;
		if (polygon[k].label != polygon[before].label)
		{
			area -= atan2Of(glm::dot(polygon[k].x, glm::cross(normals[before], normals[k])), glm::dot(normals[before], normals[k]));
		}
	}
	return std::max(area, 0.0);
}

// True if a corner is nearly opposite to the direction, where the fan's triangles lose all precision (clusters of directions).
bool reachesAround(const glm::dvec3& direction, const std::vector<ArcCorner>& polygon)
{
	return std::any_of(polygon.begin(), polygon.end(),
					   [&](const ArcCorner& corner) { return glm::dot(direction, corner.x) < -0.999; });
}

void addCell(Cells& cells, int index, const glm::dvec3& direction, const std::vector<ArcCorner>& polygon,
			 std::span<const glm::dvec3> scaled)
{
	double area = 0.0;
	glm::dvec3 moment(0.0);
	for (std::size_t k = 0; k < polygon.size(); ++k)
	{
		const glm::dvec3& a = polygon[k].x;
		const glm::dvec3& b = polygon[k + 1 < polygon.size() ? k + 1 : 0].x;
		area += triangleArea(direction, a, b);
		const glm::dvec3 normal = glm::cross(a, b);
		const double sine = glm::length(normal);
		if (sine == 0.0)
		{
			continue;
		}
		const double angle = atan2Of(sine, glm::dot(a, b));
		const glm::dvec3 m = normal / sine;
		moment += 0.5 * angle * m;
		if (polygon[k].label > index)
		{
			const SinCos turn = sinCosOf(angle);
			const glm::dvec3 arc_moment = turn.sin * a + (1.0 - turn.cos) * glm::cross(m, a);
			cells.facets.push_back({index, polygon[k].label, kSphereDensity * angle, kSphereDensity * arc_moment});
		}
	}
	const auto i = static_cast<std::size_t>(index);
	if (reachesAround(direction, polygon))
	{
		const auto normalOf = [&](const ArcCorner& corner)
		{
			return glm::normalize(scaled[i] - scaled[static_cast<std::size_t>(corner.label)]);
		};
		area = turningArea(polygon, mapped(polygon, normalOf));
	}
	cells.integrals[i] = std::max(kSphereDensity * area, 0.0);
	cells.centroids[i] = cells.integrals[i] > kLeastCell ? moment / area : direction;
}

} // namespace

Cells directionCells(std::span<const glm::dvec3> points, std::span<const double> powers)
{
	std::vector<glm::dvec3> unit(points.size());
	std::vector<glm::dvec3> scaled(points.size());
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		unit[i] = glm::normalize(points[i]); // rounded directions are not exactly of unit length
		scaled[i] = powers.empty() ? unit[i] : expOf(powers[i]) * unit[i];
	}
	const Neighbours neighbours = directionNeighbours(scaled);
	Cells cells;
	cells.integrals.assign(points.size(), 0.0);
	cells.centroids.assign(points.begin(), points.end());
	std::vector<ArcCorner> polygon;
	std::vector<ArcCorner> scratch;
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		const std::vector<int>& list = neighbours.lists[i];
		if (neighbours.visible[i] != 0 && list.empty()) // no neighbours: the whole sphere
		{
			cells.integrals[i] = 1.0;
			cells.centroids[i] = glm::dvec3(0.0);
			continue;
		}
		polygon.clear();
		for (std::size_t k = 0; k < list.size(); ++k)
		{
			const glm::dvec3 n = glm::normalize(scaled[i] - scaled[static_cast<std::size_t>(list[k])]);
			if (k == 0)
			{
				startPolygon(n, list[k], polygon);
			}
			else
			{
				clip(polygon, scratch, n, list[k]);
			}
		}
		if (polygon.size() >= 2)
		{
			addCell(cells, static_cast<int>(i), unit[i], polygon, scaled);
		}
	}
	return cells;
}

} // namespace nook::detail
