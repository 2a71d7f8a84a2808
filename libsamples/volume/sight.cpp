// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of triangles, halved while they are large relative to their distance, as in hierarchical radiosity (P. Hanrahan, D.
// Salzman, L. Aupperle, "A Rapid Hierarchical Radiosity Algorithm", 1991).
#include "volume/sight.h"

#include "core/convex_clip.h"
#include "core/parallel.h"
#include "core/random.h"
#include "volume/evaluate.h"
#include "volume/region.h"
#include "volume/volumes.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <limits>

namespace nook
{

namespace
{

using Triangle = std::array<glm::dvec3, 3>;

constexpr double kSmall = 0.5;           // radius relative to distance
constexpr double kSmallest = 1.0 / 24.0; // minimum radius, relative to δ
constexpr double kInward = 1.0 / 64.0;   // how far corners are moved inward: exactly on an edge, adjacent surfaces may touch

struct Patch
{
	Triangle corners;
	glm::dvec3 middle{0.0};
	double radius_m = 0.0;
};

Patch patchOf(const Triangle& corners)
{
	const glm::dvec3 middle = (corners[0] + corners[1] + corners[2]) / 3.0;
	double radius_m = 0.0;
	for (const glm::dvec3& corner : corners)
	{
		radius_m = std::max(radius_m, glm::length(corner - middle));
	}
	return {corners, middle, radius_m};
}

// Splits across the longest edge.
std::array<Patch, 2> halvesOf(const Patch& patch)
{
	const Triangle& p = patch.corners;
	const std::array<double, 3> lengths{glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])};
	const auto longest = static_cast<std::size_t>(std::max_element(lengths.begin(), lengths.end()) - lengths.begin());
	const glm::dvec3 a = p[longest];
	const glm::dvec3 b = p[(longest + 1) % 3];
	const glm::dvec3 c = p[(longest + 2) % 3];
	const glm::dvec3 half = 0.5 * (a + b);
	return {patchOf({a, half, c}), patchOf({half, b, c})};
}

glm::dvec3 middleOf(std::span<const glm::dvec3> corners)
{
	glm::dvec3 sum(0.0);
	for (const glm::dvec3& corner : corners)
	{
		sum += corner;
	}
	return sum / static_cast<double>(corners.size());
}

glm::dvec3 inward(glm::dvec3 point, glm::dvec3 middle)
{
	return point + kInward * (middle - point);
}

glm::dvec3 nearestOf(std::span<const glm::dvec3> polygon, glm::dvec3 to)
{
	glm::dvec3 best = polygon[0];
	for (std::size_t i = 2; i < polygon.size(); ++i)
	{
		const glm::dvec3 here = nook::nearestOf(Triangle{polygon[0], polygon[i - 1], polygon[i]}, to);
		best = glm::length(here - to) < glm::length(best - to) ? here : best;
	}
	return best;
}

// Tests one polygon against its pieces.
class Search
{
public:
	Search(const Tracer& tracer, const SightSettings& settings, glm::dvec3 front, const Sight::Counts& counts, uint64_t& segments)
		: m_tracer(tracer), m_settings(settings), m_front(front), m_counts(counts), m_segments(segments)
	{
	}

	void turnTo(std::size_t index, const SightPiece& piece)
	{
		m_piece = index;
		m_normal = piece.normal;
	}

	// Each returns true if a segment is unblocked, or too many have been traced.
	bool corners(std::span<const glm::dvec3> polygon, const SightPiece& piece);
	bool patches(std::span<const glm::dvec3> polygon, const SightPiece& piece);

private:
	bool through(glm::dvec3 from, glm::dvec3 to)
	{
		m_segments += 1;
		return m_segments > m_settings.most_segments ||
			   (!m_tracer.blocked(from + m_settings.lift_m * m_normal, to + m_settings.lift_m * m_front) &&
				m_counts(m_piece, from));
	}
	bool small(const Patch& a, const Patch& b) const
	{
		const double radius_m = std::max(a.radius_m, b.radius_m);
		return radius_m <= kSmall * glm::length(a.middle - b.middle) || radius_m <= kSmallest * m_settings.distance_m;
	}
	bool pair(const Patch& polygon, const Patch& piece);
	bool contact(const Patch& polygon, const Patch& piece);

	const Tracer& m_tracer;
	const SightSettings& m_settings;
	glm::dvec3 m_front;
	std::size_t m_piece = 0;
	glm::dvec3 m_normal{0.0}; // of the piece
	const Sight::Counts& m_counts;
	uint64_t& m_segments;
};

