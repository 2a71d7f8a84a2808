// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of plane points in the unit disk, for the chord density 2√(1−r²) of line samples and for the uniform density.
//
// A cell is a convex polygon cut out of a square around the disk. Its integral is a sum over its edges of the wedge from the origin
// to the edge, clipped to the unit circle. Let h be the distance of the edge's line from the origin, s the position along it from
// the foot of the perpendicular, B = 1 − h² and c = √(B − s²). The antiderivatives below follow from
// √(1−w)³/w = 1/(w√(1−w)) − 1/√(1−w) − √(1−w) with w = h² + s². Centroids use ∫ x f = −∮ F n with ∇F = x f and F = 0 on the circle.
#include "core/convex_clip.h"
#include "core/lists.h"
#include "core/math.h"
#include "pattern/cells.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>

namespace nook::detail
{
namespace
{

constexpr int kBox = -1; // label of an edge of the enclosing square

struct Corner
{
	double x;
	double y;
	int label; // the neighbour across the edge that starts here, or kBox
};

// Keeps the part of a convex polygon where n·x ≤ offset and labels the new edge.
void clip(std::vector<Corner>& polygon, std::vector<Corner>& scratch, double nx, double ny, double offset, int label)
{
	clipConvex(
		polygon, scratch, [&](const Corner& corner) { return offset - (nx * corner.x + ny * corner.y); },
		[&](const Corner& a, const Corner& b, double t, bool leaves) {
			return Corner{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), leaves ? label : a.label};
		});
}

// Contribution of one straight edge, for total measure 1: the wedge, the density over the edge, its first moment along it, and ∫F
// over the part inside the disk.
struct EdgeTerms
{
	double wedge = 0.0;
	double mass = 0.0;
	double along = 0.0;
	double potential = 0.0;
};

// The part of an edge inside the disk, from s0 to s1 (|s| ≤ √B), chord density 3/(4π)·2√(1−r²). h ≥ 0.
EdgeTerms chordTerms(double h, double s0, double s1)
{
	const double b = (1.0 - h) * (1.0 + h);
	EdgeTerms terms;
	double sign = -1.0;
	for (const double s : {s0, s1})
	{
		const double c2 = b - s * s;
		const double c = c2 > 0.0 ? std::sqrt(c2) : 0.0;
		const double turn = atan2Of(s, c);
		const double wedge = atan2Of(s, h) - atan2Of(s, h * c) + h * turn + 0.5 * h * (s * c + b * turn);
		terms.wedge += sign * wedge / (2.0 * kPi);
		terms.mass += sign * 0.75 / kPi * (s * c + b * turn);
		terms.along -= sign * 0.5 / kPi * c * c * c;
		terms.potential -= sign * 0.5 / kPi * (0.25 * s * c * c * c + 0.375 * b * (s * c + b * turn));
		sign = 1.0;
	}
	return terms;
}

// Likewise for the uniform density 1/π.
EdgeTerms uniformTerms(double h, double s0, double s1)
{
	const double b = (1.0 - h) * (1.0 + h);
	EdgeTerms terms;
	terms.wedge = h * (s1 - s0) / (2.0 * kPi);
	terms.mass = (s1 - s0) / kPi;
	terms.along = (s1 * s1 - s0 * s0) / (2.0 * kPi);
	terms.potential = -0.5 / kPi * (b * (s1 - s0) - (s1 * s1 * s1 - s0 * s0 * s0) / 3.0);
	return terms;
}

// Angle that the part s0…s1 of a line at distance h ≥ 0 subtends at the origin.
double angleBetween(double h, double s0, double s1)
{
	return atan2Of(s1, h) - atan2Of(s0, h);
}

class PlaneCell
{
public:
	PlaneCell(Domain domain, std::span<const glm::dvec3> points, std::span<const double> powers)
		: m_domain(domain), m_points(points), m_powers(powers)
	{
	}

