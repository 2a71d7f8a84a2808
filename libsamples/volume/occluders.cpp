// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/occluders.h"

#include "core/error.h"
#include "core/lists.h"
#include "core/parallel.h"
#include "scene/ray_triangle.h"
#include "scene/topology.h"
#include "scene/tracer.h"
#include "volume/surface.h"
#include "volume/volumes.h"

#include <glm/geometric.hpp>
#include <meshoptimizer.h>

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

constexpr double kClear = 1.0 / 1024.0; // ᾱ below which a polygon is dropped as clear: a quarter of an 8-bit step

double sumOfHalves(const Occluders& occluders, double length_m)
{
	return sumOver(occluders.polygons, [&](const Occluder& polygon) { return halvesOf(occluders.cornersOf(polygon), length_m); });
}

// ᾱ of a polygon with the material and texture coordinates of a triangle.
double alphaOf(const Soup& soup, uint32_t look, std::span<const glm::dvec3> corners)
{
	const Material& material = soup.level->material_list[soup.materials[look]];
	if (material.alpha_mode == AlphaMode::opaque)
	{
		return 1.0;
	}
	const TextureMap map = textureMapOf(soup, look);
	return coverageOf(*soup.level, material, mapped(corners, [&map](glm::dvec3 corner) { return map.at(corner); }));
}

// Length that polygons are cut to: `extent`, or twice, four times … that if it would make over a quarter more polygons. Depends on
// the merged polygons, not on their triangulation. Infinite if none is cut.
double cutLength(const Occluders& occluders, const OccluderSettings& settings)
{
	const double most = 1.25 * static_cast<double>(occluders.polygons.size());
	for (double length_m = settings.extent * settings.distance_m; length_m < kFarthest_m; length_m *= 2.0)
	{
		if (settings.extent_always || sumOfHalves(occluders, length_m) <= most)
		{
			return length_m;
		}
	}
	return INFINITY;
}

// Upper bound of the number of pieces.
uint64_t piecesOf(const Occluders& occluders, double length_m)
{
	return static_cast<uint64_t>(std::min(sumOfHalves(occluders, length_m), 1e18));
}

// Each piece has its own ᾱ; clear ones are counted and dropped. looks: for each polygon a triangle with its material and texture
// mapping.
Occluders cutOccluders(const Soup& soup, const Occluders& occluders, const std::vector<uint32_t>& looks, double length_m,
					   OccluderCounts& counts)
{
	Occluders cut;
	for (std::size_t i = 0; i < occluders.polygons.size(); ++i)
	{
		Occluder piece = occluders.polygons[i];
		const std::span<const glm::dvec3> whole = occluders.cornersOf(piece);
		if (halvesOf(whole, length_m) == 1.0)
		{
			cut.add(piece, whole);
			continue;
		}
		for (const std::vector<glm::dvec3>& corners : halvedPolygon(whole, length_m, kMaxOccluderCorners))
		{
			const double alpha = alphaOf(soup, looks[i], corners);
			if (alpha < kClear)
			{
				counts.clear += 1;
				continue;
			}
			piece.alpha = static_cast<float>(alpha);
			cut.add(piece, corners);
		}
	}
	return cut;
}

// This work is based on: Michael Garland and Paul Heckbert, Surface Simplification Using Quadric Error Metrics, 1997, as
// implemented by meshoptimizer.

struct Proxies
{
	std::vector<glm::uvec3> triangles; // vertices of the level
	std::vector<uint32_t> materials;
	std::vector<uint32_t> sources; // level triangle that represents each: the first of its piece of surface
	double deviation_m = 0.0;      // greatest error reported by the simplification
};

constexpr std::size_t kFewest = 8; // smallest piece to simplify, in triangles: a box has twelve

struct Part
{
	std::vector<uint32_t> triangles; // in the level
	std::vector<glm::uvec3> simpler; // vertices of the level
	double error_m = 0.0;
};

void simplify(Part& piece, const Level& level, std::span<const uint32_t> first, double error_m)
{
	std::vector<uint32_t> vertices;
	for (const uint32_t t : piece.triangles)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			vertices.push_back(first[level.triangles[t][corner]]);
		}
	}
	std::vector<uint32_t> indices = vertices;
	std::sort(vertices.begin(), vertices.end());
	vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
	for (uint32_t& index : indices)
	{
		index = static_cast<uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), index) - vertices.begin());
	}
	std::vector<float> positions;
	for (const uint32_t vertex : vertices) // relative to the piece itself, so that 32 bits preserve its shape anywhere
	{
		const glm::vec3 at(level.positions[vertex] - level.positions[vertices[0]]);
		positions.insert(positions.end(), {at.x, at.y, at.z});
	}
	constexpr std::size_t kStride = 3 * sizeof(float);
	const float scale = meshopt_simplifyScale(positions.data(), vertices.size(), kStride);
	if (!(scale > 0.0F))
	{
		return;
	}
	std::vector<uint32_t> simpler(indices.size());
	float error = 0.0F;
	simpler.resize(meshopt_simplify(simpler.data(), indices.data(), indices.size(), positions.data(), vertices.size(), kStride, 0,
									static_cast<float>(error_m) / scale, meshopt_SimplifyLockBorder, &error));
	for (std::size_t i = 0; i + 2 < simpler.size(); i += 3)
	{
		piece.simpler.emplace_back(vertices[simpler[i]], vertices[simpler[i + 1]], vertices[simpler[i + 2]]);
	}
	piece.error_m = static_cast<double>(error) * static_cast<double>(scale);
}

