// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/inside_out.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

constexpr uint32_t kNoPart = UINT32_MAX;

// A part is flat if its volume is below that of its surface with this thickness: 32-bit positions are off by a quarter of it.
constexpr double kFlat = 0x1p-22; // relative to the part's diagonal

struct Part
{
	uint32_t first_triangle = 0;
	bool both_sides = true;
	Bounds bounds;
	double volume_m3 = 0.0;
	double area_m2 = 0.0;
	glm::dvec3 sum{0.0}; // of the corners of its triangles
	double corners = 0.0;
};

// States of a triangle's edges.
constexpr uint8_t kUnused = 0;
constexpr uint8_t kClosed = 1;
constexpr uint8_t kOpen = 2;

// A point that represents a part or a camera.
struct Point
{
	glm::dvec3 at{0.0};
	Bounds bounds;           // of everything it represents
	uint32_t part = kNoPart; // none for a camera
};

bool isWithin(const Bounds& inner, const Bounds& outer)
{
	return glm::all(glm::greaterThanEqual(inner.least, outer.least)) && glm::all(glm::lessThanEqual(inner.most, outer.most));
}

// Follows a ray upward from `p`: 1 if it leaves through the triangle's front, −1 through its back, 0 if it misses. It hits exactly
// one of two triangles that share an edge, because both evaluate the edge from the same end.
int turnsAbove(glm::dvec3 p, const std::array<glm::dvec3, 3>& corners)
{
	int turns = 0;
	for (std::size_t i = 0; i < 3; ++i)
	{
		const glm::dvec3 from = corners[i];
		const glm::dvec3 to = corners[(i + 1) % 3];
		if ((from.z <= p.z) == (to.z <= p.z))
		{
			continue;
		}
		const bool up = from.z < to.z;
		const glm::dvec3 low = up ? from : to;
		const glm::dvec3 high = up ? to : from;
		const bool beyond = (high.x - low.x) * (p.z - low.z) > (p.x - low.x) * (high.z - low.z);
		turns += beyond ? (up ? -1 : 1) : 0;
	}
	const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
	return across.y * glm::dot(across, corners[0] - p) > 0.0 ? turns : 0;
}

class Finder
{
public:
	Finder(const Level& level, const EdgeTable& edges, std::span<const uint32_t> meshes, std::span<const uint8_t> both_sides)
		: m_level(level), m_both_sides(both_sides), m_open(level.triangles.size(), kUnused),
		  m_part_of(level.triangles.size(), kNoPart)
	{
		Groups groups(level.triangles.size());
		const auto join = [&](std::span<const HalfEdge> sides)
		{
			const uint8_t found = isPair(sides) ? kClosed : kOpen;
			for (const HalfEdge& side : sides)
			{
				groups.join(sides[0].triangle(), side.triangle());
				m_open[side.triangle()] = std::max(m_open[side.triangle()], found);
			}
		};
		edges.each(0, edges.vertexCount(),
				   [&](std::span<const HalfEdge> edge)
				   {
					   if (edge.size() == 2)
					   {
						   join(edge);
						   return;
					   }
					   eachPart(edge, meshes, join);
				   });
		m_roots = std::move(groups).roots();
		for (uint32_t t = 0; t < m_open.size(); ++t)
		{
			m_open[m_roots[t]] = std::max(m_open[m_roots[t]], m_open[t]);
		}
	}

	std::vector<InsideOutPart> run()
	{
		addParts(kClosed);
		const std::size_t closed = m_parts.size();
		if (std::none_of(m_parts.begin(), m_parts.end(), [](const Part& part) { return part.volume_m3 < 0.0; }))
		{
			return {};
		}
		addParts(kOpen);
		measure();
		std::vector<uint32_t> inward;
		for (uint32_t part = 0; part < closed; ++part)
		{
			if (isInward(m_parts[part]))
			{
				inward.push_back(part);
			}
		}
		if (inward.empty())
		{
			return {};
		}
		std::vector<Point> points;
		for (const uint32_t part : inward)
		{
			points.push_back({cornersOf(m_parts[part].first_triangle)[0], m_parts[part].bounds, part});
		}
		std::vector<int> turns(closed, 0); // winding number of the closed parts around each
		std::vector<uint8_t> all(closed, 1);
		eachWithin(std::move(points), all, [&](uint32_t /*outer*/, const Point& point, int times) { turns[point.part] += times; });
		std::vector<uint8_t> asked(closed, 0);
		for (const uint32_t part : inward)
		{
			asked[part] = 1;
		}
		std::vector<uint8_t> is_room(closed, 0);
		eachWithin(allPoints(), asked, [&](uint32_t outer, const Point& /*point*/, int /*times*/) { is_room[outer] = 1; });
		std::vector<InsideOutPart> found;
		for (const uint32_t part : inward)
		{
			if (turns[part] <= 0 && is_room[part] == 0)
			{
				found.push_back({m_parts[part].first_triangle, m_parts[part].volume_m3});
			}
		}
		return found;
	}

private:
	std::array<glm::dvec3, 3> cornersOf(std::size_t triangle) const
	{
		const glm::uvec3& t = m_level.triangles[triangle];
		return {m_level.positions[t.x], m_level.positions[t.y], m_level.positions[t.z]};
	}