	void addTo(Cells& cells, int index, const std::vector<int>& neighbours)
	{
		m_index = index;
		m_polygon = {{-2.0, -2.0, kBox}, {2.0, -2.0, kBox}, {2.0, 2.0, kBox}, {-2.0, 2.0, kBox}};
		const auto i = static_cast<std::size_t>(index);
		const glm::dvec3& p = m_points[i];
		for (const int neighbour : neighbours)
		{
			const auto j = static_cast<std::size_t>(neighbour);
			const glm::dvec3& q = m_points[j];
			const double dx = q.x - p.x;
			const double dy = q.y - p.y;
			double offset = 0.5 * (dx * (p.x + q.x) + dy * (p.y + q.y));
			if (!m_powers.empty())
			{
				offset += 0.5 * (m_powers[i] - m_powers[j]);
			}
			const double length = std::sqrt(dx * dx + dy * dy);
			clip(m_polygon, m_scratch, dx / length, dy / length, offset / length, neighbour);
		}
		double integral = 0.0;
		glm::dvec3 moment(0.0);
		for (std::size_t k = 0; k < m_polygon.size(); ++k)
		{
			const Corner& a = m_polygon[k];
			const Corner& b = m_polygon[k + 1 < m_polygon.size() ? k + 1 : 0];
			addEdge(a, b, integral, moment, cells);
		}
		cells.integrals[i] = std::max(integral, 0.0);
		cells.centroids[i] = integral > kLeastCell ? moment / integral : m_points[i];
	}

private:
	void addEdge(const Corner& a, const Corner& b, double& integral, glm::dvec3& moment, Cells& cells)
	{
		const double length = std::sqrt((b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y));
		if (length == 0.0)
		{
			return;
		}
		const double tx = (b.x - a.x) / length;
		const double ty = (b.y - a.y) / length;
		const double offset = 0.5 * (ty * (a.x + b.x) - tx * (a.y + b.y)); // outward normal (ty, −tx)
		const double sign = offset < 0.0 ? -1.0 : 1.0;
		const double h = std::fabs(offset);
		const double s0 = a.x * tx + a.y * ty;
		const double s1 = b.x * tx + b.y * ty;
		if (h >= 1.0)
		{
			integral += sign * angleBetween(h, s0, s1) / (2.0 * kPi);
			return;
		}
		const double reach = std::sqrt((1.0 - h) * (1.0 + h));
		const double c0 = std::min(std::max(s0, -reach), reach);
		const double c1 = std::min(std::max(s1, -reach), reach);
		if (c0 != s0)
		{
			integral += sign * angleBetween(h, s0, c0) / (2.0 * kPi);
		}
		if (c1 != s1)
		{
			integral += sign * angleBetween(h, c1, s1) / (2.0 * kPi);
		}
		if (c1 <= c0)
		{
			return;
		}
		const EdgeTerms terms = m_domain == Domain::disk ? chordTerms(h, c0, c1) : uniformTerms(h, c0, c1);
		integral += sign * terms.wedge;
		const glm::dvec3 normal(ty, -tx, 0.0);
		const glm::dvec3 tangent(tx, ty, 0.0);
		moment += terms.potential * normal;
		if (a.label > m_index)
		{
			cells.facets.push_back({m_index, a.label, terms.mass, offset * terms.mass * normal + terms.along * tangent});
		}
	}

