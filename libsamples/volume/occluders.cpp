// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/occluders.h"

#include "core/error.h"
#include "core/parallel.h"
#include "volume/cut.h"
#include "volume/flat.h"
#include "volume/groups.h"
#include "volume/partition.h"
#include "volume/prism.h"
#include "volume/proxies.h"
#include "volume/surface.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <optional>
#include <utility>

namespace nook
{
namespace
{

using namespace detail;

constexpr std::size_t kSoupBlock = std::size_t{1} << 12U;
constexpr uint64_t kMostPieces = uint64_t{1} << 29U; // each cut adds four corners, which 32 bits count

// What one block of triangles gives.
struct Made
{
	Occluders occluders;
	std::vector<uint32_t> looks; // of each polygon a triangle of its material and map of texture coordinates
	OccluderCounts counts;
};

class Merger
{
public:
	Merger(const Soup& soup, const OccluderSettings& settings, const Surface& surface)
		: m_soup(soup), m_settings(settings), m_surface(surface), m_positions(soup.level->positions),
		  m_groups(surface.triangles.size()), m_next(surface.triangles.size(), kNone), m_labels(surface.triangles.size(), kNone)
	{
		for (std::size_t h = 0; h < surface.opposite.size(); ++h)
		{
			const uint32_t across = surface.opposite[h];
			if (across != kNone && across > h)
			{
				m_groups.join(static_cast<uint32_t>(h / 3), across / 3);
			}
		}
		m_heads.assign(surface.triangles.size(), kNone);
		for (auto t = static_cast<uint32_t>(surface.triangles.size()); t-- > 0;)
		{
			const uint32_t group = m_groups.of(t);
			m_next[t] = std::exchange(m_heads[group], t);
		}
	}

	// Groups whose first triangle is one of [begin, end).
	Made merge(std::size_t begin, std::size_t end)
	{
		Made made;
		std::vector<uint32_t> group;
		for (std::size_t i = begin; i < end; ++i)
		{
			const auto first = static_cast<uint32_t>(i);
			if (m_heads[i] != first || m_surface.kept[i] == 0)
			{
				continue;
			}
			if (m_next[i] == kNone)
			{
				made.counts.regions += 1;
				addTriangle(first, made);
				continue;
			}
			group.clear();
			for (uint32_t t = first; t != kNone; t = m_next[t])
			{
				group.push_back(t);
			}
			for (const Region& region : flatRegions(group, m_soup, m_surface, m_settings, m_labels))
			{
				addRegion(region, made);
			}
		}
		return made;
	}

private:
	uint32_t sourceOf(uint32_t triangle) const
	{
		return m_soup.sources.empty() ? triangle : m_soup.sources[triangle];
	}

	void addTriangle(uint32_t t, Made& made) const
	{
		const glm::uvec3& corners = m_surface.triangles[t];
		addPolygon(std::array{corners.x, corners.y, corners.z}, t, t, made);
	}

	// `look`: a triangle of the same material and map of texture coordinates.
	void addPolygon(std::span<const uint32_t> vertices, uint32_t look, uint32_t lowest, Made& made) const
	{
		std::vector<glm::dvec3> corners;
		for (const uint32_t vertex : vertices)
		{
			corners.push_back(m_positions[vertex]);
		}
		addCorners(corners, look, lowest, made);
	}

	void addCorners(std::span<const glm::dvec3> corners, uint32_t look, uint32_t lowest, Made& made) const
	{
		Occluder occluder;
		occluder.first_corner = static_cast<uint32_t>(made.occluders.corners.size());
		occluder.corner_count = static_cast<uint32_t>(corners.size());
		occluder.triangle = sourceOf(lowest);
		occluder.two_sided = m_surface.two_sided[look] != 0;
		const double alpha = alphaOf(m_soup, look, corners);
		if (alpha < kClear)
		{
			made.counts.clear += 1;
			return;
		}
		occluder.alpha = static_cast<float>(alpha);
		made.occluders.corners.insert(made.occluders.corners.end(), corners.begin(), corners.end());
		made.occluders.polygons.push_back(occluder);
		made.looks.push_back(look);
		made.counts.two_sided += occluder.two_sided ? 1U : 0U;
	}

	void addRegion(const Region& region, Made& made) const
	{
		made.counts.regions += 1;
		if (region.triangles.size() == 1)
		{
			addTriangle(region.triangles[0], made);
			return;
		}
		const std::vector<Loop> whole = outlineOf(region, m_surface, m_labels, m_positions);
		std::vector<Loop> loops = whole;
		simplifyOutline(loops, region.normal, region.flat_m, m_positions);
		made.counts.with_holes += loops.size() > 1 ? 1U : 0U;
		if (addOutline(loops, region, made) || addOutline(whole, region, made))
		{
			return;
		}
		made.counts.fallbacks += 1;
		addJoined(region, made);
	}

