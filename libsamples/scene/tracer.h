// SPDX-License-Identifier: GPL-3.0-or-later
// A level, ready for rays (Embree). Masks are respected. Queries may come from any thread.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <span>

namespace nook
{

struct RayHit
{
	bool hit = false;
	double distance = 0.0;    // in lengths of the direction
	uint32_t triangle = 0;    // of Level::triangles
	glm::dvec2 barycentric{}; // weights of the triangle's second and third vertex, in [0, 1]
	bool front = false;       // the ray met the counter-clockwise side
};

// Directions in world space; three arrays of one size.
struct Directions
{
	std::span<const float> x;
	std::span<const float> y;
	std::span<const float> z;
};

class Vicinity;

// What Tracer::error() is, of levels in these bounds.
double errorOfRays(const Bounds& bounds);

class Tracer
{
public:
	// Keeps a reference to the level, which must outlive it. Requires at least one triangle. Throws Error (runtime) without memory.
	// `near`: triangles that do not touch it are left out, since no ray will get there: a smaller tree, the same answers.
	Tracer(const Level& level, const RunSettings& run, const Vicinity* near = nullptr);
	~Tracer();
	Tracer(const Tracer&) = delete;
	Tracer& operator=(const Tracer&) = delete;

	const Level& level() const;

	// The nearest surface from `origin` (world space) along `direction`, no further than `reach` lengths of it (may be infinite).
	// The distance is worked out again in double from the triangle's vertices; of surfaces at one distance the triangle of the
	// lowest index counts, whatever the tree looks like.
	RayHit nearest(glm::dvec3 origin, glm::dvec3 direction, double reach) const;

	// Metres by which rounding to 32 bits and the hit test may move a surface against a ray's origin: an origin lifted by this much
	// off a surface does not meet that surface again. Derived in tracer.cpp.
	double error() const;

	// The level's bounds, found once.
	const Bounds& bounds() const;

	// All rays of one point: distances[i] becomes the distance to the nearest surface, +inf where there is none within `reach`;
	// both in lengths of the direction. None is below 0.
	void distances(glm::dvec3 origin, const Directions& directions, float reach, std::span<float> distances) const;

	// The same where it matters only whether there is a surface: blocked[i] becomes 1 or 0. Faster.
	void blocked(glm::dvec3 origin, const Directions& directions, float reach, std::span<uint8_t> blocked) const;

	// True where an opaque surface lies between two points. Masked ones do not count, whatever they let through.
	bool blocked(glm::dvec3 from, glm::dvec3 to) const;

	// sides[i] becomes 1 where the nearest surface shows its front, −1 where its back, 0 where there is none or it has a mask.
	void sides(glm::dvec3 origin, const Directions& directions, std::span<int8_t> sides) const;

private:
	struct Data;
	std::unique_ptr<Data> m_data;
};

} // namespace nook
