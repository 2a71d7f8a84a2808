// SPDX-License-Identifier: GPL-3.0-or-later
// A ray and a triangle of a level in double: where they meet, and a larger triangle for trees that round to 32 bits.
#pragma once

#include "scene/level.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace nook
{

// Where the line origin + t·direction meets a triangle's plane. Not finite where it runs along that.
struct PlaneHit
{
	double t = 0.0;
	double b = 0.0; // barycentric weights of the second and third vertex
	double c = 0.0;
	double rise = 0.0; // metres along the normal for one of t; < 0: the front faces the origin
};

PlaneHit meet(const Level& level, uint32_t triangle, glm::dvec3 origin, glm::dvec3 direction);

// Is it on the triangle, ahead; with room for what rounding in double leaves open along edges, so that nothing passes between two.
bool isInside(const PlaneHit& hit);

struct LargerTriangle
{
	std::array<glm::dvec3, 3> corners;
	double margin = 0.0; // barycentric weights above it, in the larger triangle, are inside the level's by ten times `by_m`
};

// Every edge moved outwards by `by_m`, in the plane; a needle's corner no further than a thousand times that. One without area
// stays.
LargerTriangle enlarge(const Level& level, uint32_t triangle, double by_m);

} // namespace nook
