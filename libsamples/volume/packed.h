// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes ↔ the numbers that a GPU reads and a file holds: corners of 16 bits within their cluster's box, and prisms of them.
#pragma once

#include "core/progress.h"
#include "volume/runtime/nook_volumes.h"
#include "volume/volumes.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace nook
{

struct PackedVolumes
{
	std::vector<nook_volumes::Cluster> clusters;
	std::vector<nook_volumes::Polygon> polygons;
	std::vector<nook_volumes::Corner> corners;
	std::vector<nook_volumes::Corner> vertices; // of prisms: a polygon's lower ring, then its upper one; empty without prisms
	std::vector<uint16_t> indices;              // triangles, counted from their cluster's first vertex (without prisms: corner)

	// What 16 bits changed.
	double greatest_error_m = 0.0; // of a corner's position
	double plane_error_m = 0.0;    // of a point of a polygon from the plane of what it has become
	std::size_t flat_corners = 0;  // left out: on a line with, or equal to, their neighbours
	std::size_t flat_polygons = 0; // left out: without area
	double flat_area_m2 = 0.0;     // of those
};

struct PackSettings
{
	bool prisms = false;
};

// Corners go where they stay close to their polygon's plane, rather than to the nearest of the numbers: a surface must not be
// darkened by its own polygon. Requires clusters of at most 2048 polygons. Packing what unpacked() gives changes no corner.
PackedVolumes packVolumes(const VolumeSet& volumes, const PackSettings& settings, const RunSettings& run);

// The polygons and clusters of it; `volumes` has distance, curve and the like, and its plane_error_m grows.
VolumeSet unpacked(const PackedVolumes& packed, VolumeSet volumes);

} // namespace nook
