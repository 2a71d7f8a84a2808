// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of plane points in the unit disk, for the chord density 2√(1−r²) of line samples and for the uniform density.
//
// A cell is a convex polygon cut out of a square around the disk. Its integral is a sum over its edges of the wedge from the origin
// to the edge, clipped to the unit circle. Let h be the distance of the edge's line from the origin, s the position along it from
// the foot of the perpendicular, B = 1 − h² and c = √(B − s²). The antiderivatives below follow from
// √(1−w)³/w = 1/(w√(1−w)) − 1/√(1−w) − √(1−w) with w = h² + s². Centroids use ∫ x f = −∮ F n with ∇F = x f and F = 0 on the circle.
#include "core/convex_clip.h"
#include "core/math.h"
#include "pattern/cells.h"

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
	PlaneCell(Domain domain, std::span<const glm::dvec3> points) : m_domain(domain), m_points(points) {}

	void build(int index, std::span<const double> powers, const std::vector<int>& neighbours)
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
			if (!powers.empty())
			{
				offset += 0.5 * (powers[i] - powers[j]);
			}
			const double length = std::sqrt(dx * dx + dy * dy);
			clip(m_polygon, m_scratch, dx / length, dy / length, offset / length, neighbour);
		}
	}

	void addTo(Cells& cells)
	{
		const auto i = static_cast<std::size_t>(m_index);
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
	int m_index = 0;
	std::vector<Corner> m_polygon;
	std::vector<Corner> m_scratch;
};

} // namespace

Cells planeCells(Domain domain, std::span<const glm::dvec3> points, std::span<const double> powers)
{
	const Neighbours neighbours = planeNeighbours(points, powers);
	Cells cells;
	cells.integrals.assign(points.size(), 0.0);
	cells.centroids.assign(points.begin(), points.end());
	PlaneCell cell(domain, points);
	for (std::size_t i = 0; i < points.size(); ++i)
	{
		if (neighbours.visible[i] != 0)
		{
			cell.build(static_cast<int>(i), powers, neighbours.lists[i]);
			cell.addTo(cells);
		}
	}
	return cells;
}

} // namespace nook::detail
