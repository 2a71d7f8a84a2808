// SPDX-License-Identifier: GPL-3.0-or-later
// Ambient occlusion volumes of a level: the polygons that block light, how far they reach, and how they are grouped for drawing.
//
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV).
#pragma once

#include "core/parallel.h"
#include "core/progress.h"
#include "scene/level.h"
#include "volume/volumes.h"

#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

inline constexpr std::size_t kMaxOccluderCorners = 16; // per polygon; larger ones are cut

// A convex, planar polygon. Its corners are counter-clockwise seen from its front.
struct Occluder
{
	uint32_t first_corner = 0; // index into Occluders::corners
	uint32_t corner_count = 3; // 3 to kMaxOccluderCorners
	uint32_t triangle = 0;     // the lowest of the level's triangles that it covers
	float alpha = 1.0F;        // ᾱ of AOV eq. 5, in (0, 1]
	bool two_sided = false;    // also darkens what lies behind it
	float reach = 1.0F;        // in (0, 1]: points further above it than this fraction of δ are not darkened
	float side_reach = 1.0F;   // in (0, reach]: likewise beyond its edges
};

struct Occluders
{
	std::vector<glm::dvec3> corners; // world space, metres; consecutive per polygon, no two equal
	std::vector<Occluder> polygons;

	std::span<const glm::dvec3> cornersOf(const Occluder& polygon) const
	{
		return std::span(corners).subspan(polygon.first_corner, polygon.corner_count);
	}

	// Appends a polygon with these corners.
	void add(Occluder polygon, std::span<const glm::dvec3> of)
	{
		polygon.first_corner = static_cast<uint32_t>(corners.size());
		polygon.corner_count = static_cast<uint32_t>(of.size());
		corners.insert(corners.end(), of.begin(), of.end());
		polygons.push_back(polygon);
	}
};

// Maps the summed occlusion of all volumes at a receiver to its occlusion (AOV §5.4). Linear between equidistant knots from 0 to
// `range`, constant beyond; not decreasing, in [0, 1].
struct Compensation
{
	double range = 1.0;                         // > 0
	std::array<double, 33> occlusion = paper(); // at sum range · i / 32

	double at(double sum) const;

	// The least knot from which on at() is constant.
	double enough() const;

	// The curve of AOV's figure 7, recommended for any level: x − x²/4.
	static std::array<double, 33> paper();
};

// Consecutive polygons that lie close together and are culled as one.
struct VolumeCluster
{
	uint32_t first_polygon = 0;
	uint32_t polygon_count = 0;
	glm::dvec3 least{0.0}; // bounds of its volumes, world space
	glm::dvec3 most{0.0};
};

struct VolumeSet
{
	Occluders occluders;         // in drawing order: cluster by cluster
	double distance_m = 1.0;     // δ of AOV: reach of a volume, > 0
	double ray_distance_m = 0.0; // radius of the equivalent reference with linear falloff
	double plane_error_m = 0.0;  // maximum distance of surfaces from their polygons' planes (16-bit corners): closer receivers are
								 // not darkened by a polygon
	bool exact_bounds = false;   // volumes contain all points with a falloff > 0 (else corners move by at most 2δ)
	Compensation compensation;
	std::vector<VolumeCluster> clusters; // cover the polygons in order, without gaps
};

struct ClusterSettings
{
	std::size_t polygons = 128; // maximum per cluster, 1 to 2048: a cluster takes 530 bytes of a file, and a draw call
	// Larger clusters are split if they are too wide for 16-bit coordinates; clusters of polygons larger than δ may be smaller.
	std::size_t fewest = 64;
	std::size_t fewest_large = 1;
};

constexpr ClusterSettings kMaskClusters{.polygons = 256};

// Sorts the polygons and sets the clusters with their bounding boxes. Polygons of very different sizes are separated, those of
// similar size are close together, and consecutive clusters are neighbours, as are consecutive polygons of a cluster.
// The order depends only on positions, areas and polygon numbers.
void clusterVolumes(VolumeSet& volumes, const ClusterSettings& settings, const RunSettings& run);

inline void include(Bounds& box, glm::dvec3 point)
{
	box.least = glm::min(box.least, point);
	box.most = glm::max(box.most, point);
}

// Returns the bounding box of points.
Bounds boundsAround(std::span<const glm::dvec3> points);

// Bounding box of the volume of polygon `index`.
Bounds volumeBox(const VolumeSet& volumes, std::size_t index);

// The closed convex volume that a polygon darkens (AOV §5.2, eqs. 9 to 13).
struct VolumeShape
{
	double distance_m = 1.0;   // δ, > 0
	bool two_sided = false;    // extends from δ behind the polygon to δ in front; else from its plane to δ in front
	bool exact_bounds = false; // contains all points with a falloff > 0
	double side_share = 1.0;   // extent beyond the polygon's edges relative to δ, > 0
};

// Twice as many points as corners, in world space: the ring in the lower plane, then, in the same order, the ring in the upper one.
// `front`: unit normal of the polygon. The faces made from them (ring, quads, ring) are outward, convex and not degenerate.
// Requires a convex polygon of at least three corners.
void prismOf(std::span<const glm::dvec3> corners, glm::dvec3 front, const VolumeShape& shape, std::span<glm::dvec3> points);

// Shape of a polygon in a set.
VolumeShape shapeOf(const VolumeSet& volumes, const Occluder& polygon);

// Unit normal of a polygon's front by Newell's sum; zero without area.
glm::dvec3 frontOf(std::span<const glm::dvec3> corners);

// Normal of the front with a length of twice the area.
glm::dvec3 areaVector(std::span<const glm::dvec3> corners);

// Calls body(i) for every i below `count` in parallel, in blocks of `size` items; each block is progress of the stage, if that has
// a name.
template <class Body>
void inBlocks(std::size_t count, std::size_t size, const RunSettings& run, const char* stage, const Body& body)
{
	const std::size_t blocks = (count + size - 1) / size;
	const Progress reported = stage != nullptr ? run.progress : Progress();
	ProgressCounter progress(reported, stage != nullptr ? stage : "", blocks);
	parallelFor(blocks, run.threads,
				[&](std::size_t block)
				{
					for (std::size_t i = block * size; i < std::min(count, (block + 1) * size); ++i)
					{
						body(i);
					}
					progress.finishOne();
				});
}

// Calls visit(begin, end) for each run of consecutive items that are the same as its first.
template <class List, class Same, class Visit> void forRuns(const List& items, const Same& same, const Visit& visit)
{
	for (std::size_t begin = 0, end = 0; begin < items.size(); begin = end)
	{
		for (end = begin + 1; end < items.size() && same(items[begin], items[end]); ++end)
		{
		}
		visit(begin, end);
	}
}

} // namespace nook

namespace nook::detail
{

// Halves a convex, flat polygon along or across its longest edge until pieces are at most `longest_m` long in both directions and
// have at most `most_corners` ≥ 4 corners. The pieces cover the polygon; those without area are dropped.
std::vector<std::vector<glm::dvec3>> halvedPolygon(std::span<const glm::dvec3> corners, double longest_m, std::size_t most_corners);

// Upper bound of the number of pieces.
double halvesOf(std::span<const glm::dvec3> corners, double longest_m);

// Extents of a polygon along its longest edge and across it.
std::array<double, 2> extentsOf(std::span<const glm::dvec3> corners);

} // namespace nook::detail
