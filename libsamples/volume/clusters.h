// SPDX-License-Identifier: GPL-3.0-or-later
// Sorts the polygons of a set into drawing order and clusters.
#pragma once

#include "core/progress.h"
#include "volume/volumes.h"

#include <cstddef>

namespace nook
{

struct ClusterSettings
{
	std::size_t polygons = 128; // maximum per cluster, 1 to 2048
	// Larger clusters are split if they are too wide for 16-bit coordinates; clusters of polygons larger than δ may be smaller.
	std::size_t fewest = 64;
	std::size_t fewest_large = 1;
};

// Sorts the polygons and sets the clusters with their bounding boxes. Polygons of very different sizes are separated, those of
// similar size are close together, and consecutive clusters are neighbours; within a cluster the strongest occluders come first.
// The order depends only on positions, areas and polygon numbers.
void clusterVolumes(VolumeSet& volumes, const ClusterSettings& settings, const RunSettings& run);

// Bounding box of the volume of polygon `index`.
struct VolumeBox
{
	glm::dvec3 least{1e300};
	glm::dvec3 most{-1e300};
};
VolumeBox volumeBox(const VolumeSet& volumes, std::size_t index);

} // namespace nook
