// SPDX-License-Identifier: GPL-3.0-or-later
// Merged polygons → shorter ones where they are long against the distance, each with an ᾱ of its own.
#pragma once

#include "volume/occluders.h"
#include "volume/surface.h"

#include <cstdint>
#include <span>
#include <vector>

namespace nook::detail
{

inline constexpr double kClear = 1.0 / 1024.0; // ᾱ below which a polygon counts as clear: a quarter of what an 8-bit picture shows

// ᾱ of a polygon with the material and texture coordinates of a triangle.
double alphaOf(const Soup& soup, uint32_t look, std::span<const glm::dvec3> corners);

// Length that polygons are cut to: `extent`, or twice, four times … that where there would be more than a quarter more of them. A
// rule of the polygons, not of the triangles that they are made of. Infinite where none is cut.
double cutLength(const Occluders& occluders, const OccluderSettings& settings);

// How many pieces that makes, at most.
uint64_t piecesOf(const Occluders& occluders, double length_m);

// Pieces have an ᾱ of their own; clear ones are counted and dropped. looks: of each polygon a triangle of its material and map of
// texture coordinates.
Occluders cutOccluders(const Soup& soup, const Occluders& occluders, const std::vector<uint32_t>& looks, double length_m,
					   OccluderCounts& counts);

} // namespace nook::detail