	// Regions that overlap themselves: triangles joined as long as they are convex.
	void addJoined(const Region& region, Made& made) const
	{
		const PlaneAxes axes(m_positions[m_surface.triangles[region.triangles[0]].x], region.normal);
		std::vector<uint32_t> vertices;
		for (const uint32_t t : region.triangles)
		{
			const glm::uvec3& corners = m_surface.triangles[t];
			vertices.insert(vertices.end(), {corners.x, corners.y, corners.z});
		}
		std::sort(vertices.begin(), vertices.end());
		vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
		std::vector<glm::dvec2> points;
		for (const uint32_t vertex : vertices)
		{
			points.push_back(axes.of(m_positions[vertex]));
		}
		std::vector<Piece> triangles;
		std::vector<std::pair<uint32_t, uint32_t>> neighbours;
		for (std::size_t i = 0; i < region.triangles.size(); ++i)
		{
			const uint32_t t = region.triangles[i];
			triangles.emplace_back();
			for (int corner = 0; corner < 3; ++corner)
			{
				const auto at = std::lower_bound(vertices.begin(), vertices.end(), m_surface.triangles[t][corner]);
				triangles.back().push_back(static_cast<uint32_t>(at - vertices.begin()));
				const uint32_t across = m_surface.opposite[3 * std::size_t{t} + static_cast<std::size_t>(corner)];
				if (across != kNone && across / 3 > t && m_labels[across / 3] == m_labels[t])
				{
					const auto other = std::lower_bound(region.triangles.begin(), region.triangles.end(), across / 3);
					neighbours.emplace_back(static_cast<uint32_t>(i), static_cast<uint32_t>(other - region.triangles.begin()));
				}
			}
		}
		for (Piece& piece : joinTriangles(points, std::move(triangles), neighbours, kMaxOccluderCorners))
		{
			for (uint32_t& corner : piece)
			{
				corner = vertices[corner];
			}
			addPiece(piece, region, made);
		}
	}

	void addPiece(Piece piece, const Region& region, Made& made) const
	{
		dropFlatCorners(piece, region.normal);
		if (piece.size() >= 3)
		{
			addPolygon(piece, region.triangles[0], region.triangles[0], made);
		}
	}

	// False, with nothing added, where the pieces do not cover the region.
	bool addOutline(const std::vector<Loop>& loops, const Region& region, Made& made) const
	{
		if (loops.empty())
		{
			return false;
		}
		std::vector<uint32_t> vertices;
		std::vector<std::vector<glm::dvec2>> flat;
		double length = 0.0;
		const glm::dvec3 normal = normalOf(loops);
		const PlaneAxes axes(m_positions[loops[0][0]], normal);
		for (const Loop& loop : loops)
		{
			flat.emplace_back();
			for (std::size_t i = 0; i < loop.size(); ++i)
			{
				vertices.push_back(loop[i]);
				flat.back().push_back(axes.of(m_positions[loop[i]]));
				length += glm::distance(m_positions[loop[i]], m_positions[loop[(i + 1) % loop.size()]]);
			}
		}
		std::vector<Piece> pieces = loops.size() == 1 && isConvex(flat[0]) ? cutConvex(flat[0].size(), kMaxOccluderCorners)
																		   : convexPieces(flat, kMaxOccluderCorners);
		double area_m2 = 0.0;
		for (Piece& piece : pieces)
		{
			for (uint32_t& corner : piece)
			{
				corner = vertices[corner];
			}
			area_m2 += pieceArea(piece, normal);
		}
		if (!(std::fabs(area_m2 - region.area_m2) <= 2.0 * region.flat_m * length + 1e-9 * region.area_m2))
		{
			return false;
		}
		for (const Piece& piece : pieces)
		{
			addPiece(piece, region, made);
		}
		return true;
	}

	glm::dvec3 normalOf(const std::vector<Loop>& loops) const
	{
		glm::dvec3 sum(0.0);
		for (const Loop& loop : loops)
		{
			for (std::size_t i = 1; i + 1 < loop.size(); ++i)
			{
				sum += areaOf(m_positions, {loop[0], loop[i], loop[i + 1]});
			}
		}
		return glm::normalize(sum);
	}

	double pieceArea(const Piece& piece, glm::dvec3 normal) const
	{
		double sum = 0.0;
		for (std::size_t i = 1; i + 1 < piece.size(); ++i)
		{
			sum += 0.5 * glm::dot(areaOf(m_positions, {piece[0], piece[i], piece[i + 1]}), normal);
		}
		return sum;
	}

	// Corners where a piece goes straight on, to a millionth of the length beside them: other pieces end there.
	void dropFlatCorners(Piece& piece, glm::dvec3 normal) const
	{
		for (std::size_t i = 0; i < piece.size() && piece.size() >= 3;)
		{
			const glm::dvec3 before = m_positions[piece[(i + piece.size() - 1) % piece.size()]];
			const glm::dvec3 after = m_positions[piece[(i + 1) % piece.size()]];
			const glm::dvec3 arriving = m_positions[piece[i]] - before;
			const glm::dvec3 leaving = after - m_positions[piece[i]];
			const double sine = glm::dot(glm::cross(arriving, leaving), normal);
			if (sine <= 1e-9 * glm::dot(after - before, after - before))
			{
				piece.erase(piece.begin() + static_cast<std::ptrdiff_t>(i));
				i = 0;
				continue;
			}
			++i;
		}
	}

