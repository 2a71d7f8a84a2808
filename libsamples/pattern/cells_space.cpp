// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of points in the unit ball, density 3/(4π).
//
// A cell is a convex polyhedron cut out of a cube around the ball. By the divergence theorem its volume inside the ball is ⅓ Σ over
// faces of (h · area of the face inside the ball + solid angle of the face's part outside), with h the signed distance of the
// face's plane from the origin. Within a face, both are sums over its edges of wedges from the foot of the perpendicular, clipped
// to the circle of radius ρ = √(1−h²). Each term is continuous where a plane passes through the origin, so symmetric sets, whose
// cells meet there, need no special treatment.
#include "core/convex_clip.h"
#include "core/math.h"
#include "pattern/cells.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace nook::detail
{
namespace
{

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

// A square in the plane that covers its intersection with the box, counter-clockwise seen from outside.
void startFace(const Plane& plane, std::vector<glm::dvec3>& polygon)
{
	const glm::dvec3& n = plane.normal;
	const glm::dvec3 axis = std::fabs(n.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
	const glm::dvec3 u = glm::normalize(glm::cross(axis, n));
	const glm::dvec3 v = glm::cross(n, u);
	const glm::dvec3 foot = plane.offset * n;
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

} // namespace

Cells spaceCells(std::span<const glm::dvec3> points, std::span<const double> powers)
{
	const Neighbours neighbours = spaceNeighbours(points, powers);
	Cells cells;
	cells.integrals.assign(points.size(), 0.0);
	cells.centroids.assign(points.begin(), points.end());
	SpaceCell cell(points, powers);
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		if (neighbours.visible[i] != 0)
		{
			cell.addTo(cells, static_cast<int>(i), neighbours.lists[i]);
		}
	}
	return cells;
}

} // namespace nook::detail
