// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/surface_samples.h"

#include "core/lists.h"
#include "scene/topology.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

namespace nook
{

namespace
{

constexpr double kNearlyAsLong = 0.7; // of the longest edge: below √½, so that halves of right triangles are split like them

uint64_t pairOf(uint32_t a, uint32_t b)
{
	return (uint64_t{std::min(a, b)} << 32U) | std::max(a, b);
}

// Edges of triangles; edges between the same two positions share a number.
class EdgeMarks
{
public:
	EdgeMarks(const Level& level, const Unknowns& unknowns, int threads) : m_level(level), m_edge(3 * level.triangles.size())
	{
		const std::vector<uint32_t>& place_of = unknowns.place_of_vertex;
		const std::vector<glm::uvec3> places =
			mapped(level.triangles, [&](glm::uvec3 t) { return glm::uvec3(place_of[t.x], place_of[t.y], place_of[t.z]); });
		const EdgeTable edges(places, {}, level.positions.size(), threads);
		const auto addEdge = [&](std::span<const HalfEdge> edge)
		{
			m_first.push_back(m_triangle.size());
			double length_m = 0.0;
			for (const HalfEdge& half : edge)
			{
				const glm::uvec3 corner = places[half.triangle()];
				const int higher = half.to == corner.x ? 0 : half.to == corner.y ? 1 : 2;
				const int k = (higher + (half.side % 2 != 0 ? 0 : 2)) % 3; // from corner k to the next one
				m_edge[3 * half.triangle() + static_cast<uint32_t>(k)] = static_cast<uint32_t>(m_length.size());
				m_triangle.push_back(half.triangle());
				length_m = glm::distance(level.positions[corner[k]], level.positions[corner[(k + 1) % 3]]);
			}
			m_length.push_back(length_m);
		};
		edges.each(0, edges.vertexCount(), addEdge);
		m_first.push_back(m_triangle.size());
		m_marked.assign(m_length.size(), 0);
	}

	// Marks the longest edge of a triangle and those nearly as long, and in every triangle with a marked edge the longest one
	// (M.-C. Rivara, "Algorithms for Refining Triangular Grids Suitable for Adaptive and Multigrid Techniques", 1984), so that
	// triangles do not become thin.
	void mark(std::size_t triangle)
	{
		const double longest_m = longest(triangle);
		for (std::size_t edge = 0; edge < 3; ++edge)
		{
			if (m_length[m_edge[3 * triangle + edge]] >= kNearlyAsLong * longest_m)
			{
				markEdge(m_edge[3 * triangle + edge]);
			}
		}
		while (!m_todo.empty())
		{
			const uint32_t edge = m_todo.back();
			m_todo.pop_back();
			for (std::size_t i = m_first[edge]; i < m_first[edge + 1]; ++i)
			{
				const std::size_t t = m_triangle[i];
				const double length_m = longest(t);
				for (std::size_t k = 0; k < 3; ++k) // the first of equally long edges
				{
					if (m_length[m_edge[3 * t + k]] == length_m)
					{
						markEdge(m_edge[3 * t + k]);
						break;
					}
				}
			}
		}
	}

	bool isMarked(std::size_t triangle, std::size_t edge) const
	{
		return m_marked[m_edge[3 * triangle + edge]] != 0;
	}

	// Metres.
	double longest(std::size_t triangle) const
	{
		return std::max({m_length[m_edge[3 * triangle]], m_length[m_edge[3 * triangle + 1]], m_length[m_edge[3 * triangle + 2]]});
	}

	// The vertices at both ends of marked edges, whose middles splitting adds; sorted.
	std::vector<uint64_t> markedPairs() const
	{
		std::vector<uint64_t> pairs;
		for (std::size_t slot = 0; slot < m_edge.size(); ++slot)
		{
			if (m_marked[m_edge[slot]] != 0)
			{
				const glm::uvec3 corner = m_level.triangles[slot / 3];
				pairs.push_back(pairOf(corner[static_cast<int>(slot % 3)], corner[static_cast<int>((slot + 1) % 3)]));
			}
		}
		std::sort(pairs.begin(), pairs.end());
		pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
		return pairs;
	}