// One piece per material of a surface connected by vertices; edges to other materials are borders.
std::vector<Part> piecesOf(const Level& level, std::span<const uint8_t> may_change, std::span<const uint32_t> first)
{
	Groups groups(level.positions.size());
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		if (may_change[i] != 0)
		{
			const glm::uvec3& t = level.triangles[i];
			groups.join(first[t.x], first[t.y]);
			groups.join(first[t.x], first[t.z]);
		}
	}
	std::vector<std::array<uint32_t, 3>> order; // surface, material, triangle
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		if (may_change[i] != 0)
		{
			order.push_back({groups.rootOf(first[level.triangles[i].x]), level.materials[i], static_cast<uint32_t>(i)});
		}
	}
	std::sort(order.begin(), order.end());
	std::vector<Part> pieces;
	for (std::size_t i = 0; i < order.size(); ++i)
	{
		if (i == 0 || order[i][0] != order[i - 1][0] || order[i][1] != order[i - 1][1])
		{
			pieces.emplace_back();
		}
		pieces.back().triangles.push_back(order[i][2]);
	}
	return pieces;
}

// Simplifies each piece of surface (connected by vertices, one material) of the triangles with may_change ≠ 0 separately with
// meshoptimizer (quadric errors), by at most about `error_m`. Borders are locked, so seams fit and closed pieces stay closed. A
// piece that would vanish is left unchanged, like all other triangles.
Proxies proxiesOf(const Level& level, std::span<const uint8_t> may_change, double error_m, const RunSettings& run)
{
	const std::vector<uint32_t> first = weldPositions(level.positions, run.threads);
	std::vector<Part> pieces = piecesOf(level, may_change, first);
	parallelFor(pieces.size(), run.threads,
				[&](std::size_t i)
				{
					if (pieces[i].triangles.size() >= kFewest)
					{
						simplify(pieces[i], level, first, error_m);
					}
				});
	Proxies proxies;
	const auto add = [&](const glm::uvec3& triangle, uint32_t source)
	{
		proxies.triangles.push_back(triangle);
		proxies.materials.push_back(level.materials[source]);
		proxies.sources.push_back(source);
	};
	for (const Part& piece : pieces)
	{
		for (const glm::uvec3& triangle : piece.simpler)
		{
			add(triangle, piece.triangles[0]);
		}
		for (std::size_t i = 0; piece.simpler.empty() && i < piece.triangles.size(); ++i)
		{
			add(level.triangles[piece.triangles[i]], piece.triangles[i]);
		}
		proxies.deviation_m = piece.simpler.empty() ? proxies.deviation_m : std::max(proxies.deviation_m, piece.error_m);
	}
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		if (may_change[i] == 0)
		{
			add(level.triangles[i], static_cast<uint32_t>(i));
		}
	}
	return proxies;
}

// True if the front of a simplified triangle would darken surfaces that face nothing there in the level: folds and steps that the
// simplification made. From points of the triangle, rays look for fronts that lie across from it within `reach_m`, and rays back
// from those for what they really face.
bool facesFalsely(const Tracer& tracer, const std::array<glm::dvec3, 3>& corners, double reach_m)
{
	constexpr double kUp = 0.42;    // cosine of the slanted rays to the normal
	constexpr double kAcross = 0.5; // greatest cosine between the normals of a receiver and of what darkens it much
	constexpr int kFewRays = 3;
	constexpr std::size_t kLook = 2; // points; the others follow if something is wrong there
	constexpr std::array<glm::dvec3, 6> kPoints{
		{{4.0, 1.0, 1.0}, {1.0, 4.0, 1.0}, {1.0, 1.0, 4.0}, {2.6, 2.6, 0.8}, {2.6, 0.8, 2.6}, {0.8, 2.6, 2.6}}};
	const glm::dvec3 across = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
	const double area = glm::length(across);
	if (!(area > 0.0))
	{
		return false;
	}
	const glm::dvec3 normal = across / area;
	const glm::dvec3 s = std::sqrt(1.0 - kUp * kUp) * glm::normalize(corners[1] - corners[0]);
	const glm::dvec3 t = glm::cross(normal, s);
	const std::array<glm::dvec3, 5> ways{normal, kUp * normal + s, kUp * normal - s, kUp * normal + t, kUp * normal - t};
	const double lift_m = 2.0 * tracer.error();
	int wrong = 0;
	int right = 0;
	for (std::size_t i = 0; i < kPoints.size() && (i < kLook || wrong > 0); ++i)
	{
		const glm::dvec3 weights = kPoints[i] / 6.0;
		const glm::dvec3 from = weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2] + lift_m * normal;
		for (const glm::dvec3& way : ways)
		{
			const RayHit hit = tracer.nearest(from, way, reach_m);
			const glm::dvec3 facing = hit.hit && hit.front ? glm::normalize(twiceAreaOf(tracer.level(), hit.triangle)) : normal;
			if (glm::dot(facing, normal) < kAcross)
			{
				const glm::dvec3 receiver = from + hit.distance * way + lift_m * facing;
				(tracer.nearest(receiver, -way, hit.distance + reach_m).hit ? right : wrong) += 1;
			}
		}
	}
	return wrong >= kFewRays && wrong > right;
}

