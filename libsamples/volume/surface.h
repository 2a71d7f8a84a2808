// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles of a level → which of them block light, which join in one plane, and which pieces of surface are closed.
#pragma once

#include "core/progress.h"
#include "scene/level.h"
#include "volume/occluders.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace nook::detail
{

inline constexpr uint32_t kNone = UINT32_MAX;

// What is merged: a level's triangles, or proxies for them.
struct Soup
{
	const Level* level = nullptr;
	std::span<const glm::uvec3> triangles; // vertices of the level
	std::span<const uint32_t> materials;   // one a triangle
	std::span<const uint32_t> sources;     // the level's triangle that each stands for; empty: its own number
};

struct Surface
{
	std::vector<glm::uvec3> triangles; // the first vertex at each position
	std::vector<uint8_t> kept;         // 0: dropped as a duplicate, a back, or thin
	std::vector<uint8_t> two_sided;    // its back darkens, too
	std::vector<uint32_t> opposite;    // half-edge 3 t + c, from corner c to the next: the one across in the same plane, or kNone
};

Surface surfaceOf(const Soup& soup, const OccluderSettings& settings, const RunSettings& run, OccluderCounts& counts);

// 0 for opaque, else one more than the material: only triangles of one kind join.
uint32_t kindOf(const Soup& soup, std::size_t triangle);

// How far from a plane a triangle with coordinates up to `coordinate_m` counts as in it, metres (occluders.h).
double flatness(double coordinate_m, bool two_sided, const OccluderSettings& settings);

// Twice the area, along the front's normal.
glm::dvec3 areaOf(std::span<const glm::dvec3> positions, const glm::uvec3& triangle);

} // namespace nook::detail