bool Search::corners(std::span<const glm::dvec3> polygon, const SightPiece& piece)
{
	const glm::dvec3 of_polygon = middleOf(polygon);
	const glm::dvec3 of_piece = middleOf(piece.corners);
	for (const glm::dvec3& corner : piece.corners)
	{
		if (through(inward(corner, of_piece), inward(nearestOf(polygon, corner), of_polygon)))
		{
			return true;
		}
	}
	return std::any_of(polygon.begin(), polygon.end(),
					   [&](glm::dvec3 corner)
					   { return through(inward(nearestOf(piece.corners, corner), of_piece), inward(corner, of_polygon)); });
}

// Between the nearest points of two small triangles, found by alternating projections.
bool Search::contact(const Patch& polygon, const Patch& piece)
{
	glm::dvec3 on_polygon = polygon.middle;
	glm::dvec3 on_piece = piece.middle;
	for (int i = 0; i < 4; ++i)
	{
		on_piece = nook::nearestOf(piece.corners, on_polygon);
		on_polygon = nook::nearestOf(polygon.corners, on_piece);
	}
	return through(inward(on_piece, piece.middle), inward(on_polygon, polygon.middle));
}

bool Search::pair(const Patch& polygon, const Patch& piece)
{
	if (!small(polygon, piece))
	{
		const bool which = polygon.radius_m > piece.radius_m;
		const std::array<Patch, 2> halves = halvesOf(which ? polygon : piece);
		return which ? pair(halves[0], piece) || pair(halves[1], piece) : pair(polygon, halves[0]) || pair(polygon, halves[1]);
	}
	const double apart_m = glm::length(polygon.middle - piece.middle) - polygon.radius_m - piece.radius_m;
	return through(piece.middle, polygon.middle) || (apart_m < kSmallest * m_settings.distance_m && contact(polygon, piece));
}

bool Search::patches(std::span<const glm::dvec3> polygon, const SightPiece& piece)
{
	for (std::size_t i = 2; i < polygon.size(); ++i)
	{
		const Patch of_polygon = patchOf({polygon[0], polygon[i - 1], polygon[i]});
		for (std::size_t k = 2; k < piece.corners.size(); ++k)
		{
			if (pair(of_polygon, patchOf({piece.corners[0], piece.corners[k - 1], piece.corners[k]})))
			{
				return true;
			}
		}
	}
	return false;
}

double radiusOf(std::span<const glm::dvec3> corners)
{
	const glm::dvec3 middle = middleOf(corners);
	double radius_m = 0.0;
	for (const glm::dvec3& corner : corners)
	{
		radius_m = std::max(radius_m, glm::length(corner - middle));
	}
	return radius_m;
}

// Minimum height: a point in a plane is not above it.
double heightOf(glm::dvec3 point, glm::dvec3 normal, double distance_m)
{
	return glm::dot(normal, point) + 1e-6 * distance_m;
}

constexpr std::size_t kBlock = 64; // receivers per thread and step
constexpr int kSegments = 8;       // per pair of a receiver and a polygon

} // namespace

std::size_t clipTo(std::span<const glm::dvec3> polygon, glm::dvec3 normal, double offset, std::vector<glm::dvec3>& kept)
{
	const std::size_t first = kept.size();
	clipConvex(
		polygon.data(), polygon.size(), LastEdge::first, [&](const glm::dvec3& x) { return glm::dot(normal, x) - offset; },
		OnEdge{}, [&](const glm::dvec3& x) { kept.push_back(x); });
	return kept.size() - first;
}

glm::dvec3 pointOf(const std::array<glm::dvec3, 3>& triangle, double u, double v)
{
	const auto& [a, b, c] = triangle;
	const bool beyond = u + v > 1.0;
	return a + (beyond ? 1.0 - u : u) * (b - a) + (beyond ? 1.0 - v : v) * (c - a);
}