	Domain m_domain;
	std::span<const glm::dvec3> m_points;
	std::span<const double> m_powers;
	int m_index = 0;
	std::vector<Corner> m_polygon;
	std::vector<Corner> m_scratch;
};

// Cells of points in the unit ball, density 3/(4π).
//
// A cell is a convex polyhedron cut out of a cube around the ball. By the divergence theorem its volume inside the ball is ⅓ Σ over
// faces of (h · area of the face inside the ball + solid angle of the face's part outside), with h the signed distance of the
// face's plane from the origin. Within a face, both are sums over its edges of wedges from the foot of the perpendicular, clipped
// to the circle of radius ρ = √(1−h²). Each term is continuous where a plane passes through the origin, so symmetric sets, whose
// cells meet there, need no special treatment.

constexpr double kBoxHalf = 2.0;
constexpr double kBallDensity = 0.75 / kPi;

struct Plane
{
	glm::dvec3 normal; // unit, outward
	double offset;     // n·x ≤ offset inside
	int label;         // the neighbour across the plane, or −1 for the box
};

struct FaceTerms
{
	double volume = 0.0;    // contribution to the cell's volume
	double area = 0.0;      // inside the ball
	glm::dvec3 moment{0.0}; // ∫ x over that area
	double potential = 0.0; // ∫ (1 − r²) over that area
};

// One edge of a face, seen from the foot of the perpendicular in the face's plane: signed distance d, from s0 to s1.
struct FaceEdge
{
	double d;
	double s0;
	double s1;
	glm::dvec3 normal; // outward, in the plane
};

// Solid angle of the triangle (foot, s0, s1) less h times its angle; Ω = Δφ − this, outside the ball h·Δφ − this.
double slant(double h, double d, double s)
{
	return atan2Of(h * s, d * std::sqrt(h * h + d * d + s * s));
}

void addEdge(const FaceEdge& edge, double h, FaceTerms& terms, double& outside, double& inner_moment)
{
	const double d = std::fabs(edge.d);
	const double sign = edge.d < 0.0 ? -1.0 : 1.0;
	const auto angle = [&](double s0, double s1)
	{
		return sign * (atan2Of(s1, d) - atan2Of(s0, d));
	};
	const auto slants = [&](double s0, double s1)
	{
		return sign * (slant(h, d, s1) - slant(h, d, s0));
	};
	inner_moment = 0.0;
	if (h >= 1.0)
	{
		outside += angle(edge.s0, edge.s1) - slants(edge.s0, edge.s1);
		return;
	}
	const double rho2 = (1.0 - h) * (1.0 + h);
	const double reach2 = rho2 - d * d;
	const double reach = reach2 > 0.0 ? std::sqrt(reach2) : 0.0;
	double c0 = std::min(std::max(edge.s0, -reach), reach);
	double c1 = std::min(std::max(edge.s1, -reach), reach);
	if (reach2 <= 0.0) // the whole edge lies outside the circle
	{
		c0 = edge.s0;
		c1 = edge.s0;
	}
	double out_angle = 0.0;
	if (c0 != edge.s0)
	{
		out_angle += angle(edge.s0, c0);
		outside -= slants(edge.s0, c0);
	}
	if (c1 != edge.s1)
	{
		out_angle += angle(c1, edge.s1);
		outside -= slants(c1, edge.s1);
	}
	outside += h * out_angle;
	terms.area += 0.5 * rho2 * out_angle;
	terms.potential += 0.25 * rho2 * rho2 * out_angle;
	if (c1 > c0)
	{
		const double length = c1 - c0;
		const double cubes = (c1 * c1 * c1 - c0 * c0 * c0) / 3.0;
		terms.area += 0.5 * edge.d * length;
		terms.potential += edge.d * (0.5 * rho2 * length - 0.25 * (d * d * length + cubes));
		inner_moment = -0.5 * (reach2 * length - cubes);
	}
}

FaceTerms faceTerms(const std::vector<glm::dvec3>& polygon, const Plane& plane)
{
	FaceTerms terms;
	const double h = std::fabs(plane.offset);
	const glm::dvec3 foot = plane.offset * plane.normal;
	double outside = 0.0;
	for (std::size_t k = 0; k < polygon.size(); ++k)
	{
		const glm::dvec3 a = polygon[k] - foot;
		const glm::dvec3 b = polygon[k + 1 < polygon.size() ? k + 1 : 0] - foot;
		const double length = glm::length(b - a);
		if (length == 0.0)
		{
			continue;
		}
		const glm::dvec3 tangent = (b - a) / length;
		const glm::dvec3 normal = glm::cross(tangent, plane.normal);
		const FaceEdge edge{0.5 * glm::dot(normal, a + b), glm::dot(tangent, a), glm::dot(tangent, b), normal};
		double inner_moment = 0.0;
		addEdge(edge, h, terms, outside, inner_moment);
		terms.moment += inner_moment * normal;
	}
	terms.moment += terms.area * foot;
	terms.volume = (plane.offset * terms.area + (plane.offset < 0.0 ? -outside : outside)) / 3.0;
	return terms;
}

// Keeps the part of a convex polygon on the inner side of a plane.
void clip(std::vector<glm::dvec3>& polygon, std::vector<glm::dvec3>& scratch, const Plane& plane)
{
	const auto side = [&](const glm::dvec3& x)
	{
		return plane.offset - glm::dot(plane.normal, x);
	};
	if (std::any_of(polygon.begin(), polygon.end(), [&](const glm::dvec3& x) { return !(side(x) >= 0.0); }))
	{
		clipConvex(polygon, scratch, side, OnEdge{}); // most planes of a cell miss a given face
	}
}

// Two unit vectors that form a right-handed frame with the unit vector n.
std::array<glm::dvec3, 2> axesAround(const glm::dvec3& n)
{
	const glm::dvec3 axis = std::fabs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
	const glm::dvec3 u = glm::normalize(glm::cross(axis, n));
	return {u, glm::cross(n, u)};
}

// A square in the plane that covers its intersection with the box, counter-clockwise seen from outside.
void startFace(const Plane& plane, std::vector<glm::dvec3>& polygon)
{
	const auto [u, v] = axesAround(plane.normal);
	const glm::dvec3 foot = plane.offset * plane.normal;
	const double r = 4.0 * kBoxHalf;
	polygon = {foot - r * u - r * v, foot + r * u - r * v, foot + r * u + r * v, foot - r * u + r * v};
}

class SpaceCell
{
public:
	SpaceCell(std::span<const glm::dvec3> points, std::span<const double> powers) : m_points(points), m_powers(powers) {}

