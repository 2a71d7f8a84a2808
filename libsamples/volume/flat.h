// SPDX-License-Identifier: GPL-3.0-or-later
// Groups connected coplanar triangles into flat regions and extracts their outlines.
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
	double flat_m = 0.0;    // maximum distance of its corners from the plane
	double area_m2 = 0.0;
};

// Splits triangles connected by Surface::opposite into regions whose corners lie in one plane within flatness(): a single region if
// that holds for all, else grown from the largest triangles. labels[t] becomes equal for the triangles of a region and distinct
// between the regions of a group. `group` is ascending.
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

// Closed loops that bound a region; empty if they do not close (a triangle's edges on both sides).
std::vector<Loop> outlineOf(const Region& region, const Surface& surface, std::span<const uint32_t> labels,
							std::span<const glm::dvec3> positions);

// Removes corners within `flat_m` of the line between remaining ones (Douglas and Peucker, 1973). Each loop then starts at its
// least corner (by x, y, z), and loops without area are removed, so that later steps depend only on the corners.
void simplifyOutline(std::vector<Loop>& loops, glm::dvec3 normal, double flat_m, std::span<const glm::dvec3> positions);

} // namespace nook::detail
