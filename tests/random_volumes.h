// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of random polygons, and comparison of two sets.
#pragma once

#include "testing.h"

#include "core/random.h"
#include "volume/volumes.h"

namespace nook::test
{

using Corners = std::vector<glm::dvec3>;

inline Corners cornersOf(const VolumeSet& volumes, std::size_t polygon)
{
	const Occluder& occluder = volumes.occluders.polygons[polygon];
	const auto first = volumes.occluders.corners.begin() + occluder.first_corner;
	return {first, first + occluder.corner_count};
}

inline void addPolygon(VolumeSet& volumes, const Corners& corners, float alpha = 1.0F, bool two_sided = false)
{
	volumes.occluders.polygons.push_back(
		{static_cast<uint32_t>(volumes.occluders.corners.size()), static_cast<uint32_t>(corners.size()), 0, alpha, two_sided});
	volumes.occluders.corners.insert(volumes.occluders.corners.end(), corners.begin(), corners.end());
}

// Polygons of 3 to 8 corners on circles and ellipses anywhere in a box, from millimetres to tens of metres in size.
inline VolumeSet randomVolumes(std::size_t count, glm::dvec3 middle = {})
{
	Random random(7);
	const auto number = [&random](double least, double most)
	{
		return least + (most - least) * random.below(1U << 20U) / (1U << 20U);
	};
	VolumeSet volumes;
	volumes.distance_m = 0.75;
	volumes.ray_distance_m = 1.25;
	while (volumes.occluders.polygons.size() < count)
	{
		const glm::dvec3 at = middle + glm::dvec3{number(-40.0, 40.0), number(0.0, 9.0), number(-40.0, 40.0)};
		const glm::dvec3 u{number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)};
		const glm::dvec3 v = glm::cross(u, glm::dvec3{number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)});
		const double size = std::exp2(number(-8.0, 4.0));
		const auto corners = 3 + random.below(6);
		const double turn = number(0.0, 6.0);
		Corners made;
		for (uint32_t i = 0; i < corners; ++i)
		{
			const double angle = turn + 6.283185307179586 * i / corners;
			made.push_back(at + size * (std::cos(angle) * u + std::sin(angle) * v));
		}
		addPolygon(volumes, made, static_cast<float>(number(0.01, 1.0)), random.below(2) == 1);
	}
	return volumes;
}

inline VolumeSet clustered(VolumeSet volumes, std::size_t polygons = 128, int threads = 1)
{
	RunSettings run;
	run.threads = threads;
	clusterVolumes(volumes, {polygons}, run);
	return volumes;
}

inline bool sameVolumes(const VolumeSet& a, const VolumeSet& b)
{
	const auto same = [](const Occluder& x, const Occluder& y)
	{
		return x.first_corner == y.first_corner && x.corner_count == y.corner_count && x.alpha == y.alpha &&
			   x.two_sided == y.two_sided;
	};
	const auto same_cluster = [](const VolumeCluster& x, const VolumeCluster& y)
	{
		return x.first_polygon == y.first_polygon && x.polygon_count == y.polygon_count && x.least == y.least && x.most == y.most;
	};
	return a.occluders.corners == b.occluders.corners && a.distance_m == b.distance_m && a.ray_distance_m == b.ray_distance_m &&
		   a.exact_bounds == b.exact_bounds && a.compensation.range == b.compensation.range &&
		   a.compensation.occlusion == b.compensation.occlusion &&
		   std::equal(a.occluders.polygons.begin(), a.occluders.polygons.end(), b.occluders.polygons.begin(),
					  b.occluders.polygons.end(), same) &&
		   std::equal(a.clusters.begin(), a.clusters.end(), b.clusters.begin(), b.clusters.end(), same_cluster);
}

} // namespace nook::test
