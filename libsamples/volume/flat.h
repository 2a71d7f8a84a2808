// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles joined in one plane → flat regions, and their outlines.
#pragma once

#include "volume/surface.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace nook::detail
{

struct Region
{
	std::vector<uint32_t> triangles;
	glm::dvec3 normal{0.0}; // unit
	double flat_m = 0.0;    // how far its corners may lie off the plane
	double area_m2 = 0.0;
};

// Triangles joined by Surface::opposite → regions whose corners all lie in one plane within flatness(): one where that holds for
// all of them, else grown from the largest triangles. labels[t] becomes the same for the triangles of a region, and different
// between those of a group. `group` ascends.
std::vector<Region> flatRegions(std::span<const uint32_t> group, const Soup& soup, const Surface& surface,
								const OccluderSettings& settings, std::span<uint32_t> labels);

// Axes of a plane with the given unit normal: x × y = normal.
struct PlaneAxes
{
	glm::dvec3 origin{0.0};
	glm::dvec3 x{0.0};
	glm::dvec3 y{0.0};

	PlaneAxes(glm::dvec3 origin, glm::dvec3 normal);
	glm::dvec2 of(glm::dvec3 position) const;
};

using Loop = std::vector<uint32_t>; // vertices; the region is on the left

// Closed lines that bound a region; empty where they do not close (a triangle's edges on both sides of it).
std::vector<Loop> outlineOf(const Region& region, const Surface& surface, std::span<const uint32_t> labels,
							std::span<const glm::dvec3> positions);

// Without the corners that lie within `flat_m` of the line between those that stay (Douglas and Peucker, 1973). Each loop then
// begins at its least corner (by x, then y, then z), and loops that have no area are gone: all that follows depends on the corners.
void simplifyOutline(std::vector<Loop>& loops, glm::dvec3 normal, double flat_m, std::span<const glm::dvec3> positions);

} // namespace nook::detail
