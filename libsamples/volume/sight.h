// SPDX-License-Identifier: GPL-3.0-or-later
// A polygon and pieces of surfaces before it → is there a straight way between them that nothing opaque blocks? By segments between
// points of both, the denser the nearer the two are to each other. Sampled: a gap much narrower than a twelfth of δ may be missed.
#pragma once

#include "scene/tracer.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace nook
{

// A convex polygon and the unit normal of the side of it that counts.
struct SightPiece
{
	std::span<const glm::dvec3> corners; // 3 or more
	glm::dvec3 normal{0.0};
};

struct SightSettings
{
	double distance_m = 1.0; // δ, > 0
	double lift_m = 0.0; // segments begin and end this far off the surfaces, on the side that counts: as far as these may be from
						 // the level's triangles, and rounding
	uint64_t most_segments = 60'000; // of a polygon; one that needs more counts as seen
};

// What a segment met.
enum class Segment : uint8_t
{
	blocked,
	discounted, // gets through, but does not count
	open,
};

class Sight
{
public:
	// Whether a point of a piece counts where a segment gets there.
	using Counts = std::function<bool(std::size_t piece, glm::dvec3 point)>;

	Sight(const Tracer& tracer, const SightSettings& settings) : m_tracer(tracer), m_settings(settings) {}

	// The segment between the middles of a piece and of the part of the polygon above the piece's plane: most that see one another
	// do so there.
	Segment middles(const SightPiece& polygon, const SightPiece& piece, const std::function<bool(glm::dvec3)>& counts) const;

	// Whether a point of a piece that counts sees the polygon's side elsewhere, or that has not been settled. Between every two
	// small parts of the polygon (above the piece's plane) and of the piece there is a segment. Small is at most about 0.6 of the
	// distance between them across, or δ/12; there it runs between their nearest points, too, as it does between the corners of
	// either and the points of the other nearest to them. `segments` counts those asked.
	bool sees(const SightPiece& polygon, std::span<const SightPiece> pieces, const Counts& counts, uint64_t& segments) const;

	// Whether a segment from a point reaches the part of the polygon above its tangent plane: at the nearest point, at one of
	// `count` spread over it (`turn`: which ones), or beside a corner.
	bool seesFrom(const SightPiece& polygon, glm::dvec3 point, glm::dvec3 normal, int count, uint32_t turn) const;

private:
	const Tracer& m_tracer;
	SightSettings m_settings;
};

// The part of a convex polygon in front of a plane: appended to `kept`; corners added.
std::size_t clipTo(std::span<const glm::dvec3> polygon, glm::dvec3 normal, double offset, std::vector<glm::dvec3>& kept);

// The point of a triangle for one of the unit square, which is folded over its diagonal: uniform for a uniform one.
glm::dvec3 pointOf(const std::array<glm::dvec3, 3>& triangle, double u, double v);

// The point of a triangle that is nearest to another one.
glm::dvec3 nearestOf(const std::array<glm::dvec3, 3>& triangle, glm::dvec3 to);

} // namespace nook