	const Soup& m_soup;
	const OccluderSettings& m_settings;
	const Surface& m_surface;
	std::span<const glm::dvec3> m_positions;
	Groups m_groups;
	std::vector<uint32_t> m_heads; // of each group's triangles, the least first
	std::vector<uint32_t> m_next;
	std::vector<uint32_t> m_labels;
};

void append(Occluders& to, std::vector<uint32_t>& looks, Made& made)
{
	looks.insert(looks.end(), made.looks.begin(), made.looks.end());
	const auto first = static_cast<uint32_t>(to.corners.size());
	for (Occluder occluder : made.occluders.polygons)
	{
		occluder.first_corner += first;
		to.polygons.push_back(occluder);
	}
	to.corners.insert(to.corners.end(), made.occluders.corners.begin(), made.occluders.corners.end());
	made.occluders = {};
	made.looks = {};
}

void count(OccluderCounts& to, const OccluderCounts& made)
{
	to.two_sided += made.two_sided;
	to.regions += made.regions;
	to.with_holes += made.with_holes;
	to.fallbacks += made.fallbacks;
	to.clear += made.clear;
}

// Polygons that are longer than settings.extent says become several.
void cutLong(Occluding& result, const Soup& soup, const std::vector<uint32_t>& looks, const OccluderSettings& settings)
{
	OccluderCounts& counts = result.counts;
	counts.extent_m = cutLength(result.occluders, settings);
	const uint64_t pieces = piecesOf(result.occluders, counts.extent_m);
	if (settings.before_cutting)
	{
		settings.before_cutting(pieces);
	}
	if (pieces > kMostPieces)
	{
		throw Error(ExitCode::runtime, soup.level->name + ": extent: found up to " + std::to_string(pieces) +
										   " polygons, expected at most " + std::to_string(kMostPieces) + " (a longer extent)");
	}
	result.occluders = cutOccluders(soup, result.occluders, looks, counts.extent_m, counts);
	counts.two_sided = static_cast<uint64_t>(std::count_if(result.occluders.polygons.begin(), result.occluders.polygons.end(),
														   [](const Occluder& polygon) { return polygon.two_sided; }));
}

} // namespace

Occluding occludersOf(const Level& level, const OccluderSettings& settings, const RunSettings& run)
{
	assert(settings.distance_m > 0.0 && std::isfinite(settings.distance_m) && settings.detail >= 0.0 && settings.detail < 1.0 &&
		   (settings.extent == 0.0 || settings.extent >= 0.1) && settings.flat >= 1e-6 && settings.flat <= 0.05);
	Occluding result;
	OccluderCounts& counts = result.counts;
	counts.triangles = level.triangles.size();
	Proxies proxies;
	Soup soup{&level, level.triangles, level.materials, {}};
	if (settings.detail > 0.0)
	{
		const ProgressCounter stage(run.progress, "proxies");
		OccluderCounts before;
		std::vector<uint8_t> oriented = surfaceOf(soup, settings, run, before).two_sided;
		for (std::size_t i = 0; i < oriented.size(); ++i)
		{
			oriented[i] = oriented[i] == 0 && kindOf(soup, i) == 0 ? 1 : 0;
		}
		proxies = proxiesOf(level, oriented, settings.detail * settings.distance_m, run);
		soup = {&level, proxies.triangles, proxies.materials, proxies.sources};
		counts.deviation_m = proxies.deviation_m;
	}
	counts.proxies = soup.triangles.size();
	std::optional<ProgressCounter> stage(std::in_place, run.progress, "surface");
	const Surface surface = surfaceOf(soup, settings, run, counts);
	Merger merger(soup, settings, surface);
	std::vector<Made> made((soup.triangles.size() + kSoupBlock - 1) / kSoupBlock);
	stage.emplace(run.progress, "polygons", made.size());
	parallelFor(made.size(), run.threads,
				[&](std::size_t block)
				{
					made[block] = merger.merge(block * kSoupBlock, std::min(soup.triangles.size(), (block + 1) * kSoupBlock));
					stage->finishOne();
				});
	std::vector<uint32_t> looks;
	for (Made& one : made)
	{
		count(counts, one.counts);
		append(result.occluders, looks, one);
	}
	counts.uncut = result.occluders.polygons.size();
	if (settings.merge && settings.extent > 0.0)
	{
		stage.emplace(run.progress, "cuts");
		cutLong(result, soup, looks, settings);
	}
	counts.polygons = result.occluders.polygons.size();
	counts.corners = result.occluders.corners.size();
	if (result.occluders.polygons.empty())
	{
		throw Error(ExitCode::invalid_input, level.name + ": found no surface that blocks light, expected a polygon");
	}
	return result;
}

} // namespace nook
