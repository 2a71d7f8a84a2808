// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/surface.h"

#include "core/lists.h"
#include "core/math.h"
#include "scene/topology.h"
#include "volume/evaluate.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace nook::detail
{

glm::dvec2 TextureMap::at(glm::dvec3 position) const
{
	const glm::dvec3 offset = position - origin;
	return at_origin + glm::dvec2(glm::dot(u, offset), glm::dot(v, offset));
}

TextureMap textureMapOf(const Soup& soup, std::size_t triangle)
{
	const glm::uvec3& t = soup.triangles[triangle];
	const Level& level = *soup.level;
	const glm::dvec3 side = level.positions[t.y] - level.positions[t.x];
	const glm::dvec3 other = level.positions[t.z] - level.positions[t.x];
	const glm::dvec3 area = glm::cross(side, other);
	const glm::dvec2 start(level.uvs[t.x]);
	const glm::dvec2 along_side = glm::dvec2(level.uvs[t.y]) - start;
	const glm::dvec2 along_other = glm::dvec2(level.uvs[t.z]) - start;
	// Gradients of the barycentric coordinates.
	const double square = glm::dot(area, area);
	const glm::dvec3 of_side = glm::cross(other, area) / square;
	const glm::dvec3 of_other = glm::cross(area, side) / square;
	return {level.positions[t.x], start, along_side.x * of_side + along_other.x * of_other,
			along_side.y * of_side + along_other.y * of_other};
}

namespace
{

// Twice the greatest area that a closed line can bound.
double boundedBy(std::span<const uint32_t> loop, std::span<const glm::dvec3> positions)
{
	const glm::dvec3 apex = positions[loop[0]];
	double length = 0.0;
	double cone = 0.0;
	for (std::size_t i = 0; i < loop.size(); ++i)
	{
		const glm::dvec3 a = positions[loop[i]];
		const glm::dvec3 b = positions[loop[(i + 1) % loop.size()]];
		length += glm::length(b - a);
		cone += glm::length(glm::cross(a - apex, b - apex));
	}
	return std::min(cone, length * length / (2.0 * kPi));
}

// The edges of one piece, indexed by their first vertex.
class Walk
{
public:
	Walk(std::span<const OpenEdge> edges, std::span<const glm::dvec3> positions)
		: m_edges(edges.begin(), edges.end()), m_positions(positions)
	{
		std::stable_sort(m_edges.begin(), m_edges.end(), [](const OpenEdge& a, const OpenEdge& b) { return a.from < b.from; });
		for (std::size_t i = 0; i < m_edges.size(); ++i)
		{
			if (i == 0 || m_edges[i].from != m_edges[i - 1].from)
			{
				m_vertices.push_back(m_edges[i].from);
				m_next.push_back(i);
			}
		}
		m_ends.assign(m_next.begin() + (m_next.empty() ? 0 : 1), m_next.end());
		m_ends.push_back(m_edges.size());
		m_place.assign(m_vertices.size(), 0);
	}

	// Walks along remaining edges; when the walk returns to one of its vertices, that loop is complete.
	double area()
	{
		double area = 0.0;
		for (std::size_t first = 0; first < m_vertices.size(); ++first)
		{
			while (m_next[first] < m_ends[first])
			{
				area += areaFrom(first);
			}
		}
		return area;
	}

private:
	double areaFrom(std::size_t at)
	{
		double area = 0.0;
		m_way.assign(1, m_vertices[at]);
		m_place[at] = 1;
		while (at < m_vertices.size() && m_next[at] < m_ends[at])
		{
			const uint32_t to = m_edges[m_next[at]++].to;
			at = indexOf(to);
			if (at < m_vertices.size() && m_place[at] != 0)
			{
				const std::size_t begin = m_place[at] - 1;
				area += boundedBy(std::span(m_way).subspan(begin), m_positions);
				forget(begin + 1);
				continue;
			}
			m_way.push_back(to);
			if (at < m_vertices.size())
			{
				m_place[at] = m_way.size();
			}
		}
		area += boundedBy(m_way, m_positions); // an open walk counts as if it closed; a single vertex counts nothing
		forget(0);
		return area;
	}

	void forget(std::size_t begin)
	{
		for (std::size_t i = begin; i < m_way.size(); ++i)
		{
			const std::size_t index = indexOf(m_way[i]);
			if (index < m_vertices.size())
			{
				m_place[index] = 0;
			}
		}
		m_way.resize(begin);
	}

	// The number of vertices if no edge begins there.
	std::size_t indexOf(uint32_t vertex) const
	{
		const auto found = std::lower_bound(m_vertices.begin(), m_vertices.end(), vertex);
		return found != m_vertices.end() && *found == vertex ? static_cast<std::size_t>(found - m_vertices.begin())
															 : m_vertices.size();
	}

	std::vector<OpenEdge> m_edges;
	std::span<const glm::dvec3> m_positions;
	std::vector<uint32_t> m_vertices; // vertices at which edges begin, ascending
	std::vector<std::size_t> m_next;  // next unused edge of each
	std::vector<std::size_t> m_ends;
	std::vector<std::size_t> m_place; // position of each in the walk, from 1; 0: not in it
	std::vector<uint32_t> m_way;
};

// Martin Roberts, The Unreasonable Effectiveness of Quasirandom Sequences, 2018: multiples of 1/ρ and 1/ρ², ρ³ = ρ + 1.
constexpr double kStepX = 0.75487766624669276;
constexpr double kStepY = 0.56984029099805327;

double doubleArea(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Same result as alphaAt(), but faster inside the texture.
double quickAlpha(const Mask& mask, glm::dvec2 uv)
{
	const double x = uv.x * mask.width_px - 0.5;
	const double y = uv.y * mask.height_px - 0.5;
	if (mask.nearest || !(x >= 0.0 && y >= 0.0 && x < mask.width_px - 1.0 && y < mask.height_px - 1.0))
	{
		return alphaAt(mask, uv);
	}
	const auto left = static_cast<std::size_t>(x);
	const auto top = static_cast<std::size_t>(y);
	const double right_share = x - static_cast<double>(left);
	const double bottom_share = y - static_cast<double>(top);
	const uint8_t* const texel = mask.alpha.data() + top * static_cast<std::size_t>(mask.width_px) + left;
	const double upper = texel[0] + right_share * (texel[1] - texel[0]);
	const double lower = texel[mask.width_px] + right_share * (texel[mask.width_px + 1] - texel[mask.width_px]);
	return (upper + bottom_share * (lower - upper)) / 255.0;
}

// Number of a triangle's samples that are solid.
std::size_t solidIn(const Mask& mask, const Material& material, glm::dvec2 a, glm::dvec2 b, glm::dvec2 c, std::size_t count)
{
	std::size_t solid = 0;
	for (std::size_t i = 0; i < count; ++i)
	{
		double x = 0.5 + static_cast<double>(i) * kStepX;
		double y = 0.5 + static_cast<double>(i) * kStepY;
		x -= std::floor(x);
		y -= std::floor(y);
		if (x + y > 1.0)
		{
			x = 1.0 - x;
			y = 1.0 - y;
		}
		solid += material.alpha * quickAlpha(mask, a + x * (b - a) + y * (c - a)) >= material.cutoff ? 1U : 0U;
	}
	return solid;
}

constexpr std::size_t kSurfaceBlock = std::size_t{1} << 14U;
constexpr std::size_t kMostAtEdge = 64; // triangles; edges with more are skipped because pairs are compared
constexpr double kUvTolerance = 1e-4;   // tolerance for equal texture mappings: a tenth of a texel of a 1024 texture

double greatest(glm::dvec3 v)
{
	return std::max({std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
}

// Half-edges by their lower vertex.
struct EdgeTable
{
	std::vector<uint32_t> starts; // per vertex, and the end
	std::vector<uint32_t> items;  // half-edges, ascending per vertex

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
	uint32_t third = 0; // the opposite corner
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
		forRuns(
			edges, [](const AtEdge& a, const AtEdge& b) { return a.to == b.to; },
			[&](std::size_t begin, std::size_t end) { findAtEdge(vertex, std::span(edges).subspan(begin, end - begin)); });
	}

	uint32_t link(std::size_t half_edge) const
	{
		return m_links[half_edge];
	}
	bool open(std::size_t half_edge) const
	{
		return m_open[half_edge] != 0;
	}
	uint8_t dropped(std::size_t triangle) const // 1: duplicate, 2: back of another
	{
		return m_dropped[triangle];
	}

private:
	void findAtEdge(uint32_t vertex, std::span<AtEdge> run)
	{
		dropCopies(vertex, run);
		forRuns(
			run, [](const AtEdge& a, const AtEdge& b) { return a.kind == b.kind; },
			[&](std::size_t begin, std::size_t end) { joinKind(run.subspan(begin, end - begin)); });
	}

	// Among triangles with the same three corners the first is kept: opaque before masked, then the lowest number. All three edges
	// give the same verdict; it is recorded at one.
	void dropCopies(uint32_t vertex, std::span<AtEdge> run)
	{
		std::vector<const AtEdge*> by_third = mapped(run, [](const AtEdge& edge) { return &edge; });
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

	// Links the triangles of one kind at an edge; also coplanar ones that traverse it in opposite directions, if the choice is
	// unique.
	void joinKind(std::span<const AtEdge> run)
	{
		const int balance =
			sumOver(run, [&](const AtEdge& edge) { return m_open[edge.half_edge] == kCopy ? 0 : (edge.forward ? 1 : -1); });
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

	// The larger triangle's plane is more accurate: the smaller one's third corner must lie in it.
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
	Groups groups;               // triangles connected by edges
	std::vector<double> volumes; // six times the volume, by the component's first triangle; > 0: fronts are outside
	std::vector<double> areas;   // twice the area
	std::vector<double> holes;   // twice the greatest area that open edges can bound; 0: closed, except for slits

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
		const uint32_t piece = pieces.groups.rootOf(static_cast<uint32_t>(i));
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
			edges.push_back({pieces.groups.rootOf(static_cast<uint32_t>(h / 3)), surface.triangles[h / 3][static_cast<int>(h % 3)],
							 surface.triangles[h / 3][static_cast<int>((h + 1) % 3)]});
		}
	}
	std::stable_sort(edges.begin(), edges.end(), [](const OpenEdge& a, const OpenEdge& b) { return a.piece < b.piece; });
	addHoles(edges, soup.level->positions, pieces.holes);
}

// Triangles known to be oriented, whatever their piece looks like: those of settings.one_sided, and those that belonged to a closed
// surface before their cell was cut out.
std::vector<uint8_t> knownOriented(const Soup& soup, const OccluderSettings& settings)
{
	std::vector<uint8_t> of_level = settings.detail > 0.0 ? settings.one_sided : std::vector<uint8_t>{};
	of_level.resize(soup.level->triangles.size(), 0);
	for (const Mesh& mesh : soup.level->meshes)
	{
		if (mesh.closed)
		{
			std::fill_n(of_level.begin() + static_cast<std::ptrdiff_t>(mesh.first_triangle), mesh.triangle_count, uint8_t{1});
		}
	}
	return soup.sources.empty() ? of_level : mapped(soup.sources, [&](uint32_t source) { return of_level[source]; });
}

// A piece of surface is oriented if it is opaque, closed up to settings.holes, and its fronts are outside. If they are inside, it
// is a room, is inside out, or is the wall of a hollow: its backs may be seen, as through any hole.
void findSides(const Soup& soup, const OccluderSettings& settings, const Finder& finder, Surface& surface, OccluderCounts& counts)
{
	const std::size_t count = surface.triangles.size();
	PieceSums pieces(count);
	joinPieces(soup, finder, surface, pieces);
	measureHoles(soup, finder, surface, pieces);
	const std::vector<uint8_t> known = knownOriented(soup, settings);
	const auto isSeenInside = [&](std::size_t i)
	{
		return !settings.seen_backs.empty() && settings.seen_backs[soup.sources.empty() ? i : soup.sources[i]] != 0;
	};
	for (std::size_t i = 0; i < count; ++i)
	{
		const uint32_t piece = pieces.groups.rootOf(static_cast<uint32_t>(i));
		const bool closed = pieces.holes[piece] <= settings.holes * pieces.areas[piece];
		if (piece == i)
		{
			counts.components += 1;
			counts.closed += closed ? 1U : 0U;
		}
		const bool oriented =
			settings.sides == Sides::oriented || (settings.sides == Sides::automatic && kindOf(soup, i) == 0 &&
												  ((closed && pieces.volumes[piece] > 0.0 && !isSeenInside(i)) || known[i] != 0));
		surface.two_sided[i] |= oriented ? uint8_t{0} : uint8_t{1};
	}
}

// Unlinks neighbours if one of them is dropped or their sides differ.
void forgetStrangers(Surface& surface, const RunSettings& run)
{
	inBlocks(surface.opposite.size(), 3 * kSurfaceBlock, run, nullptr,
			 [&](std::size_t h)
			 {
				 const uint32_t across = surface.opposite[h];
				 if (across != kNone && (surface.kept[h / 3] == 0 || surface.kept[across / 3] == 0 ||
										 surface.two_sided[h / 3] != surface.two_sided[across / 3]))
				 {
					 surface.opposite[h] = kNone;
				 }
			 });
}

} // namespace

void addHoles(std::span<const OpenEdge> edges, std::span<const glm::dvec3> positions, std::span<double> holes)
{
	forRuns(
		edges, [](const OpenEdge& a, const OpenEdge& b) { return a.piece == b.piece; },
		[&](std::size_t begin, std::size_t end)
		{ holes[edges[begin].piece] += Walk(edges.subspan(begin, end - begin), positions).area(); });
}

double coverageOf(const Level& level, const Material& material, std::span<const glm::dvec2> corners)
{
	if (material.alpha_mode == AlphaMode::opaque || material.mask < 0)
	{
		return isSolidAt(level, material, {}) ? 1.0 : 0.0;
	}
	const Mask& mask = level.masks[static_cast<std::size_t>(material.mask)];
	double area = 0.0;
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		area += std::fabs(doubleArea(corners[0], corners[i], corners[i + 1]));
	}
	const bool has_area = area > 0.0 && std::isfinite(area); // otherwise it maps to a line or a point of the texture
	const double texels = 0.5 * area * mask.width_px * mask.height_px;
	const double wanted = has_area ? std::clamp(4.0 * texels, 64.0, 1024.0) : 64.0;
	double sum = 0.0;
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		const double share = has_area ? std::fabs(doubleArea(corners[0], corners[i], corners[i + 1])) / area
									  : 1.0 / static_cast<double>(corners.size() - 2);
		const auto count = static_cast<std::size_t>(std::ceil(share * wanted)) + 1;
		sum += share * static_cast<double>(solidIn(mask, material, corners[0], corners[i], corners[i + 1], count)) /
			   static_cast<double>(count);
	}
	return std::min(sum, 1.0);
}

uint32_t kindOf(const Soup& soup, std::size_t triangle)
{
	const uint32_t material = soup.materials[triangle];
	return soup.level->material_list[material].alpha_mode == AlphaMode::opaque ? 0 : material + 1;
}

double flatness(double coordinate_m, bool two_sided, const OccluderSettings& settings)
{
	const double four_ulp = 4.0 * 0x1p-23 * coordinate_m; // at most: an ulp is between 2^-24 and 2^-23 of the number
	const double flat_m = std::max(settings.flat * settings.distance_m, std::min(four_ulp, 1e-4 * settings.distance_m));
	// Heights above the plane of a region's corners can be twice those above the triangle they were measured from.
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
	inBlocks(count, kSurfaceBlock, run, nullptr,
			 [&](std::size_t i)
			 {
				 const glm::uvec3& t = soup.triangles[i];
				 surface.triangles[i] = {first[t.x], first[t.y], first[t.z]};
				 const glm::dvec3 area = areaOf(positions, surface.triangles[i]);
				 surface.kept[i] = glm::dot(area, area) > 0.0 ? 1 : 0;
			 });
	Finder finder(soup, settings, surface);
	{
		const EdgeTable table(surface.triangles, positions.size());
		inBlocks(positions.size(), kSurfaceBlock, run, nullptr,
				 [&](std::size_t vertex) { finder.findAtVertex(table, static_cast<uint32_t>(vertex)); });
	}
	findSides(soup, settings, finder, surface, counts);
	for (std::size_t i = 0; i < count; ++i)
	{
		counts.thin += surface.kept[i] == 0 ? 1U : 0U;
		counts.duplicates += finder.dropped(i) == 1 ? 1U : 0U;
		counts.reversed += finder.dropped(i) == 2 ? 1U : 0U;
		surface.kept[i] = finder.dropped(i) == 0 ? surface.kept[i] : 0;
	}
	forgetStrangers(surface, run);
	return surface;
}

} // namespace nook::detail