// Case analysis by corners, edges and interior (C. Ericson, "Real-Time Collision Detection", 2005, §5.1.5).
glm::dvec3 nearestOf(const std::array<glm::dvec3, 3>& triangle, glm::dvec3 to)
{
	const auto& [a, b, c] = triangle;
	const glm::dvec3 ab = b - a;
	const glm::dvec3 ac = c - a;
	const double a1 = glm::dot(ab, to - a);
	const double a2 = glm::dot(ac, to - a);
	if (a1 <= 0.0 && a2 <= 0.0)
	{
		return a;
	}
	const double b1 = glm::dot(ab, to - b);
	const double b2 = glm::dot(ac, to - b);
	if (b1 >= 0.0 && b2 <= b1)
	{
		return b;
	}
	const double c1 = glm::dot(ab, to - c);
	const double c2 = glm::dot(ac, to - c);
	if (c2 >= 0.0 && c1 <= c2)
	{
		return c;
	}
	const double on_ab = a1 * b2 - b1 * a2;
	if (on_ab <= 0.0 && a1 >= 0.0 && b1 <= 0.0)
	{
		return a + ab * (a1 / (a1 - b1));
	}
	const double on_ac = c1 * a2 - a1 * c2;
	if (on_ac <= 0.0 && a2 >= 0.0 && c2 <= 0.0)
	{
		return a + ac * (a2 / (a2 - c2));
	}
	const double on_bc = b1 * c2 - c1 * b2;
	if (on_bc <= 0.0 && b2 >= b1 && c1 >= c2)
	{
		return b + (c - b) * ((b2 - b1) / ((b2 - b1) + (c1 - c2)));
	}
	return a + (ab * on_ac + ac * on_ab) / (on_ab + on_ac + on_bc);
}

Segment Sight::middles(const SightPiece& polygon, const SightPiece& piece, const std::function<bool(glm::dvec3)>& counts) const
{
	std::vector<glm::dvec3> above;
	const double height = heightOf(piece.corners[0], piece.normal, m_settings.distance_m);
	if (clipTo(polygon.corners, piece.normal, height, above) < 3)
	{
		return Segment::blocked;
	}
	const glm::dvec3 from = middleOf(piece.corners);
	if (m_tracer.blocked(from + m_settings.lift_m * piece.normal, middleOf(above) + m_settings.lift_m * polygon.normal))
	{
		return Segment::blocked;
	}
	return counts(from) ? Segment::open : Segment::discounted;
}

bool Sight::sees(const SightPiece& polygon, std::span<const SightPiece> pieces, const Counts& counts, uint64_t& segments) const
{
	Search search(m_tracer, m_settings, polygon.normal, counts, segments);
	std::vector<glm::dvec3> above;
	// Tests the corners of all pieces first: they are few and often sufficient.
	for (const bool corners : {true, false})
	{
		for (std::size_t i = 0; i < pieces.size(); ++i)
		{
			const SightPiece& piece = pieces[i];
			above.clear();
			if (clipTo(polygon.corners, piece.normal, heightOf(piece.corners[0], piece.normal, m_settings.distance_m), above) < 3)
			{
				continue;
			}
			search.turnTo(i, piece);
			const double apart_m = glm::length(middleOf(above) - middleOf(piece.corners));
			const bool far_apart = std::max(radiusOf(above), radiusOf(piece.corners)) <= kSmall * apart_m;
			if (!far_apart && (corners ? search.corners(above, piece) : search.patches(above, piece)))
			{
				return true;
			}
		}
	}
	return false;
}

bool Sight::seesFrom(const SightPiece& polygon, glm::dvec3 point, glm::dvec3 normal, int count, uint32_t turn) const
{
	assert(count >= 1);
	std::vector<glm::dvec3> above;
	if (clipTo(polygon.corners, normal, heightOf(point, normal, m_settings.distance_m), above) < 3)
	{
		return false;
	}
	const glm::dvec3 from = point + m_settings.lift_m * normal;
	const auto through = [&](glm::dvec3 to)
	{
		return !m_tracer.blocked(from, to + m_settings.lift_m * polygon.normal);
	};
	const glm::dvec3 middle = middleOf(above);
	if (through(inward(nearestOf(above, point), middle)))
	{
		return true;
	}
	std::vector<double> areas;
	double area = 0.0;
	for (std::size_t i = 2; i < above.size(); ++i)
	{
		areas.push_back(area += glm::length(glm::cross(above[i - 1] - above[0], above[i] - above[0])));
	}
	for (int k = 0; k < count; ++k)
	{
		const auto found = std::upper_bound(areas.begin(), areas.end(), (k + 0.5) / count * area);
		const auto i = static_cast<std::size_t>(std::min(found, areas.end() - 1) - areas.begin()) + 2;
		// M. Roberts' sequence R2.
		const double at = static_cast<double>(turn % 65536) + k + 1.0;
		const double u = fraction(0.5 + 0.7548776662466927 * at);
		const double v = fraction(0.5 + 0.5698402909980532 * at);
		if (through(pointOf({above[0], above[i - 1], above[i]}, u, v)))
		{
			return true;
		}
	}
	return std::any_of(above.begin(), above.end(), [&](glm::dvec3 corner) { return through(inward(corner, middle)); });
}