	void addTo(Cells& cells, int index, const std::vector<int>& neighbours)
	{
		collectPlanes(static_cast<std::size_t>(index), neighbours);
		double volume = 0.0;
		glm::dvec3 moment(0.0);
		for (const Plane& plane : m_planes)
		{
			if (plane.offset >= 2.0 * kBoxHalf || plane.offset <= -2.0 * kBoxHalf)
			{
				continue; // misses the box
			}
			startFace(plane, m_polygon);
			for (const Plane& other : m_planes)
			{
				if (&other != &plane)
				{
					clip(m_polygon, m_scratch, other);
				}
				if (m_polygon.empty())
				{
					break;
				}
			}
			if (m_polygon.size() < 3)
			{
				continue;
			}
			const FaceTerms terms = faceTerms(m_polygon, plane);
			volume += terms.volume;
			moment -= 0.5 * terms.potential * plane.normal;
			if (plane.label > index && terms.area > 0.0)
			{
				cells.facets.push_back({index, plane.label, kBallDensity * terms.area, kBallDensity * terms.moment});
			}
		}
		const auto i = static_cast<std::size_t>(index);
		cells.integrals[i] = std::max(kBallDensity * volume, 0.0);
		cells.centroids[i] = cells.integrals[i] > kLeastCell ? moment / volume : m_points[i];
	}

private:
	void collectPlanes(std::size_t i, const std::vector<int>& neighbours)
	{
		m_planes.clear();
		const glm::dvec3& p = m_points[i];
		for (const int neighbour : neighbours)
		{
			const auto j = static_cast<std::size_t>(neighbour);
			const glm::dvec3 difference = m_points[j] - p;
			const double length = glm::length(difference);
			double offset = 0.5 * glm::dot(difference, m_points[j] + p);
			if (!m_powers.empty())
			{
				offset += 0.5 * (m_powers[i] - m_powers[j]);
			}
			m_planes.push_back({difference / length, offset / length, neighbour});
		}
		for (int axis = 0; axis < 3; ++axis)
		{
			for (const double side : {-1.0, 1.0})
			{
				glm::dvec3 normal(0.0);
				normal[axis] = side;
				m_planes.push_back({normal, kBoxHalf, -1});
			}
		}
	}