void leaveOutFalse(Proxies& proxies, const Level& level, const Tracer& tracer, const RunSettings& run)
{
	constexpr double kReach = 3.0; // of how far the surface moved
	std::vector<uint8_t> is_false(proxies.triangles.size());
	inBlocks(is_false.size(), 256, run, "folds",
			 [&](std::size_t i)
			 {
				 const glm::uvec3& t = proxies.triangles[i];
				 const std::array<glm::dvec3, 3> corners{level.positions[t.x], level.positions[t.y], level.positions[t.z]};
				 const bool is_new = t != level.triangles[proxies.sources[i]];
				 is_false[i] = is_new && facesFalsely(tracer, corners, kReach * proxies.deviation_m) ? 1 : 0;
			 });
	std::size_t kept = 0;
	for (std::size_t i = 0; i < is_false.size(); ++i)
	{
		if (is_false[i] == 0)
		{
			proxies.triangles[kept] = proxies.triangles[i];
			proxies.materials[kept] = proxies.materials[i];
			proxies.sources[kept++] = proxies.sources[i];
		}
	}
	proxies.triangles.resize(kept);
	proxies.materials.resize(kept);
	proxies.sources.resize(kept);
}

constexpr std::size_t kSoupBlock = std::size_t{1} << 12U;
constexpr uint64_t kMostPieces = uint64_t{1} << 29U; // each cut adds four corners, whose number must fit 32 bits

constexpr double kGaps = 0.8;            // coverage below which a polygon has gaps
constexpr double kLeastGap = 1.0 / 15.0; // of the distance: polygons up to this size remain whole
constexpr double kAlike = 0.1; // parts whose coverage differs by less from the whole remain one polygon: nets, fine leaves

// Output of one block of triangles.
struct Made
{
	Occluders occluders;
	std::vector<uint32_t> looks; // for each polygon a triangle with its material and texture mapping
	OccluderCounts counts;
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
			const uint32_t group = m_groups.rootOf(t);
			m_next[t] = std::exchange(m_heads[group], t);
		}
	}

	// Merges the groups whose first triangle is in [begin, end).
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
	void addTriangle(uint32_t t, Made& made) const
	{
		const glm::uvec3& corners = m_surface.triangles[t];
		addPolygon(std::array{corners.x, corners.y, corners.z}, t, made);
	}

	// `look`: a triangle with the same material and texture mapping, the lowest of the polygon.
	void addPolygon(std::span<const uint32_t> vertices, uint32_t look, Made& made) const
	{
		const auto corners = mapped(vertices, [this](uint32_t vertex) { return m_positions[vertex]; });
		Occluder occluder;
		occluder.triangle = m_soup.sources.empty() ? look : m_soup.sources[look];
		occluder.two_sided = m_surface.two_sided[look] != 0;
		addMasked(occluder, corners, look, m_settings.gap_halvings, made);
	}

	// With OccluderSettings::gap_halvings.
	void addMasked(Occluder& occluder, std::span<const glm::dvec3> corners, uint32_t look, int halvings, Made& made) const
	{
		const double alpha = alphaOf(m_soup, look, corners);
		if (alpha < kClear)
		{
			made.counts.clear += 1;
			return;
		}
		const auto [along, across] = extentsOf(corners);
		const bool large = std::max(along, across) > kLeastGap * m_settings.distance_m;
		if (alpha > kAlike && alpha < kGaps && halvings > 0 && large)
		{
			Made halves;
			for (const std::vector<glm::dvec3>& half : halvedPolygon(corners, 0.999 * std::max(along, across), kMaxOccluderCorners))
			{
				addMasked(occluder, half, look, halvings - 1, halves);
			}
			if (halves.counts.clear > 0 ||
				std::any_of(halves.occluders.polygons.begin(), halves.occluders.polygons.end(),
							[alpha](const Occluder& half) { return std::fabs(half.alpha - alpha) > kAlike; }))
			{
				count(made.counts, halves.counts);
				append(made.occluders, made.looks, halves);
				return;
			}
		}
		occluder.alpha = static_cast<float>(alpha);
		made.occluders.add(occluder, corners);
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

	// For regions that overlap themselves: joins triangles while they stay convex.
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
		const auto points = mapped(vertices, [&](uint32_t vertex) { return axes.of(m_positions[vertex]); });
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
			addPolygon(piece, region.triangles[0], made);
		}
	}

	// Returns false, without adding anything, if the pieces do not cover the region.
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

	// Removes corners where the outline is straight to a millionth of the adjacent length, although other pieces end there.
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
	std::vector<uint32_t> m_heads; // triangles of each group, ascending
	std::vector<uint32_t> m_next;
	std::vector<uint32_t> m_labels;
};

