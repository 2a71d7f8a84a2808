// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load.h"

#include "core/lists.h"
#include "core/parallel.h"
#include "core/text.h"
#include "scene/load_parts.h"
#include "scene/topology.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <optional>
#include <utility>

namespace nook
{
namespace
{

constexpr uint32_t kNoPart = UINT32_MAX;

// A part is flat if its volume is below that of its surface with this thickness: 32-bit positions are off by a quarter of it.
constexpr double kFlat = 0x1p-22; // relative to the part's diagonal

struct SolidPart
{
	uint32_t first_triangle = 0;
	bool both_sides = true;
	Bounds bounds;
	double volume_m3 = 0.0; // signed: negative if it faces inward
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

// Finds parts that are inside out. A part consists of triangles connected by edges; it is closed if every edge has two triangles in
// opposite directions. If more than two meet, those of one mesh (meshes[triangle]) are paired. Excluded are
// - parts that look the same from both sides (both_sides[triangle] ≠ 0 for all of their triangles),
// - rooms: parts around another part or a camera,
// - cavities: parts inside closed parts that face outward.
// Sorted by the first triangle. Triangles that the edge table excludes belong to no part.
class InsideOutFinder
{
public:
	InsideOutFinder(const Level& level, const EdgeTable& edges, std::span<const uint32_t> meshes,
					std::span<const uint8_t> both_sides)
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