	void clear()
	{
		std::fill(m_marked.begin(), m_marked.end(), uint8_t{0});
	}

private:
	void markEdge(uint32_t edge)
	{
		if (m_marked[edge] == 0)
		{
			m_marked[edge] = 1;
			m_todo.push_back(edge);
		}
	}

	const Level& m_level;
	std::vector<uint32_t> m_edge;     // three per triangle: corners 0 1, 1 2, 2 0
	std::vector<double> m_length;     // per edge, metres
	std::vector<std::size_t> m_first; // start of each edge's list in m_triangle
	std::vector<uint32_t> m_triangle; // triangles with that edge
	std::vector<uint8_t> m_marked;
	std::vector<uint32_t> m_todo;
};

// A vertex of a part: a vertex of the level, and its position in the split triangle (weights of the second and third vertex).
struct PartCorner
{
	uint32_t vertex = 0;
	glm::dvec2 at{0.0};
};
using Part = std::array<PartCorner, 3>;

class Splitter
{
public:
	Splitter(Level& level, const EdgeMarks& marks, LevelSplit& split)
		: m_level(level), m_marks(marks), m_pairs(marks.markedPairs()), m_first(level.positions.size())
	{
		for (const uint64_t pair : m_pairs)
		{
			split.middles.emplace_back(static_cast<uint32_t>(pair >> 32U), static_cast<uint32_t>(pair));
			addMiddle(split.middles.back().first, split.middles.back().second);
		}
	}

	// Parts of a triangle: the triangle itself if no edge is marked.
	std::vector<Part> partsOf(std::size_t t) const
	{
		const glm::uvec3 corner = m_level.triangles[t];
		const std::array<PartCorner, 3> corners{{{corner.x, {0.0, 0.0}}, {corner.y, {1.0, 0.0}}, {corner.z, {0.0, 1.0}}}};
		std::array<PartCorner, 3> middles{};
		std::size_t count = 0;
		std::size_t marked = 0;   // index of the last one
		std::size_t unmarked = 0; // index of the last one
		for (std::size_t edge = 0; edge < 3; ++edge)
		{
			if (m_marks.isMarked(t, edge))
			{
				middles[edge] = {middleOf(t, edge), 0.5 * (corners[edge].at + corners[(edge + 1) % 3].at)};
				count += 1;
				marked = edge;
			}
			else
			{
				unmarked = edge;
			}
		}
		switch (count)
		{
		case 0: return {corners};
		case 1:
		{
			const PartCorner& a = corners[marked];
			const PartCorner& b = corners[(marked + 1) % 3];
			const PartCorner& c = corners[(marked + 2) % 3];
			return {{{a, middles[marked], c}}, {{middles[marked], b, c}}};
		}
		case 2:
		{
			// Starting at the corner between both marked edges: b, then the unmarked edge c a.
			const PartCorner& a = corners[(unmarked + 1) % 3];
			const PartCorner& b = corners[(unmarked + 2) % 3];
			const PartCorner& c = corners[unmarked];
			const PartCorner& ab = middles[(unmarked + 1) % 3];
			const PartCorner& bc = middles[(unmarked + 2) % 3];
			if (distance(a, bc) < distance(ab, c))
			{
				return {{{ab, b, bc}}, {{a, ab, bc}}, {{a, bc, c}}};
			}
			return {{{ab, b, bc}}, {{a, ab, c}}, {{ab, bc, c}}};
		}
		default: break;
		}
		return {{{corners[0], middles[0], middles[2]}},
				{{middles[0], corners[1], middles[1]}},
				{{middles[2], middles[1], corners[2]}},
				{{middles[0], middles[1], middles[2]}}};
	}

private:
	uint32_t middleOf(std::size_t t, std::size_t edge) const
	{
		const glm::uvec3 corner = m_level.triangles[t];
		const uint64_t pair = pairOf(corner[static_cast<int>(edge)], corner[static_cast<int>((edge + 1) % 3)]);
		return static_cast<uint32_t>(m_first) +
			   static_cast<uint32_t>(std::lower_bound(m_pairs.begin(), m_pairs.end(), pair) - m_pairs.begin());
	}
	double distance(const PartCorner& a, const PartCorner& b) const
	{
		return glm::distance(m_level.positions[a.vertex], m_level.positions[b.vertex]);
	}
	void addMiddle(uint32_t a, uint32_t b)
	{
		m_level.positions.push_back(0.5 * (m_level.positions[a] + m_level.positions[b]));
		m_level.uvs.push_back(0.5F * (m_level.uvs[a] + m_level.uvs[b]));
		m_level.sources.clear();
		if (!m_level.colours.empty())
		{
			m_level.colours.push_back(0.5F * (m_level.colours[a] + m_level.colours[b]));
		}
		const glm::vec3 normal = m_level.normals[a] + m_level.normals[b];
		const float length = glm::length(normal);
		m_level.normals.push_back(length > 1e-6F ? normal / length : m_level.normals[a]);
	}

