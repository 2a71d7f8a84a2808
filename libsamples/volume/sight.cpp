// SPDX-License-Identifier: GPL-3.0-or-later
// Pairs of triangles, halved where they are large against their distance: as hierarchical radiosity has it (P. Hanrahan,
// D. Salzman, L. Aupperle, "A Rapid Hierarchical Radiosity Algorithm", 1991).
#include "volume/sight.h"

#include "core/convex_clip.h"
#include "core/sequence.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

using Triangle = std::array<glm::dvec3, 3>;

constexpr double kSmall = 0.5;           // radius against distance
constexpr double kSmallest = 1.0 / 24.0; // radius, of δ
constexpr double kInward = 1.0 / 64.0;   // how far corners move towards the middle: on an edge, others may touch

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

// Across the longest edge.
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

// One polygon against its pieces.
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

	// Each returns true where a segment gets through, or there have been too many.
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

// Between the nearest points of two small triangles: by turns, the nearest of one to that of the other.
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

// At least this far above: what is in a plane is not above it.
double heightOf(glm::dvec3 point, glm::dvec3 normal, double distance_m)
{
	return glm::dot(normal, point) + 1e-6 * distance_m;
}

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

// By the regions of its corners, edges and inside (C. Ericson, "Real-Time Collision Detection", 2005, §5.1.5).
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
	// The corners of all of them first: they are few, and often enough.
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

} // namespace nook