	// Numbers the parts that are `open` or closed, and computes the volumes of closed ones relative to one of their corners.
	void addParts(uint8_t open)
	{
		for (uint32_t t = 0; t < m_open.size(); ++t)
		{
			const uint32_t root = m_roots[t];
			if (m_open[root] != open)
			{
				continue;
			}
			if (root == t)
			{
				m_part_of[t] = static_cast<uint32_t>(m_parts.size());
				m_parts.emplace_back().first_triangle = t;
			}
			m_part_of[t] = m_part_of[root];
			Part& part = m_parts[m_part_of[t]];
			const auto [a, b, c] = cornersOf(t);
			part.volume_m3 += open == kOpen ? 0.0 : glm::dot(a - cornersOf(part.first_triangle)[0], glm::cross(b - a, c - a)) / 6.0;
			part.both_sides = part.both_sides && m_both_sides[t] != 0;
		}
	}

	void measure()
	{
		for (std::size_t t = 0; t < m_part_of.size(); ++t)
		{
			if (m_part_of[t] == kNoPart)
			{
				continue;
			}
			Part& part = m_parts[m_part_of[t]];
			const auto [a, b, c] = cornersOf(t);
			part.area_m2 += 0.5 * glm::length(glm::cross(b - a, c - a));
			part.bounds.least = glm::min(part.bounds.least, glm::min(a, glm::min(b, c)));
			part.bounds.most = glm::max(part.bounds.most, glm::max(a, glm::max(b, c)));
			part.sum += a + b + c;
			part.corners += 3.0;
		}
	}

	static bool isInward(const Part& part)
	{
		return !part.both_sides && part.volume_m3 < -kFlat * glm::length(part.bounds.most - part.bounds.least) * part.area_m2;
	}

	std::vector<Point> allPoints() const
	{
		std::vector<Point> points;
		for (uint32_t part = 0; part < m_parts.size(); ++part)
		{
			points.push_back({m_parts[part].sum / m_parts[part].corners, m_parts[part].bounds, part});
		}
		for (const LevelCamera& camera : m_level.cameras)
		{
			const glm::dvec3 eye(camera.world_from_camera[3]);
			points.push_back({eye, {eye, eye}, kNoPart});
		}
		return points;
	}

	// use(part, point, times) for each of the closed parts that are `asked` about and each point of another part, or camera, that
	// lies inside it with everything it represents. `times`: the winding number, negative if the part faces inward.
	template <class Use> void eachWithin(std::vector<Point> points, const std::vector<uint8_t>& asked, const Use& use) const
	{
		std::stable_sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.at.x < b.at.x; });
		std::vector<std::pair<uint32_t, uint32_t>> triangles; // part and triangle
		for (uint32_t t = 0; t < m_part_of.size(); ++t)
		{
			if (m_part_of[t] < asked.size() && asked[m_part_of[t]] != 0)
			{
				triangles.emplace_back(m_part_of[t], t);
			}
		}
		std::sort(triangles.begin(), triangles.end());
		const auto from = [](const Point& point, double x)
		{
			return point.at.x < x;
		};
		for (auto first = triangles.begin(), last = first; first != triangles.end(); first = last)
		{
			const uint32_t part = first->first;
			const Bounds& bounds = m_parts[part].bounds;
			std::vector<Point> within;
			for (auto point = std::lower_bound(points.begin(), points.end(), bounds.least.x, from);
				 point != points.end() && point->at.x <= bounds.most.x; ++point)
			{
				if (point->part != part && isWithin(point->bounds, bounds))
				{
					within.push_back(*point);
				}
			}
			std::vector<int> times(within.size(), 0);
			for (; last != triangles.end() && last->first == part; ++last)
			{
				if (within.empty())
				{
					continue;
				}
				const std::array<glm::dvec3, 3> corners = cornersOf(last->second);
				const auto [least, most] = std::minmax({corners[0].x, corners[1].x, corners[2].x});
				auto point = std::lower_bound(within.begin(), within.end(), least, from);
				for (; point != within.end() && point->at.x <= most; ++point)
				{
					times[static_cast<std::size_t>(point - within.begin())] += turnsAbove(point->at, corners);
				}
			}
			for (std::size_t i = 0; i < within.size(); ++i)
			{
				if (times[i] != 0)
				{
					use(part, within[i], times[i]);
				}
			}
		}
	}

	const Level& m_level;
	std::span<const uint8_t> m_both_sides;
	std::vector<uint32_t> m_roots;   // per triangle: the first of its part
	std::vector<uint8_t> m_open;     // stored for each part at its first triangle
	std::vector<uint32_t> m_part_of; // per triangle
	std::vector<Part> m_parts;       // closed ones, then the relevant open ones
};

} // namespace

std::vector<InsideOutPart> insideOutParts(const Level& level, const EdgeTable& edges, std::span<const uint32_t> meshes,
										  std::span<const uint8_t> both_sides)
{
	return Finder(level, edges, meshes, both_sides).run();
}

} // namespace nook
