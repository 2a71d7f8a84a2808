// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: G. H. Meisters, "Polygons Have Ears", 1975; holes joined to the outline by bridges as in D. Eberly,
// "Triangulation by Ear Clipping", 2002. The best-shaped ear is cut first, so that arches do not become long slivers. Not CGAL's
// constrained Delaunay triangulation, which makes other triangles: committed pictures, volumes and figures depend on those of the
// built-in levels.
#include "scene/builtin_polygon.h"

#include "core/math.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

// A remaining corner of the polygon, in a ring.
struct Corner
{
	glm::dvec2 at{};
	uint32_t index = 0;
	double ear = 0.0; // shape of the triangle with its neighbours; 0 if it is no ear
};

double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// True if the segments share a point other than a common end.
bool touches(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, glm::dvec2 d)
{
	const auto holds = [](glm::dvec2 from, glm::dvec2 to, glm::dvec2 p)
	{
		return p != from && p != to && turn(from, to, p) == 0.0 && glm::dot(p - from, p - to) < 0.0;
	};
	if (holds(a, b, c) || holds(a, b, d) || holds(c, d, a) || holds(c, d, b))
	{
		return true;
	}
	if (a == c || a == d || b == c || b == d)
	{
		return false;
	}
	return (turn(a, b, c) > 0.0) != (turn(a, b, d) > 0.0) && (turn(c, d, a) > 0.0) != (turn(c, d, b) > 0.0);
}

bool touchesAny(const std::vector<Corner>& ring, glm::dvec2 a, glm::dvec2 b)
{
	for (std::size_t i = 0; i < ring.size(); ++i)
	{
		if (touches(a, b, ring[i].at, ring[(i + 1) % ring.size()].at))
		{
			return true;
		}
	}
	return false;
}

// True if the line from corner i to `to` starts inside the ring: a point that a bridge visits twice has two corners.
bool beginsInside(const std::vector<Corner>& ring, std::size_t i, glm::dvec2 to)
{
	const glm::dvec2 before = ring[(i + ring.size() - 1) % ring.size()].at;
	const glm::dvec2 at = ring[i].at;
	const glm::dvec2 after = ring[(i + 1) % ring.size()].at;
	if (turn(before, at, after) > 0.0)
	{
		return turn(at, to, before) > 0.0 && turn(to, at, after) > 0.0;
	}
	return !(turn(at, to, after) >= 0.0 && turn(to, at, before) >= 0.0);
}

// Joins a hole to the ring along the shortest line between them that crosses nothing.
void bridge(std::vector<Corner>& ring, const std::vector<Corner>& hole)
{
	struct Link
	{
		double length2;
		std::size_t from;
		std::size_t to;
	};
	std::vector<Link> links;
	for (std::size_t i = 0; i < ring.size(); ++i)
	{
		for (std::size_t j = 0; j < hole.size(); ++j)
		{
			const glm::dvec2 d = hole[j].at - ring[i].at;
			links.push_back({glm::dot(d, d), i, j});
		}
	}
	std::stable_sort(links.begin(), links.end(), [](const Link& a, const Link& b) { return a.length2 < b.length2; });
	const auto best =
		std::find_if(links.begin(), links.end(),
					 [&](const Link& link)
					 {
						 const glm::dvec2 a = ring[link.from].at;
						 const glm::dvec2 b = hole[link.to].at;
						 return beginsInside(ring, link.from, b) && !touchesAny(ring, a, b) && !touchesAny(hole, a, b);
					 });
	assert(best != links.end());
	std::vector<Corner> way;
	for (std::size_t k = 0; k <= hole.size(); ++k)
	{
		way.push_back(hole[(best->to + k) % hole.size()]);
	}
	way.push_back(ring[best->from]);
	ring.insert(ring.begin() + static_cast<std::ptrdiff_t>(best->from) + 1, way.begin(), way.end());
}

// Area divided by the square of the longest side: 0.433 for an equilateral triangle.
double shapeOf(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	const double longest = std::max({glm::dot(b - a, b - a), glm::dot(c - b, c - b), glm::dot(a - c, a - c)});
	return 0.5 * turn(a, b, c) / longest;
}

double earOf(const std::vector<Corner>& ring, std::size_t i)
{
	const std::size_t n = ring.size();
	const glm::dvec2 a = ring[(i + n - 1) % n].at;
	const glm::dvec2 b = ring[i].at;
	const glm::dvec2 c = ring[(i + 1) % n].at;
	const double shape = shapeOf(a, b, c);
	if (shape < 1e-9)
	{
		return 0.0;
	}
	// A point on a side counts as inside, even if rounding moved it off: the steps of a stair are collinear.
	const double on_side = -1e-10 * glm::dot(c - a, c - a);
	for (const Corner& corner : ring)
	{
		const glm::dvec2 p = corner.at;
		if (p != a && p != b && p != c && turn(a, b, p) >= on_side && turn(b, c, p) >= on_side && turn(c, a, p) >= on_side)
		{
			return 0.0;
		}
	}
	return shape;
}

} // namespace

std::vector<glm::uvec3> triangulateContours(const std::vector<Contour>& contours)
{
	std::vector<Corner> ring;
	uint32_t index = 0;
	for (const Contour& contour : contours)
	{
		std::vector<Corner> part;
		for (const glm::dvec2 point : contour)
		{
			part.push_back({point, index, 0.0});
			index += 1;
		}
		if (ring.empty())
		{
			ring = part;
		}
		else
		{
			bridge(ring, part);
		}
	}
	for (std::size_t i = 0; i < ring.size(); ++i)
	{
		ring[i].ear = earOf(ring, i);
	}
	std::vector<glm::uvec3> triangles;
	while (ring.size() >= 3)
	{
		const auto best =
			std::max_element(ring.begin(), ring.end(), [](const Corner& a, const Corner& b) { return a.ear < b.ear; });
		assert(best->ear > 0.0);
		const auto i = static_cast<std::size_t>(best - ring.begin());
		const std::size_t n = ring.size();
		triangles.emplace_back(ring[(i + n - 1) % n].index, ring[i].index, ring[(i + 1) % n].index);
		ring.erase(best);
		if (ring.size() >= 3)
		{
			const std::size_t after = i % ring.size();
			const std::size_t before = (i + ring.size() - 1) % ring.size();
			ring[after].ear = earOf(ring, after);
			ring[before].ear = earOf(ring, before);
		}
	}
	return triangles;
}

Contour arcOf(glm::dvec2 centre, double radius, double from_rad, double to_rad, int steps)
{
	Contour points;
	for (int i = 0; i <= steps; ++i)
	{
		const SinCos angle = sinCosOf(from_rad + (to_rad - from_rad) * i / steps);
		points.emplace_back(centre.x + radius * angle.cos, centre.y + radius * angle.sin);
	}
	return points;
}

Contour rectangleOf(glm::dvec2 least, glm::dvec2 most)
{
	return {least, {most.x, least.y}, most, {least.x, most.y}};
}

Contour holeOf(Contour contour)
{
	std::reverse(contour.begin(), contour.end());
	return contour;
}

void append(Contour& contour, const Contour& points)
{
	contour.insert(contour.end(), points.begin(), points.end());
}

} // namespace nook