	std::span<const glm::dvec3> m_points;
	std::span<const double> m_powers;
	std::vector<Plane> m_planes;
	std::vector<glm::dvec3> m_polygon;
	std::vector<glm::dvec3> m_scratch;
};

// Cells of directions on the unit sphere, density 1/4π: spherical Voronoi diagrams or, with powers, the spherical Laguerre diagram
// (Sugihara, "Laguerre Voronoi diagram on the sphere", 2002), whose borders are also great circles.

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
	// The fan's triangles lose all precision at a corner nearly opposite to the direction (clusters of directions).
	if (std::any_of(polygon.begin(), polygon.end(),
					[&](const ArcCorner& corner) { return glm::dot(direction, corner.x) < -0.999; }))
	{
		area = turningArea(polygon, mapped(polygon, [&](const ArcCorner& corner)
										   { return glm::normalize(scaled[i] - scaled[static_cast<std::size_t>(corner.label)]); }));
	}
	cells.integrals[i] = std::max(kSphereDensity * area, 0.0);
	cells.centroids[i] = cells.integrals[i] > kLeastCell ? moment / area : direction;
}

// The cells of the visible points, each added by add(cells, index, its neighbours).
template <class Add> Cells cellsOf(std::span<const glm::dvec3> points, const Neighbours& neighbours, const Add& add)
{
	Cells cells;
	cells.integrals.assign(points.size(), 0.0);
	cells.centroids.assign(points.begin(), points.end());
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		if (neighbours.visible[i] != 0)
		{
			add(cells, static_cast<int>(i), neighbours.lists[i]);
		}
	}
	return cells;
}

} // namespace

Cells planeCells(Domain domain, std::span<const glm::dvec3> points, std::span<const double> powers)
{
	PlaneCell cell(domain, points, powers);
	return cellsOf(points, planeNeighbours(points, powers),
				   [&](Cells& cells, int i, const std::vector<int>& list) { cell.addTo(cells, i, list); });
}

Cells spaceCells(std::span<const glm::dvec3> points, std::span<const double> powers)
{
	SpaceCell cell(points, powers);
	return cellsOf(points, spaceNeighbours(points, powers),
				   [&](Cells& cells, int i, const std::vector<int>& list) { cell.addTo(cells, i, list); });
}

Cells directionCells(std::span<const glm::dvec3> points, std::span<const double> powers)
{
	std::vector<glm::dvec3> unit(points.size());
	std::vector<glm::dvec3> scaled(points.size());
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		unit[i] = glm::normalize(points[i]); // rounded directions are not exactly of unit length
		scaled[i] = powers.empty() ? unit[i] : expOf(powers[i]) * unit[i];
	}
	std::vector<ArcCorner> polygon;
	std::vector<ArcCorner> scratch;
	const auto add = [&](Cells& cells, int index, const std::vector<int>& list)
	{
		const auto i = static_cast<std::size_t>(index);
		if (list.empty()) // no neighbours: the whole sphere
		{
			cells.integrals[i] = 1.0;
			cells.centroids[i] = glm::dvec3(0.0);
			return;
		}
		polygon.clear();
		for (std::size_t k = 0; k < list.size(); ++k)
		{
			const glm::dvec3 n = glm::normalize(scaled[i] - scaled[static_cast<std::size_t>(list[k])]);
			if (k == 0)
			{
				const auto [u, v] = axesAround(n); // the hemisphere around n as four quarter arcs
				polygon = {{u, list[k]}, {v, list[k]}, {-u, list[k]}, {-v, list[k]}};
			}
			else
			{
				clip(polygon, scratch, n, list[k]);
			}
		}
		if (polygon.size() >= 2)
		{
			addCell(cells, index, unit[i], polygon, scaled);
		}
	};
	return cellsOf(points, directionNeighbours(scaled), add);
}

} // namespace nook::detail
