// SPDX-License-Identifier: GPL-3.0-or-later
// Traces rays against a level (Embree). Supports masks. Thread-safe.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace nook
{

struct RayHit
{
	bool hit = false;
	double distance = 0.0;    // in multiples of the direction's length
	uint32_t triangle = 0;    // index into Level::triangles
	glm::dvec2 barycentric{}; // weights of the triangle's second and third vertex, in [0, 1]
	bool front = false;       // the counter-clockwise side was hit
};

// World-space directions; three arrays of equal size.
struct Directions
{
	std::span<const float> x;
	std::span<const float> y;
	std::span<const float> z;
};

class Vicinity;
struct CameraMemo;

// Tracer::error() for a level with these bounds.
double errorOfRays(const Bounds& bounds);

class Tracer
{
public:
	// Keeps a reference to the level, which must outlive this object. Requires at least one triangle. Throws Error (runtime) if out
	// of memory. `near`: leaves out triangles that do not touch it, since no ray will get there: a smaller tree with the same
	// results. `occluders`: 1 for each triangle that rays hit; empty: all.
	Tracer(const Level& level, const RunSettings& run, const Vicinity* near = nullptr, std::span<const uint8_t> occluders = {});
	~Tracer();
	Tracer& operator=(Tracer&&) = delete;

	const Level& level() const;

	// The nearest surface from `origin` (world space) along `direction`, within `reach` times its length (may be infinite). The
	// distance is recomputed in double from the triangle's vertices; among surfaces at the same distance the lowest triangle index
	// wins, independently of the tree.
	RayHit nearest(glm::dvec3 origin, glm::dvec3 direction, double reach) const;

	// Bound in metres on how far rounding to 32 bits and the hit test may move a surface relative to a ray's origin: an origin
	// lifted off a surface by this much does not hit that surface again. Derived in tracer.cpp.
	double error() const;

	// The level's bounds, cached.
	const Bounds& bounds() const;

	// All rays of one point: distances[i] becomes the distance to the nearest surface, +inf if there is none within `reach`; both
	// in multiples of the direction's length. Never negative.
	void distances(glm::dvec3 origin, const Directions& directions, float reach, std::span<float> distances) const;

	// Any-hit version: blocked[i] becomes 1 or 0. Faster.
	void blocked(glm::dvec3 origin, const Directions& directions, float reach, std::span<uint8_t> blocked) const;

	// True if an opaque surface lies between two points. Masked surfaces never block.
	bool blocked(glm::dvec3 from, glm::dvec3 to) const;

	// sides[i] becomes 1 if the nearest surface shows its front, −1 if its back, 0 if there is none or it is masked.
	void sides(glm::dvec3 origin, const Directions& directions, std::span<int8_t> sides) const;

	// For chooseCameras(): the views chosen so far.
	CameraMemo& cameraMemo() const
	{
		return *m_cameras;
	}

private:
	struct Data;
	std::unique_ptr<Data> m_data;
	std::shared_ptr<CameraMemo> m_cameras;
};

// The region that rays of a given reach from a set of points can enter. Triangles elsewhere need no tree.

// A grid of cells over a level's bounds, about 1 MB. Conservative: may report too much, never too little.
class Vicinity
{
public:
	// `reach_m`: > 0, metres around every point. Requires the bounds of at least one triangle.
	Vicinity(const Bounds& bounds, double reach_m);

	// Call before count(). Points outside the bounds count as the nearest ones inside.
	void add(glm::dvec3 point);

	// Call after the last point.
	void count();

	// True if something in the box may be in reach. Requires count().
	bool touches(const Bounds& box) const;

private:
	glm::ivec3 cellOf(glm::dvec3 point) const;
	std::size_t placeOf(glm::ivec3 cell) const;

	Bounds m_bounds;
	double m_cell_m = 1.0;
	int m_reach_cells = 1;
	glm::ivec3 m_cells{1};
	std::array<std::size_t, 3> m_size{}; // of the sums: the cells, after one plane of zeros on each axis
	std::vector<uint32_t> m_sums; // at first 1 where there is a point; then the number of such cells that come no later on any axis
};

} // namespace nook
