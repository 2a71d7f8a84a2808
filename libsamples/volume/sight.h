// SPDX-License-Identifier: GPL-3.0-or-later
// Tests whether a straight, unblocked line exists between a polygon and pieces of surfaces in front of it, with segments between
// points of both, denser the closer they are. Sampled: a gap much narrower than a twelfth of δ may be missed.
#pragma once

#include "core/progress.h"
#include "scene/camera.h"
#include "scene/reference.h"
#include "scene/tracer.h"
#include "volume/drop.h"
#include "volume/volumes.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace nook
{

// A convex polygon and the unit normal of its relevant side.
struct SightPiece
{
	std::span<const glm::dvec3> corners; // 3 or more
	glm::dvec3 normal{0.0};
};

struct SightSettings
{
	double distance_m = 1.0; // δ, > 0
	double lift_m = 0.0; // offset of the segments' ends from the surfaces, on the relevant side: the surfaces' distance from the
						 // level's triangles, and rounding
	uint64_t most_segments = 60'000; // limit per polygon; if reached, the polygon counts as seen
};

// Result of a segment.
enum class Segment : uint8_t
{
	blocked,
	discounted, // unblocked, but does not count
	open,
};

class Sight
{
public:
	// True if an unblocked segment to a point of a piece counts.
	using Counts = std::function<bool(std::size_t piece, glm::dvec3 point)>;

	Sight(const Tracer& tracer, const SightSettings& settings) : m_tracer(tracer), m_settings(settings) {}

	// The segment between the centres of a piece and of the polygon's part above the piece's plane; most pairs that see each other
	// do so there.
	Segment middles(const SightPiece& polygon, const SightPiece& piece, const std::function<bool(glm::dvec3)>& counts) const;

	// True if a point of a piece that counts sees the polygon's side elsewhere, or the search was inconclusive. Tests a segment
	// between every two small parts of the polygon (above the piece's plane) and of the piece. Small means a size of at most about
	// 0.6 of the distance between them, or δ/12; at that size it also tests segments between their nearest points, and from the
	// corners of either to the nearest points of the other. `segments` counts those traced.
	bool sees(const SightPiece& polygon, std::span<const SightPiece> pieces, const Counts& counts, uint64_t& segments) const;

	// True if a segment from a point reaches the part of the polygon above its tangent plane: at the nearest point, at one of
	// `count` points spread over it (selected by `turn`), or next to a corner.
	bool seesFrom(const SightPiece& polygon, glm::dvec3 point, glm::dvec3 normal, int count, uint32_t turn) const;

private:
	const Tracer& m_tracer;
	SightSettings m_settings;
};

// Appends the part of a convex polygon in front of a plane to `kept`; returns the number of corners added.
std::size_t clipTo(std::span<const glm::dvec3> polygon, glm::dvec3 normal, double offset, std::vector<glm::dvec3>& kept);

// Maps a point of the unit square, folded over its diagonal, to the triangle; preserves uniformity.
glm::dvec3 pointOf(const std::array<glm::dvec3, 3>& triangle, double u, double v);

// The point of a triangle nearest to another point.
glm::dvec3 nearestOf(const std::array<glm::dvec3, 3>& triangle, glm::dvec3 to);

// Finds the surface visible at a position of a camera's picture.

// The nearest surface from a point along a direction, within `reach` times the direction's length, with the normal of the side that
// is hit.
std::optional<ReferencePoint> surfaceAlong(const Tracer& tracer, glm::dvec3 from, glm::dvec3 along, double reach);

class Eye
{
public:
	// Keeps a reference to the tracer. The picture's size is in pixels.
	Eye(const Tracer& tracer, const LevelCamera& camera, int width_px, int height_px);

	// Position in pixels from the upper left corner. The result has the normal of the visible side; none for the sky.
	std::optional<ReferencePoint> at(double x, double y) const;

private:
	const Tracer& m_tracer;
	View m_view;
	Projector m_projector;
	glm::dmat4 m_world_from_camera;
};

// For volumes considered hidden: what receivers see of them, and what they would receive through opaque surfaces.

struct HiddenShares
{
	std::vector<double> behind;        // per receiver: sum of the contributions that are entirely invisible
	std::vector<uint8_t> seen_volumes; // per volume: 1 if a receiver sees part of its contribution
	HiddenCheck check;
};

// One-sided volumes. For each contribution above kHiddenLeast, traces up to 8 segments from the receiver to the polygon, and those
// to its corners and its nearest point, until one is unblocked; smaller contributions count as behind. `lift_m` as in sight.h.
HiddenShares hiddenShares(const VolumeSet& hidden, const Tracer& tracer, std::span<const ReferencePoint> receivers, double lift_m,
						  const RunSettings& run);

// Distance that segments keep from surfaces: rounding, and the fraction of δ within which polygons contribute nothing.
double sightLift(const Tracer& tracer, double distance_m, double surface_m);

} // namespace nook
