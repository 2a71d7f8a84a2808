// SPDX-License-Identifier: GPL-3.0-or-later
// Intersects a ray with a triangle in double precision, and enlarges triangles for trees that round to 32 bits.
#pragma once

#include "scene/level.h"
#include <glm/vec2.hpp>

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace nook
{

// Where the line origin + t·direction meets a triangle's plane. Not finite if they are parallel.
struct PlaneHit
{
	double t = 0.0;
	double b = 0.0; // barycentric weights of the second and third vertex
	double c = 0.0;
	double rise = 0.0; // metres along the normal per unit of t; < 0: the front faces the origin
};

PlaneHit meet(const Level& level, uint32_t triangle, glm::dvec3 origin, glm::dvec3 direction);

// True if the hit is on the triangle and ahead, with a tolerance for rounding so that nothing passes between two triangles.
bool isInside(const PlaneHit& hit);

struct LargerTriangle
{
	std::array<glm::dvec3, 3> corners;
	double margin = 0.0; // a larger triangle's hit with weights above this is inside the level's triangle by ten times `by_m`
};

// Moves every edge outwards by `by_m` in the plane; a needle's corner by at most a thousand times that. Triangles without area are
// unchanged.
LargerTriangle enlarge(const Level& level, uint32_t triangle, double by_m);

// The counter-clockwise normal, twice as long as the triangle's area.
glm::dvec3 twiceAreaOf(const Level& level, std::size_t triangle);

// Area of each triangle in square metres.
std::vector<double> areasOf(const Level& level);

// Unit normal of the counter-clockwise side. Requires a triangle with area.
glm::dvec3 geometricNormal(const Level& level, uint32_t triangle);

// Unit vertex normal, interpolated and flipped to the triangle's side; the triangle's own if there are none or they cancel.
// `barycentric`: weights of the second and third vertex.
glm::dvec3 interpolatedNormal(const Level& level, uint32_t triangle, glm::dvec2 barycentric);

} // namespace nook
