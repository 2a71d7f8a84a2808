// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/diagnosis.h"

#include "core/parallel.h"
#include "core/text.h"
#include "scene/inside_out.h"
#include "scene/load_parts.h"
#include "scene/topology.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>

namespace nook
{
namespace
{

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
	return std::fabs(p.x) <= kFarthest_m && std::fabs(p.y) <= kFarthest_m && std::fabs(p.z) <= kFarthest_m; // false for NaN
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
	Cleaner(Level& level, const RunSettings& run, std::vector<glm::vec2>* more)
		: m_level(level), m_threads(run.threads), m_more(more)
	{
	}

	Diagnosis run()
	{
		m_fates.resize(m_level.triangles.size());
		shapes();
		weld();
		repeats();
		edges();
		emptyMeshes();
		vertices();
		std::vector<uint8_t> keep(m_fates.size());
		parallelForAll(keep.size(), m_threads, [&](std::size_t i) { keep[i] = m_fates[i] == Fate::kept ? 1 : 0; });
		compactLevel(m_level, keep, m_threads, m_more);
		return std::move(m_diagnosis);
	}

private:
	// Mesh and triangle in the original level.
	std::string placeOf(std::size_t triangle) const
	{
		const Mesh& mesh = meshOf(triangle);
		return "mesh '" + mesh.name + "', triangle " + std::to_string(triangle - mesh.first_triangle);
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
			report(m_diagnosis.findings, id, {count, placeOf(first_triangle)});
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
		m_both_sides.resize(m_welded.size());
		parallelForAll(m_welded.size(), m_threads,
					   [&](std::size_t i) { m_both_sides[i] = m_level.material_list[m_level.materials[i]].two_sided ? 1 : 0; });
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
		std::vector<uint8_t> skip(m_fates.size());
		parallelForAll(skip.size(), m_threads,
					   [&](std::size_t i) { skip[i] = m_fates[i] != Fate::kept || m_repeated[i] != 0 ? 1 : 0; });
		const EdgeTable edges(m_welded, skip, m_level.positions.size(), m_threads);
		m_welded = {};
		const EdgeFaults faults = findEdgeFaults(edges, parts, m_threads);
		found("non-manifold-edges", faults.non_manifold.count, faults.non_manifold.first_triangle);
		found("inconsistent-winding", faults.inconsistent.count, faults.inconsistent.first_triangle);
		Tally inside_out;
		for (const InsideOutPart& part : insideOutParts(m_level, edges, parts, m_both_sides))
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
	std::vector<glm::vec2>* m_more;
	Diagnosis m_diagnosis;
	std::vector<Fate> m_fates;         // per triangle
	std::vector<glm::uvec3> m_welded;  // per triangle, with each vertex replaced by the first at its position
	std::vector<uint8_t> m_repeated;   // per triangle: an earlier one has the same corners
	std::vector<uint8_t> m_both_sides; // per triangle: two-sided, or a later one with its corners has opposite winding
};

} // namespace

Diagnosis cleanLevel(Level& level, const RunSettings& run, std::vector<glm::vec2>* more)
{
	assert(level.normals.size() == level.positions.size() && level.uvs.size() == level.positions.size());
	assert(level.materials.size() == level.triangles.size());
	assert(more == nullptr || more->size() == level.positions.size());
	Diagnosis diagnosis = Cleaner(level, run, more).run();
	addFindings(diagnosis, {});
	return diagnosis;
}

} // namespace nook