	std::vector<SolidPart> run()
	{
		addParts(kClosed);
		const std::size_t closed = m_parts.size();
		if (std::none_of(m_parts.begin(), m_parts.end(), [](const SolidPart& part) { return part.volume_m3 < 0.0; }))
		{
			return {};
		}
		addParts(kOpen);
		measure();
		std::vector<uint8_t> inward(closed, 0);
		std::vector<Point> points; // one of each inward part
		for (uint32_t i = 0; i < closed; ++i)
		{
			const SolidPart& part = m_parts[i];
			const double flat_m3 = kFlat * glm::length(part.bounds.most - part.bounds.least) * part.area_m2;
			if (!part.both_sides && part.volume_m3 < -flat_m3)
			{
				inward[i] = 1;
				points.push_back({cornersOf(part.first_triangle)[0], part.bounds, i});
			}
		}
		if (points.empty())
		{
			return {};
		}
		std::vector<int> turns(closed, 0); // winding number of the closed parts around each
		eachWithin(std::move(points), std::vector<uint8_t>(closed, 1),
				   [&](uint32_t /*outer*/, const Point& point, int times) { turns[point.part] += times; });
		std::vector<uint8_t> is_room(closed, 0);
		eachWithin(allPoints(), inward, [&](uint32_t outer, const Point& /*point*/, int /*times*/) { is_room[outer] = 1; });
		std::vector<SolidPart> found;
		for (std::size_t part = 0; part < closed; ++part)
		{
			if (inward[part] != 0 && turns[part] <= 0 && is_room[part] == 0)
			{
				found.push_back(m_parts[part]);
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
			SolidPart& part = m_parts[m_part_of[t]];
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
			SolidPart& part = m_parts[m_part_of[t]];
			const auto [a, b, c] = cornersOf(t);
			part.area_m2 += 0.5 * glm::length(glm::cross(b - a, c - a));
			part.bounds.least = glm::min(part.bounds.least, glm::min(a, glm::min(b, c)));
			part.bounds.most = glm::max(part.bounds.most, glm::max(a, glm::max(b, c)));
			part.sum += a + b + c;
			part.corners += 3.0;
		}
	}

	std::vector<Point> allPoints() const
	{
		std::vector<Point> points = mapped(countingFrom(0U, m_parts.size()),
										   [this](uint32_t part) {
											   return Point{m_parts[part].sum / m_parts[part].corners, m_parts[part].bounds, part};
										   });
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
				if (point->part != part && glm::all(glm::greaterThanEqual(point->bounds.least, bounds.least)) &&
					glm::all(glm::lessThanEqual(point->bounds.most, bounds.most)))
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
	std::vector<SolidPart> m_parts;  // closed ones, then the relevant open ones
};

// Maximum ratio of height to longest edge of a sliver. With 32-bit positions, if the triangle is ten thousand times as wide as
// their rounding, its direction is known to one part in a thousand at best.
constexpr double kSliver = 1e-4;

// Normals whose squared length is off by more are reported: twice the error of unit vectors with 8 bits per component.
constexpr double kNormalTolerance = 0.02;

constexpr uint32_t kNone = UINT32_MAX;

enum class Fate : uint8_t
{
	kept,
	out_of_range,
	non_finite,
	degenerate,
	duplicate,
};

bool isFinite(glm::dvec3 p)
{
	return glm::all(glm::lessThanEqual(glm::abs(p), glm::dvec3(kFarthest_m))); // false for NaN
}

double greatest(glm::dvec3 p)
{
	return std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
}

struct Shape
{
	Fate fate = Fate::kept;
	bool sliver = false;
};

Shape shapeOf(const Level& level, const glm::uvec3& triangle)
{
	const std::size_t count = level.positions.size();
	if (triangle.x >= count || triangle.y >= count || triangle.z >= count)
	{
		return {Fate::out_of_range, false};
	}
	const glm::dvec3 a = level.positions[triangle.x];
	const glm::dvec3 b = level.positions[triangle.y];
	const glm::dvec3 c = level.positions[triangle.z];
	if (!isFinite(a) || !isFinite(b) || !isFinite(c))
	{
		return {Fate::non_finite, false};
	}
	const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
	const double height = longest > 0.0 ? glm::length(glm::cross(b - a, c - a)) / longest : 0.0;
	// Positions went through a transform in double: collinear corners are so only up to that rounding.
	const double rounding = 0x1p-50 * std::max({greatest(a), greatest(b), greatest(c)});
	return height <= rounding ? Shape{Fate::degenerate, false} : Shape{Fate::kept, height < kSliver * longest};
}

class Cleaner
{
public:
	Cleaner(Level& level, const RunSettings& run) : m_level(level), m_threads(run.threads) {}

	Diagnosis run(std::vector<uint32_t>* before)
	{
		m_fates.resize(m_level.triangles.size());
		shapes();
		weld();
		repeats();
		edges();
		emptyMeshes();
		vertices();
		std::vector<uint32_t> kept =
			compactLevel(m_level, marked([&](std::size_t i) { return m_fates[i] == Fate::kept; }), m_threads);
		if (before != nullptr)
		{
			*before = std::move(kept);
		}
		return std::move(m_diagnosis);
	}

private:
	// 1 for each triangle that `is` is true for.
	template <class Is> std::vector<uint8_t> marked(const Is& is) const
	{
		std::vector<uint8_t> marks(m_fates.size());
		parallelForAll(marks.size(), m_threads, [&](std::size_t i) { marks[i] = is(i) ? 1 : 0; });
		return marks;
	}

	const Mesh& meshOf(std::size_t triangle) const
	{
		auto mesh = std::upper_bound(m_level.meshes.begin(), m_level.meshes.end(), triangle,
									 [](std::size_t at, const Mesh& other) { return at < other.first_triangle; });
		assert(mesh != m_level.meshes.begin());
		return *--mesh;
	}

	void found(std::string_view id, uint64_t count, std::size_t first_triangle)
	{
		if (count > 0)
		{
			const Mesh& mesh = meshOf(first_triangle);
			const std::string number = std::to_string(first_triangle - mesh.first_triangle);
			report(m_diagnosis.findings, id, {count, "mesh '" + mesh.name + "', triangle " + number});
		}
	}

	void reportFate(std::string_view id, Fate fate)
	{
		const auto first = std::find(m_fates.begin(), m_fates.end(), fate);
		found(id, static_cast<uint64_t>(std::count(first, m_fates.end(), fate)), static_cast<std::size_t>(first - m_fates.begin()));
	}

	void shapes()
	{
		std::vector<uint8_t> slivers(m_level.triangles.size());
		parallelForAll(m_level.triangles.size(), m_threads,
					   [&](std::size_t i)
					   {
						   const Shape shape = shapeOf(m_level, m_level.triangles[i]);
						   m_fates[i] = shape.fate;
						   slivers[i] = shape.sliver ? 1 : 0;
					   });
		reportFate("index-out-of-range", Fate::out_of_range);
		reportFate("non-finite-vertices", Fate::non_finite);
		reportFate("degenerate-triangles", Fate::degenerate);
		const auto first = std::find(slivers.begin(), slivers.end(), 1);
		found("sliver-triangles", static_cast<uint64_t>(std::count(first, slivers.end(), 1)),
			  static_cast<std::size_t>(first - slivers.begin()));
	}

	// Triangles of welded vertices; dropped ones are unchanged.
	void weld()
	{
		const std::vector<uint32_t> first = weldPositions(m_level.positions, m_threads);
		m_welded.resize(m_level.triangles.size());
		parallelForAll(m_welded.size(), m_threads,
					   [&](std::size_t i)
					   {
						   const glm::uvec3& triangle = m_level.triangles[i];
						   m_welded[i] = m_fates[i] == Fate::kept
											 ? glm::uvec3(first[triangle.x], first[triangle.y], first[triangle.z])
											 : glm::uvec3(0);
					   });
	}

	// The corners in order, and whether sorting took an odd number of swaps.
	static std::pair<glm::uvec3, bool> sorted(glm::uvec3 t)
	{
		bool odd = false;
		for (const auto& [i, j] : {std::pair{0, 1}, {1, 2}, {0, 1}})
		{
			if (t[i] > t[j])
			{
				std::swap(t[i], t[j]);
				odd = !odd;
			}
		}
		return {t, odd};
	}

	// True if no ray can distinguish `later` from `earlier`, which has the same corners and winding.
	bool hides(std::size_t earlier, std::size_t later) const
	{
		const uint32_t material = m_level.materials[earlier];
		if (m_level.material_list[material].alpha_mode == AlphaMode::opaque)
		{
			return true;
		}
		if (m_level.materials[later] != material)
		{
			return false;
		}
		for (int i = 0; i < 3; ++i)
		{
			for (int j = 0; j < 3; ++j)
			{
				if (m_welded[earlier][i] == m_welded[later][j] &&
					m_level.uvs[m_level.triangles[earlier][i]] != m_level.uvs[m_level.triangles[later][j]])
				{
					return false;
				}
			}
		}
		return true;
	}

	void repeats()
	{
		const auto hash = [&](std::size_t i)
		{
			// Dropped triangles are equal to none.
			const glm::uvec3 t = sorted(m_welded[i]).first;
			return m_fates[i] != Fate::kept ? uint64_t{i}
											: (uint64_t{t.x} * 0x9e3779b97f4a7c15ULL + t.y) * 0xd1342543de82ef95ULL + t.z;
		};
		const auto equal = [&](std::size_t i, std::size_t j)
		{
			return m_fates[i] == Fate::kept && m_fates[j] == Fate::kept && sorted(m_welded[i]).first == sorted(m_welded[j]).first;
		};
		const std::vector<uint32_t> first = firstEqual(m_welded.size(), m_threads, hash, equal);
		m_repeated.assign(m_welded.size(), 0);
		m_both_sides = marked([&](std::size_t i) { return m_level.material_list[m_level.materials[i]].two_sided; });
		uint64_t coincident = 0;
		std::size_t first_coincident = 0;
		std::vector<uint32_t> back(first.size(), kNone); // for the first one at a place: the first there with opposite winding
		for (std::size_t i = 0; i < first.size(); ++i)
		{
			if (first[i] == i)
			{
				continue;
			}
			m_repeated[i] = 1;
			std::size_t same = first[i];
			if (sorted(m_welded[i]).second != sorted(m_welded[same]).second)
			{
				uint32_t& other = back[same];
				other = other == kNone ? static_cast<uint32_t>(i) : other;
				m_both_sides[same] = 1;
				same = other;
			}
			if (same != i && hides(same, i))
			{
				m_fates[i] = Fate::duplicate;
				continue;
			}
			first_coincident = coincident == 0 ? i : first_coincident;
			coincident += 1;
		}
		reportFate("duplicate-faces", Fate::duplicate);
		found("coincident-faces", coincident, first_coincident);
	}

	void edges()
	{
		std::vector<uint32_t> parts(m_level.triangles.size());
		for (std::size_t i = 0; i < m_level.meshes.size(); ++i)
		{
			const Mesh& mesh = m_level.meshes[i];
			std::fill_n(parts.begin() + static_cast<std::ptrdiff_t>(mesh.first_triangle), mesh.triangle_count,
						static_cast<uint32_t>(i));
		}
		const std::vector<uint8_t> skip = marked([&](std::size_t i) { return m_fates[i] != Fate::kept || m_repeated[i] != 0; });
		const EdgeTable edges(m_welded, skip, m_level.positions.size(), m_threads);
		m_welded = {};
		const EdgeFaults faults = findEdgeFaults(edges, parts, m_threads);
		found("non-manifold-edges", faults.non_manifold.count, faults.non_manifold.first_triangle);
		found("inconsistent-winding", faults.inconsistent.count, faults.inconsistent.first_triangle);
		Tally inside_out;
		for (const SolidPart& part : InsideOutFinder(m_level, edges, parts, m_both_sides).run())
		{
			inside_out.add("mesh '" + meshOf(part.first_triangle).name + "', volume " + roundedText(part.volume_m3, 3) + " m3");
		}
		report(m_diagnosis.findings, "inside-out-parts", inside_out);
	}

	void emptyMeshes()
	{
		Tally empty;
		for (const Mesh& mesh : m_level.meshes)
		{
			const auto begin = m_fates.begin() + static_cast<std::ptrdiff_t>(mesh.first_triangle);
			const auto end = begin + static_cast<std::ptrdiff_t>(mesh.triangle_count);
			if (std::find(begin, end, Fate::kept) == end)
			{
				empty.add("mesh '" + mesh.name + "'");
			}
		}
		report(m_diagnosis.findings, "empty-meshes", empty);
	}

	// Checks the used vertices: far positions and normals.
	void vertices()
	{
		std::vector<uint8_t> used(m_level.positions.size(), 0);
		for (std::size_t i = 0; i < m_fates.size(); ++i)
		{
			const glm::uvec3& t = m_level.triangles[i];
			if (m_fates[i] == Fate::kept)
			{
				used[t.x] = used[t.y] = used[t.z] = 1;
			}
		}
		std::vector<uint8_t> large(used.size(), 0);
		std::vector<uint8_t> bad(used.size(), 0);
		parallelForAll(used.size(), m_threads,
					   [&](std::size_t i)
					   {
						   if (used[i] != 0)
						   {
							   large[i] = greatest(m_level.positions[i]) >= kLarge_m ? 1 : 0;
							   bad[i] = repairNormal(m_level.normals[i]) ? 1 : 0;
						   }
					   });
		reportVertices("large-coordinates", large);
		reportVertices("bad-normals", bad);
	}

	// Makes it unit, or zero if there is none. True if the change must be reported.
	static bool repairNormal(glm::vec3& normal)
	{
		const glm::dvec3 given(normal);
		const double squared = glm::dot(given, given);
		if (squared == 0.0)
		{
			return false;
		}
		if (!std::isfinite(squared))
		{
			normal = glm::vec3(0.0F);
			return true;
		}
		normal = glm::vec3(given / std::sqrt(squared));
		return std::fabs(squared - 1.0) > kNormalTolerance;
	}

	void reportVertices(std::string_view id, const std::vector<uint8_t>& marked)
	{
		const auto count = static_cast<uint64_t>(std::count(marked.begin(), marked.end(), 1));
		std::optional<std::size_t> first;
		for (std::size_t i = 0; count > 0 && i < m_fates.size() && !first; ++i)
		{
			const glm::uvec3& t = m_level.triangles[i];
			if (m_fates[i] == Fate::kept && (marked[t.x] != 0 || marked[t.y] != 0 || marked[t.z] != 0))
			{
				first = i;
			}
		}
		found(id, count, first.value_or(0));
	}

	Level& m_level;
	int m_threads;
	Diagnosis m_diagnosis;
	std::vector<Fate> m_fates;         // per triangle
	std::vector<glm::uvec3> m_welded;  // per triangle, with each vertex replaced by the first at its position
	std::vector<uint8_t> m_repeated;   // per triangle: an earlier one has the same corners
	std::vector<uint8_t> m_both_sides; // per triangle: two-sided, or a later one with its corners has opposite winding
};

} // namespace

Diagnosis cleanLevel(Level& level, const RunSettings& run, std::vector<uint32_t>* before)
{
	assert(level.normals.size() == level.positions.size() && level.uvs.size() == level.positions.size());
	assert(level.materials.size() == level.triangles.size());
	Diagnosis diagnosis = Cleaner(level, run).run(before);
	addFindings(diagnosis, {});
	return diagnosis;
}

} // namespace nook
