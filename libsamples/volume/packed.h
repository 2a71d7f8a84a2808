// SPDX-License-Identifier: GPL-3.0-or-later
// Packs volumes into the arrays that a GPU reads and a file stores: 16-bit corners within their cluster's box, and optionally
// prisms.
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
	std::vector<nook_volumes::Corner> vertices; // prisms: a polygon's lower ring, then its upper one; or shared corners; else empty
	std::vector<uint16_t> indices; // triangles relative to their cluster's first vertex (without vertices: first corner)

	// Effects of 16-bit rounding.
	double greatest_error_m = 0.0; // position error of a corner
	double plane_error_m = 0.0;    // distance between a polygon's points and the plane of its packed form
	std::size_t flat_corners = 0;  // corners dropped: collinear with, or equal to, their neighbours
	std::size_t flat_polygons = 0; // polygons dropped: no area
	double flat_area_m2 = 0.0;     // their total area
};

struct PackSettings
{
	bool prisms = false;
	bool shared_corners = false; // without prisms: vertices are the distinct corners of each cluster
};

// Corners are rounded to stay close to the planes of their polygons, rather than to the nearest grid point: a surface must not be
// darkened by its own polygon. Requires clusters of at most 2048 polygons. Repacking the result of unpacked() changes no
// corner, except where rounding has moved a cluster's small polygons across a power of two: then steps double.
PackedVolumes packVolumes(const VolumeSet& volumes, const PackSettings& settings, const RunSettings& run);

// Decodes polygons and clusters; `volumes` supplies distance, curve and so on, and its plane_error_m grows.
VolumeSet unpacked(const PackedVolumes& packed, VolumeSet volumes);

} // namespace nook