	Level& m_level;
	const EdgeMarks& m_marks;
	std::vector<uint64_t> m_pairs; // vertex pairs, whose midpoints are added in this order
	std::size_t m_first;           // first midpoint
};

// Splits every triangle with marked edges at their midpoints into two, three or four of the same orientation, material and mesh.
// Triangles that share an edge share its parts. Samples move to the triangles that contain them.
void splitMarked(Level& level, std::vector<SurfaceSample>& samples, const EdgeMarks& marks, LevelSplit& split)
{
	const Splitter splitter(level, marks, split);
	std::vector<uint32_t> origins;
	std::vector<glm::uvec3> triangles;
	std::vector<uint32_t> materials;
	std::vector<SurfaceSample> moved;
	moved.reserve(samples.size());
	std::vector<std::vector<SurfaceSample>> of_part(4);
	std::size_t next = 0;
	for (Mesh& mesh : level.meshes)
	{
		const std::size_t first = triangles.size();
		for (std::size_t t = mesh.first_triangle; t < mesh.first_triangle + mesh.triangle_count; ++t)
		{
			const std::vector<Part> parts = splitter.partsOf(t);
			for (; next < samples.size() && samples[next].triangle == t; ++next)
			{
				std::size_t best = 0;
				glm::dvec3 weights(-1e300);
				for (std::size_t i = 0; i < parts.size(); ++i)
				{
					const auto& [a, b, c] = parts[i];
					const glm::dvec3 here = weightsIn(a.at, b.at, c.at, {samples[next].b, samples[next].c});
					if (std::min({here.x, here.y, here.z}) > std::min({weights.x, weights.y, weights.z}))
					{
						best = i;
						weights = here;
					}
				}
				SurfaceSample sample = samples[next];
				sample.triangle = static_cast<uint32_t>(triangles.size() + best);
				sample.b = static_cast<float>(weights.y);
				sample.c = static_cast<float>(weights.z);
				of_part[best].push_back(sample);
			}
			for (std::size_t i = 0; i < parts.size(); ++i)
			{
				triangles.emplace_back(parts[i][0].vertex, parts[i][1].vertex, parts[i][2].vertex);
				materials.push_back(level.materials[t]);
				origins.push_back(split.origins[t]);
				append(moved, of_part[i]);
				of_part[i].clear();
			}
		}
		mesh.first_triangle = first;
		mesh.triangle_count = triangles.size() - first;
	}
	level.triangles = std::move(triangles);
	level.materials = std::move(materials);
	split.origins = std::move(origins);
	samples = std::move(moved);
}

constexpr int kMostRounds = 32; // each halves edges: a kilometre becomes a micrometre, and edges stop earlier at the minimum length

bool isPair(const SurfaceSample& a, const SurfaceSample& b)
{
	return a.triangle == b.triangle && a.b == b.b && a.c == b.c && !a.back && b.back && !a.buried && !b.buried;
}

// Root mean square difference between each triangle's samples and its interpolated values, minus the rays' noise. If both sides
// share one value, compares with their mean, since splitting cannot separate them. 0 if all samples lie inside matter.
std::vector<double> errorsOf(const Level& level, const Unknowns& unknowns, std::span<const SurfaceSample> samples,
							 std::span<const float> values)
{
	std::vector<double> squares(level.triangles.size(), 0.0);
	std::vector<uint32_t> counts(level.triangles.size(), 0);
	for (std::size_t i = 0; i < samples.size(); ++i)
	{
		const SurfaceSample& sample = samples[i];
		if (sample.buried)
		{
			continue;
		}
		const glm::uvec3 t = level.triangles[sample.triangle];
		const std::vector<uint32_t>& of = sample.back ? unknowns.of_back : unknowns.of_vertex;
		const float value = interpolated(values, {of[t.x], of[t.y], of[t.z]}, sample.b, sample.c);
		auto seen = static_cast<double>(sample.visibility);
		double unsure = static_cast<double>(sample.standard_error) * static_cast<double>(sample.standard_error);
		if (!unknowns.has_sides && i + 1 < samples.size() && isPair(sample, samples[i + 1]))
		{
			i += 1;
			const auto other = static_cast<double>(samples[i].standard_error);
			seen = 0.5 * (seen + static_cast<double>(samples[i].visibility));
			unsure = 0.25 * (unsure + other * other);
		}
		const double off = static_cast<double>(value) - seen;
		squares[sample.triangle] += off * off - unsure;
		counts[sample.triangle] += 1;
	}
	for (std::size_t t = 0; t < squares.size(); ++t)
	{
		squares[t] = counts[t] > 0 ? std::sqrt(std::max(0.0, squares[t] / counts[t])) : 0.0;
	}
	return squares;
}

// Triangles above the error, those whose splitting saves most first.
struct Worst
{
	std::vector<uint32_t> large; // can be split
	std::size_t small = 0;       // edges already too short
	double area_m2 = 0.0;        // of both
};

Worst worstOf(const EdgeMarks& marks, std::span<const double> areas, std::span<const double> errors, double max_error,
			  double least_edge_m)
{
	Worst worst;
	for (std::size_t t = 0; t < errors.size(); ++t)
	{
		if (errors[t] > max_error)
		{
			worst.area_m2 += areas[t];
			if (marks.longest(t) > 2.0 * least_edge_m)
			{
				worst.large.push_back(static_cast<uint32_t>(t));
			}
			else
			{
				worst.small += 1;
			}
		}
	}
	const auto saved = [&](uint32_t t)
	{
		return areas[t] * errors[t] * errors[t];
	};
	std::sort(worst.large.begin(), worst.large.end(),
			  [&](uint32_t a, uint32_t b) { return saved(a) != saved(b) ? saved(a) > saved(b) : a < b; });
	return worst;
}

// Marks as many triangles as fit, worst first; returns how many.
std::size_t markWorst(EdgeMarks& marks, std::span<const uint32_t> worst, std::size_t room)
{
	std::size_t count = worst.size();
	while (count > 0)
	{
		marks.clear();
		for (const uint32_t t : worst.first(count))
		{
			marks.mark(t);
		}
		const std::size_t made = marks.markedPairs().size();
		if (made <= room)
		{
			break;
		}
		count = std::min(count - 1, static_cast<std::size_t>(0.95 * static_cast<double>(count) * static_cast<double>(room) /
															 static_cast<double>(made)));
	}
	return count;
}

// Samples per triangle: `least`, or one per cell of its area, so that small objects on large triangles are seen.
struct Density
{
	std::size_t least = 2;
	double cell_m2 = 0.0;
};

// Adds and traces samples for triangles that have too few, in triangle order; returns how many.
std::size_t topUp(const Tracer& tracer, const Level& level, std::vector<SurfaceSample>& samples, const Density& density, int rays,
				  uint32_t seed, const BakeSettings& settings, const RunSettings& run)
{
	std::vector<std::size_t> missing =
		mapped(areasOf(level),
			   [&density](double area_m2) { return std::max(density.least, static_cast<std::size_t>(area_m2 / density.cell_m2)); });
	for (const SurfaceSample& sample : samples)
	{
		missing[sample.triangle] -= std::min<std::size_t>(missing[sample.triangle], 1);
	}
	std::vector<SurfaceSample> added = SamplePlaces(level, missing, seed).all();
	traceSamples(tracer, level, added, settings, rays, seed, run, "rays");
	const std::size_t before = samples.size();
	append(samples, added);
	std::inplace_merge(samples.begin(), samples.begin() + static_cast<std::ptrdiff_t>(before), samples.end(),
					   [](const SurfaceSample& a, const SurfaceSample& b) { return a.triangle < b.triangle; });
	return added.size();
}

} // namespace

VertexBake refineBake(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run)
{
	assert(settings.max_error > 0.0 && settings.fit == BakeFit::surface);
	VertexBake bake;
	Level& level = bake.refined.emplace(surfaceOf(tracer, settings));
	bake.split.origins = countingFrom(0U, level.triangles.size());
	const int rays = std::min(settings.rays, kRaysOfPoint);
	// Contact shadows begin with zero width, so subdivision would never end without a minimum edge length.
	const double diagonal_m = glm::distance(tracer.bounds().least, tracer.bounds().most);
	const double least_edge_m = std::isfinite(settings.radius_m) ? settings.radius_m / 32.0 : diagonal_m / 4096.0;
	constexpr double kMostCells = 1e6; // bounds the cells of a level that is large relative to the radius
	const double cell_m2 = std::max(64.0 * least_edge_m * least_edge_m, sumOver(areasOf(level)) / kMostCells);
	// There are about two triangles per vertex; two samples are needed to tell a difference from noise.
	const Density density{static_cast<std::size_t>(std::max(2, settings.rays / rays / 2)), cell_m2};
	std::vector<SurfaceSample> samples;
	bake.points = topUp(tracer, level, samples, density, rays, settings.seed, settings, run);
	bool is_last = false;
	for (int round = 1;; ++round)
	{
		const ProgressCounter stage(run.progress, "fit");
		const std::vector<double> areas = areasOf(level);
		const Unknowns unknowns = unknownsOf(level, settings.sides);
		const FittedValues fitted = fitValues(level, areas, unknowns, samples, settings);
		take(bake, level, unknowns, fitted);
		EdgeMarks marks(level, unknowns, run.threads);
		const Worst worst =
			worstOf(marks, areas, errorsOf(level, unknowns, samples, fitted.values), settings.max_error, least_edge_m);
		bake.above = worst.large.size() + worst.small;
		bake.area_above_m2 = worst.area_m2;
		if (is_last || worst.large.empty() ||
			static_cast<double>(worst.large.size()) < settings.few * static_cast<double>(areas.size()))
		{
			break;
		}
		const std::size_t room = settings.max_vertices - std::min(settings.max_vertices, level.positions.size());
		const std::size_t marked = markWorst(marks, worst.large, room);
		bake.capped = marked < worst.large.size();
		is_last = bake.capped || round == kMostRounds;
		if (marked == 0)
		{
			break;
		}
		splitMarked(level, samples, marks, bake.split);
		const auto seed = settings.seed + static_cast<uint32_t>(round) * 0x85ebca6bU; // a different sequence per round
		bake.points += topUp(tracer, level, samples, density, rays, seed, settings, run);
	}
	bake.rays = bake.points * static_cast<std::size_t>(rays);
	countUnseen(samples, bake);
	return bake;
}

} // namespace nook
