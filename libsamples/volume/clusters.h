// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons of a set → in drawing order, cluster by cluster.
#pragma once

#include "core/progress.h"
#include "volume/volumes.h"

#include <cstddef>

namespace nook
{

struct ClusterSettings
{
	std::size_t polygons = 128; // of a cluster at most, 1 to 2048
	// Clusters of more are split where they are too wide for 16-bit numbers; polygons larger than δ are fewer.
	std::size_t fewest = 64;
	std::size_t fewest_large = 1;
};

// Sorts the polygons and sets the clusters with their boxes: polygons of much different size are kept apart, those of about one
// size lie close together, and clusters that follow one another are neighbours; within a cluster what takes the most light comes
// first. The order depends on positions, areas and numbers of polygons alone.
void clusterVolumes(VolumeSet& volumes, const ClusterSettings& settings, const RunSettings& run);

// Box of all points that the volume of polygon `index` reaches.
struct VolumeBox
{
	glm::dvec3 least{1e300};
	glm::dvec3 most{-1e300};
};
VolumeBox volumeBox(const VolumeSet& volumes, std::size_t index);

} // namespace nook
