// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/surface.h"

#include "core/parallel.h"
#include "scene/topology.h"
#include "volume/evaluate.h"
#include "volume/groups.h"
#include "volume/holes.h"
#include "volume/texture_map.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <functional>

namespace nook::detail
{
namespace
{

constexpr std::size_t kSurfaceBlock = std::size_t{1} << 14U;
constexpr std::size_t kMostAtEdge = 64; // triangles; more are left as they are: pairs are compared
// Share of its area that the holes of a piece of surface may have (slits have none, holes.h): a scanned figure has less, a vase's
// mouth more.
constexpr double kHoles = 0.01;
constexpr double kUvTolerance = 1e-4; // of maps that count as one: a tenth of a texel of a texture of 1024

double greatest(glm::dvec3 v)
{
	return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

void inBlocks(std::size_t count, int threads, const std::function<void(std::size_t, std::size_t)>& body)
{
	parallelFor((count + kSurfaceBlock - 1) / kSurfaceBlock, threads,
				[&](std::size_t block) { body(block * kSurfaceBlock, std::min(count, (block + 1) * kSurfaceBlock)); });
}

// Half-edges by their lower vertex.
struct EdgeTable
{
	std::vector<uint32_t> starts; // one a vertex, and the end
	std::vector<uint32_t> items;  // half-edges, ascending for each vertex

	EdgeTable(std::span<const glm::uvec3> triangles, std::size_t vertex_count)
		: starts(vertex_count + 1, 0), items(3 * triangles.size())
	{
		const auto lower = [](const glm::uvec3& t, int corner)
		{
			return std::min(t[corner], t[(corner + 1) % 3]);
		};
		for (const glm::uvec3& t : triangles)
		{
			for (int corner = 0; corner < 3; ++corner)
			{
				starts[lower(t, corner) + 1] += 1;
			}
		}
		std::partial_sum(starts.begin(), starts.end(), starts.begin());
		std::vector<uint32_t> next(starts.begin(), starts.end() - 1);
		for (std::size_t i = 0; i < triangles.size(); ++i)
		{
			for (int corner = 0; corner < 3; ++corner)
			{
				items[next[lower(triangles[i], corner)]++] = static_cast<uint32_t>(3 * i) + static_cast<uint32_t>(corner);
			}
		}
	}
};

// One triangle at an edge.
struct AtEdge
{
	uint32_t to = 0;    // the edge's higher vertex
	uint32_t kind = 0;  // of the triangle
	uint32_t third = 0; // the corner across
	uint32_t half_edge = 0;
	bool forward = false; // from the lower vertex to the higher

	bool operator<(const AtEdge& other) const
	{
		return to != other.to ? to < other.to : (kind != other.kind ? kind < other.kind : half_edge < other.half_edge);
	}
};

class Finder
{
public:
	Finder(const Soup& soup, const OccluderSettings& settings, Surface& surface)
		: m_soup(soup), m_settings(settings), m_surface(surface), m_links(3 * surface.triangles.size(), kNone),
		  m_open(3 * surface.triangles.size(), 0), m_dropped(surface.triangles.size(), 0)
	{
	}

	void findAtVertex(const EdgeTable& table, uint32_t vertex)
	{
		thread_local std::vector<AtEdge> edges;
		edges.clear();
		for (uint32_t i = table.starts[vertex]; i < table.starts[vertex + 1]; ++i)
		{
			const uint32_t half_edge = table.items[i];
			const glm::uvec3& t = m_surface.triangles[half_edge / 3];
			const int corner = static_cast<int>(half_edge % 3);
			const uint32_t a = t[corner];
			const uint32_t b = t[(corner + 1) % 3];
			if (a != b)
			{
				edges.push_back({std::max(a, b), kindOf(m_soup, half_edge / 3), t[(corner + 2) % 3], half_edge, a < b});
			}
		}
		std::sort(edges.begin(), edges.end());
		for (std::size_t begin = 0; begin < edges.size();)
		{
			std::size_t end = begin + 1;
			while (end < edges.size() && edges[end].to == edges[begin].to)
			{
				++end;
			}
			findAtEdge(vertex, std::span(edges).subspan(begin, end - begin));
			begin = end;
		}
	}

	uint32_t link(std::size_t half_edge) const
	{
		return m_links[half_edge];
	}
	bool open(std::size_t half_edge) const
	{
		return m_open[half_edge] != 0;
	}
	uint8_t dropped(std::size_t triangle) const // 1: a duplicate, 2: a back
	{
		return m_dropped[triangle];
	}

private:
	void findAtEdge(uint32_t vertex, std::span<AtEdge> run)
	{
		dropCopies(vertex, run);
		for (std::size_t begin = 0; begin < run.size();)
		{
			std::size_t end = begin + 1;
			while (end < run.size() && run[end].kind == run[begin].kind)
			{
				++end;
			}
			joinKind(run.subspan(begin, end - begin));
			begin = end;
		}
	}

	// Among triangles with the same three corners the first stays: opaque before masked, then the lowest. The verdict is the same
	// at all three of their edges; it is written at one.
	void dropCopies(uint32_t vertex, std::span<AtEdge> run)
	{
		std::vector<AtEdge*> by_third;
		by_third.reserve(run.size());
		for (AtEdge& edge : run)
		{
			by_third.push_back(&edge);
		}
		std::sort(by_third.begin(), by_third.end(),
				  [](const AtEdge* a, const AtEdge* b) { return a->third != b->third ? a->third < b->third : a < b; });
		const AtEdge* first = nullptr;
		for (const AtEdge* const edge : by_third)
		{
			if (first == nullptr || edge->third != first->third)
			{
				first = edge;
				continue;
			}
			const bool back = edge->forward != first->forward;
			if (vertex < edge->third && edge->to < edge->third)
			{
				m_dropped[edge->half_edge / 3] = back ? 2 : 1;
				m_surface.two_sided[first->half_edge / 3] |= back ? uint8_t{1} : uint8_t{0};
			}
			m_open[edge->half_edge] = back ? kBack : kCopy;
		}
	}

	bool isCopy(uint32_t half_edge) const
	{
		return m_open[half_edge] >= kBack;
	}

	// Triangles of one kind at an edge are linked; those that run along it in opposite ways in one plane, too, if there are no two
	// choices.
	void joinKind(std::span<const AtEdge> run)
	{
		int balance = 0;
		for (const AtEdge& edge : run)
		{
			balance += m_open[edge.half_edge] == kCopy ? 0 : (edge.forward ? 1 : -1);
		}
		for (std::size_t i = 0; i < run.size(); ++i)
		{
			m_links[run[i].half_edge] = i + 1 < run.size() ? run[i + 1].half_edge : kNone;
			if (!isCopy(run[i].half_edge))
			{
				m_open[run[i].half_edge] = balance != 0 ? kOpen : 0;
				m_surface.opposite[run[i].half_edge] = m_settings.merge && run.size() <= kMostAtEdge ? onlyMatch(run, i) : kNone;
			}
		}
		for (const AtEdge& edge : run) // both must choose each other
		{
			uint32_t& chosen = m_surface.opposite[edge.half_edge];
			if (chosen != kNone && m_surface.opposite[chosen] != edge.half_edge)
			{
				chosen = kNone;
			}
		}
	}

	uint32_t onlyMatch(std::span<const AtEdge> run, std::size_t i) const
	{
		uint32_t found = kNone;
		for (const AtEdge& edge : run)
		{
			if (edge.forward != run[i].forward && !isCopy(edge.half_edge) && inOnePlane(run[i], edge))
			{
				if (found != kNone)
				{
					return kNone;
				}
				found = edge.half_edge;
			}
		}
		return found;
	}

	// The larger triangle's plane is known better: the smaller one's third corner must lie in it.
	bool inOnePlane(const AtEdge& a, const AtEdge& b) const
	{
		const std::span<const glm::dvec3> positions = m_soup.level->positions;
		const glm::dvec3 area_a = areaOf(positions, m_surface.triangles[a.half_edge / 3]);
		const glm::dvec3 area_b = areaOf(positions, m_surface.triangles[b.half_edge / 3]);
		const double square_a = glm::dot(area_a, area_a);
		const double square_b = glm::dot(area_b, area_b);
		const glm::dvec3 area = square_a >= square_b ? area_a : area_b;
		const glm::dvec3 third = positions[square_a >= square_b ? b.third : a.third];
		const glm::dvec3 corner = positions[a.to];
		const double height = glm::dot(third - corner, area);
		const double flat = flatness(std::max(greatest(third), greatest(corner)), false, m_settings);
		return glm::dot(area_a, area_b) > 0.0 && height * height <= flat * flat * glm::dot(area, area) &&
			   (a.kind == 0 || haveOneMap(a.half_edge / 3, b.half_edge / 3));
	}

	bool haveOneMap(std::size_t a, std::size_t b) const
	{
		const TextureMap map = textureMapOf(m_soup, a);
		for (int corner = 0; corner < 3; ++corner)
		{
			const uint32_t vertex = m_soup.triangles[b][corner];
			const glm::dvec2 difference = map.at(m_soup.level->positions[vertex]) - glm::dvec2(m_soup.level->uvs[vertex]);
			if (!(std::max(std::fabs(difference.x), std::fabs(difference.y)) <= kUvTolerance))
			{
				return false;
			}
		}
		return true;
	}

	static constexpr uint8_t kOpen = 1; // values of m_open
	static constexpr uint8_t kBack = 2;
	static constexpr uint8_t kCopy = 3;

	const Soup& m_soup;
	const OccluderSettings& m_settings;
	Surface& m_surface;
	std::vector<uint32_t> m_links;
	std::vector<uint8_t> m_open;
	std::vector<uint8_t> m_dropped;
};

struct PieceSums
{
	Groups groups;               // triangles joined by edges
	std::vector<double> volumes; // six times, by the first triangle; > 0: fronts are outside
	std::vector<double> areas;   // twice
	std::vector<double> holes;   // the largest area, twice, that the open edges can bound; 0: closed, but for slits

	explicit PieceSums(std::size_t count) : groups(count), volumes(count, 0.0), areas(count, 0.0), holes(count, 0.0) {}
};

void joinPieces(const Soup& soup, const Finder& finder, const Surface& surface, PieceSums& pieces)
{
	const std::span<const glm::dvec3> positions = soup.level->positions;
	for (std::size_t h = 0; h < 3 * surface.triangles.size(); ++h)
	{
		if (finder.link(h) != kNone)
		{
			pieces.groups.join(static_cast<uint32_t>(h / 3), finder.link(h) / 3);
		}
	}
	for (std::size_t i = 0; i < surface.triangles.size(); ++i)
	{
		const uint32_t piece = pieces.groups.of(static_cast<uint32_t>(i));
		const glm::dvec3 origin = positions[surface.triangles[piece].x];
		const glm::dvec3 area = areaOf(positions, surface.triangles[i]);
		pieces.volumes[piece] += glm::dot(positions[surface.triangles[i].x] - origin, area);
		pieces.areas[piece] += glm::length(area);
	}
}

void measureHoles(const Soup& soup, const Finder& finder, const Surface& surface, PieceSums& pieces)
{
	std::vector<OpenEdge> edges;
	for (std::size_t h = 0; h < 3 * surface.triangles.size(); ++h)
	{
		if (finder.open(h) && finder.dropped(h / 3) == 0)
		{
			edges.push_back({pieces.groups.of(static_cast<uint32_t>(h / 3)), surface.triangles[h / 3][static_cast<int>(h % 3)],
							 surface.triangles[h / 3][static_cast<int>((h + 1) % 3)]});
		}
	}
	std::stable_sort(edges.begin(), edges.end(), [](const OpenEdge& a, const OpenEdge& b) { return a.piece < b.piece; });
	addHoles(edges, soup.level->positions, pieces.holes);
}

// Which triangles were of a closed surface when their cell was cut out of it; empty where none was.
std::vector<uint8_t> closedBefore(const Soup& soup)
{
	const std::span<const Mesh> meshes = soup.level->meshes;
	if (std::none_of(meshes.begin(), meshes.end(), [](const Mesh& mesh) { return mesh.closed; }))
	{
		return {};
	}
	std::vector<uint8_t> of_level(soup.level->triangles.size(), 0);
	for (const Mesh& mesh : meshes)
	{
		std::fill_n(of_level.begin() + static_cast<std::ptrdiff_t>(mesh.first_triangle), mesh.triangle_count,
					mesh.closed ? uint8_t{1} : uint8_t{0});
	}
	std::vector<uint8_t> closed(soup.triangles.size());
	for (std::size_t i = 0; i < closed.size(); ++i)
	{
		closed[i] = of_level[soup.sources.empty() ? i : soup.sources[i]];
	}
	return closed;
}

// A piece of surface is oriented if it is opaque, closed but for holes that hardly anything shows through, and its fronts are
// outside. Where they are inside it is a room, or turned inside out, or the wall of a hollow: its backs may be seen.
void findSides(const Soup& soup, const OccluderSettings& settings, const Finder& finder, Surface& surface, OccluderCounts& counts)
{
	const std::size_t count = surface.triangles.size();
	PieceSums pieces(count);
	joinPieces(soup, finder, surface, pieces);
	measureHoles(soup, finder, surface, pieces);
	const std::vector<uint8_t> closed_before = closedBefore(soup);
	for (std::size_t i = 0; i < count; ++i)
	{
		const uint32_t piece = pieces.groups.of(static_cast<uint32_t>(i));
		const bool closed = pieces.holes[piece] == 0.0;
		const bool sealed = pieces.holes[piece] <= kHoles * pieces.areas[piece];
		if (piece == i)
		{
			counts.components += 1;
			counts.closed += closed ? 1U : 0U;
			counts.sealed += sealed && !closed ? 1U : 0U;
		}
		const bool oriented = settings.sides == Sides::oriented ||
							  (settings.sides == Sides::automatic && kindOf(soup, i) == 0 &&
							   ((sealed && pieces.volumes[piece] > 0.0) || (!closed_before.empty() && closed_before[i] != 0)));
		surface.two_sided[i] |= oriented ? uint8_t{0} : uint8_t{1};
	}
}

// Neighbours of which one is dropped, or has other sides, are none.
void forgetStrangers(Surface& surface, int threads)
{
	inBlocks(surface.triangles.size(), threads,
			 [&](std::size_t begin, std::size_t end)
			 {
				 for (std::size_t h = 3 * begin; h < 3 * end; ++h)
				 {
					 const uint32_t across = surface.opposite[h];
					 if (across != kNone && (surface.kept[h / 3] == 0 || surface.kept[across / 3] == 0 ||
											 surface.two_sided[h / 3] != surface.two_sided[across / 3]))
					 {
						 surface.opposite[h] = kNone;
					 }
				 }
			 });
}

} // namespace

uint32_t kindOf(const Soup& soup, std::size_t triangle)
{
	const uint32_t material = soup.materials[triangle];
	return soup.level->material_list[material].alpha_mode == AlphaMode::opaque ? 0 : material + 1;
}

double flatness(double coordinate_m, bool two_sided, const OccluderSettings& settings)
{
	const double four_ulp = 4.0 * 0x1p-23 * coordinate_m; // at most: an ulp is between 2^-24 and 2^-23 of the number
	const double flat_m = std::max(settings.flat * settings.distance_m, std::min(four_ulp, 1e-4 * settings.distance_m));
	// Heights over the plane of a region's corners are at most twice as large as over the one that they were measured from.
	return two_sided ? std::min(flat_m, 0.5 * kVolumeBias * settings.distance_m) : flat_m;
}

glm::dvec3 areaOf(std::span<const glm::dvec3> positions, const glm::uvec3& triangle)
{
	return glm::cross(positions[triangle.y] - positions[triangle.x], positions[triangle.z] - positions[triangle.x]);
}

Surface surfaceOf(const Soup& soup, const OccluderSettings& settings, const RunSettings& run, OccluderCounts& counts)
{
	const std::size_t count = soup.triangles.size();
	const std::span<const glm::dvec3> positions = soup.level->positions;
	const std::vector<uint32_t> first = weldPositions(positions, run.threads);
	Surface surface;
	surface.triangles.resize(count);
	surface.kept.assign(count, 1);
	surface.two_sided.assign(count, 0);
	surface.opposite.assign(3 * count, kNone);
	inBlocks(count, run.threads,
			 [&](std::size_t begin, std::size_t end)
			 {
				 for (std::size_t i = begin; i < end; ++i)
				 {
					 const glm::uvec3& t = soup.triangles[i];
					 surface.triangles[i] = {first[t.x], first[t.y], first[t.z]};
					 const glm::dvec3 area = areaOf(positions, surface.triangles[i]);
					 surface.kept[i] = glm::dot(area, area) > 0.0 ? 1 : 0;
				 }
			 });
	Finder finder(soup, settings, surface);
	{
		const EdgeTable table(surface.triangles, positions.size());
		inBlocks(positions.size(), run.threads,
				 [&](std::size_t begin, std::size_t end)
				 {
					 for (std::size_t vertex = begin; vertex < end; ++vertex)
					 {
						 finder.findAtVertex(table, static_cast<uint32_t>(vertex));
					 }
				 });
	}
	findSides(soup, settings, finder, surface, counts);
	for (std::size_t i = 0; i < count; ++i)
	{
		counts.thin += surface.kept[i] == 0 ? 1U : 0U;
		counts.duplicates += finder.dropped(i) == 1 ? 1U : 0U;
		counts.reversed += finder.dropped(i) == 2 ? 1U : 0U;
		surface.kept[i] = finder.dropped(i) == 0 ? surface.kept[i] : 0;
	}
	forgetStrangers(surface, run.threads);
	return surface;
}

} // namespace nook::detail