// Cuts polygons that exceed settings.extent.
void cutLong(Occluding& result, const Soup& soup, const std::vector<uint32_t>& looks, const OccluderSettings& settings)
{
	OccluderCounts& counts = result.counts;
	counts.extent_m = cutLength(result.occluders, settings);
	const uint64_t pieces = piecesOf(result.occluders, counts.extent_m);
	if (settings.before_cutting)
	{
		settings.before_cutting(pieces);
	}
	refuseIf(pieces > kMostPieces,
			 soup.level->name + ": extent: found up to " + std::to_string(pieces) + " polygons, expected at most " +
				 std::to_string(kMostPieces) + " (a longer extent)",
			 ExitCode::runtime);
	result.occluders = cutOccluders(soup, result.occluders, looks, counts.extent_m, counts);
	counts.two_sided = static_cast<uint64_t>(std::count_if(result.occluders.polygons.begin(), result.occluders.polygons.end(),
														   [](const Occluder& polygon) { return polygon.two_sided; }));
}

} // namespace

std::vector<uint8_t> closedTriangles(const Level& level, const RunSettings& run)
{
	OccluderSettings settings{.merge = false};
	OccluderCounts counts;
	const Soup soup{&level, level.triangles, level.materials, {}};
	const Surface surface = surfaceOf(soup, settings, run, counts);
	return listOf(level.triangles.size(), [&surface](std::size_t i)
				  { return static_cast<uint8_t>(surface.kept[i] != 0 && surface.two_sided[i] == 0 ? 1 : 0); });
}

Occluding occludersOf(const Level& level, const OccluderSettings& settings, const RunSettings& run)
{
	assert(settings.distance_m > 0.0 && std::isfinite(settings.distance_m) && settings.detail >= 0.0 && settings.detail < 1.0 &&
		   (settings.extent == 0.0 || settings.extent >= 0.1) && settings.flat >= 1e-6 && settings.flat <= 0.05);
	Occluding result;
	OccluderCounts& counts = result.counts;
	counts.triangles = level.triangles.size();
	Proxies proxies;
	Soup soup{&level, level.triangles, level.materials, {}};
	OccluderSettings simplified = settings;
	if (settings.detail > 0.0)
	{
		const ProgressCounter stage(run.progress, "proxies");
		OccluderCounts before;
		const std::vector<uint8_t> two_sided = surfaceOf(soup, settings, run, before).two_sided;
		// These stay oriented, although simplification may open a closed piece: a back would darken the surface that it lies over.
		// So would a front where a closed piece is partly inside out, so backs must be idle if that is known.
		const bool is_any = settings.one_sided.empty() || settings.sides != Sides::automatic;
		const auto isOriented = [&](std::size_t i)
		{
			return two_sided[i] == 0 && kindOf(soup, i) == 0 && (is_any || settings.one_sided[i] != 0);
		};
		simplified.one_sided = listOf(two_sided.size(), [&](std::size_t i) { return static_cast<uint8_t>(isOriented(i) ? 1 : 0); });
		proxies = proxiesOf(level, simplified.one_sided, settings.detail * settings.distance_m, run);
		if (settings.tracer != nullptr)
		{
			leaveOutFalse(proxies, level, *settings.tracer, run);
		}
		soup = {&level, proxies.triangles, proxies.materials, proxies.sources};
		counts.deviation_m = proxies.deviation_m;
	}
	counts.proxies = soup.triangles.size();
	std::optional<ProgressCounter> stage(std::in_place, run.progress, "surface");
	const Surface surface = surfaceOf(soup, simplified, run, counts);
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
	refuseIf(result.occluders.polygons.empty(), level.name + ": found no surface that blocks light, expected a polygon",
			 ExitCode::invalid_input);
	return result;
}

} // namespace nook