Eye::Eye(const Tracer& tracer, const LevelCamera& camera, int width_px, int height_px)
	: m_tracer(tracer), m_view(viewOf(camera, width_px, height_px)), m_projector(m_view.projection, width_px, height_px),
	  m_world_from_camera(glm::inverse(m_view.camera_from_world))
{
}

std::optional<ReferencePoint> Eye::at(double x, double y) const
{
	const ViewLine line = m_projector.lineOf({x, y});
	return surfaceAlong(m_tracer, glm::dvec3(m_world_from_camera * glm::dvec4(line.at, 1.0)),
						glm::dmat3(m_world_from_camera) * line.along, std::numeric_limits<double>::infinity());
}

std::optional<ReferencePoint> surfaceAlong(const Tracer& tracer, glm::dvec3 from, glm::dvec3 along, double reach)
{
	const RayHit hit = tracer.nearest(from, along, reach);
	if (!hit.hit)
	{
		return std::nullopt;
	}
	const Level& level = tracer.level();
	const glm::uvec3 corner = level.triangles[hit.triangle];
	const glm::dvec3 a = level.positions[corner.x];
	const glm::dvec3 across = glm::cross(level.positions[corner.y] - a, level.positions[corner.z] - a);
	const double area = glm::length(across);
	if (!(area > 0.0))
	{
		return std::nullopt;
	}
	return ReferencePoint{from + hit.distance * along, across * ((hit.front ? 1.0 : -1.0) / area), 0.0};
}

double sightLift(const Tracer& tracer, double distance_m, double surface_m)
{
	return 2.0 * tracer.error() + kPlaneBias * distance_m + surface_m;
}

HiddenShares hiddenShares(const VolumeSet& hidden, const Tracer& tracer, std::span<const ReferencePoint> receivers, double lift_m,
						  const RunSettings& run)
{
	HiddenShares shares;
	shares.behind.assign(receivers.size(), 0.0);
	shares.seen_volumes.assign(hidden.occluders.polygons.size(), 0);
	shares.check.receivers = receivers.size();
	if (hidden.occluders.polygons.empty())
	{
		return shares;
	}
	const VolumeEvaluator evaluator(hidden, run);
	const Sight sight(tracer, {hidden.distance_m, lift_m});
	std::vector<std::vector<uint32_t>> seen(receivers.size());
	std::vector<double> seen_sums(receivers.size(), 0.0); // sum of the contributions that are at least partly visible
	std::vector<std::size_t> asked(receivers.size(), 0);
	ProgressCounter progress(run.progress, "hidden volumes", (receivers.size() + kBlock - 1) / kBlock);
	const auto ask = [&](std::size_t i, std::vector<VolumeShare>& found)
	{
		evaluator.shares(receivers[i].position, receivers[i].normal, found);
		for (const VolumeShare& share : found)
		{
			const Occluder& polygon = hidden.occluders.polygons[share.polygon];
			const std::span<const glm::dvec3> corners = hidden.occluders.cornersOf(polygon);
			const auto occlusion = static_cast<double>(share.occlusion);
			const bool counts = occlusion > kHiddenLeast;
			asked[i] += counts ? 1U : 0U;
			const bool is_seen = counts && sight.seesFrom({corners, frontOf(corners)}, receivers[i].position, receivers[i].normal,
														  kSegments, static_cast<uint32_t>(i * 31 + share.polygon));
			(is_seen ? seen_sums : shares.behind)[i] += occlusion;
			if (is_seen)
			{
				seen[i].push_back(share.polygon);
			}
		}
	};
	parallelFor((receivers.size() + kBlock - 1) / kBlock, run.threads,
				[&](std::size_t block)
				{
					std::vector<VolumeShare> found;
					for (std::size_t i = block * kBlock; i < std::min(receivers.size(), (block + 1) * kBlock); ++i)
					{
						ask(i, found);
					}
					progress.finishOne();
				});
	for (std::size_t i = 0; i < receivers.size(); ++i)
	{
		shares.check.volumes += asked[i];
		shares.check.seen += seen[i].size();
		shares.check.greatest = std::max(shares.check.greatest, seen_sums[i]);
		shares.check.mean += seen_sums[i] / static_cast<double>(receivers.size());
		for (const uint32_t volume : seen[i])
		{
			shares.seen_volumes[volume] = 1;
		}
	}
	return shares;
}

} // namespace nook
