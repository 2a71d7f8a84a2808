// SPDX-License-Identifier: GPL-3.0-or-later
// A level, ready for rays (Embree). Masks are respected. Queries may come from any thread.
#pragma once

#include "core/progress.h"
#include "scene/level.h"

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
	glm::dvec2 barycentric{}; // weights of the triangle's second and third vertex
	bool front = false;       // the ray met the counter-clockwise side
};

class Tracer
{
public:
	// Keeps a reference to the level, which must outlive it.
	Tracer(const Level& level, const RunSettings& run);
	~Tracer();
	Tracer(const Tracer&) = delete;
	Tracer& operator=(const Tracer&) = delete;

	const Level& level() const;

	// The nearest surface from `origin` (world space) along `direction`, no further than `reach` lengths of it. The distance is
	// worked out again in double from the triangle's vertices; equal ones go to the triangle of the lower index, whatever the tree
	// looks like.
	RayHit nearest(glm::dvec3 origin, glm::dvec3 direction, double reach) const;

	// Rays run in 32 bits around this point (the centre of the level's box), so that far-away levels lose nothing.
	glm::dvec3 centre() const;

	// How far, at most, rounding to 32 bits and the hit test together move a surface seen from `position`, metres (see tracer.cpp).
	double errorAt(glm::dvec3 position) const;

	// All rays of one point. origin, directions (unit) in world space; distances[i] becomes the distance to the nearest surface,
	// +inf beyond `reach_m`. directions as three arrays, distances.size() each, any number.
	struct Bundle
	{
		std::span<const float> x;
		std::span<const float> y;
		std::span<const float> z;
	};
	void distances(glm::dvec3 origin, const Bundle& directions, float reach_m, std::span<float> distances) const;

	// The same where only whether there is a surface matters: blocked[i] becomes 1 or 0. Faster.
	void blocked(glm::dvec3 origin, const Bundle& directions, float reach_m, std::span<uint8_t> blocked) const;

private:
	struct Data;
	std::unique_ptr<Data> m_data;
};

} // namespace nook
