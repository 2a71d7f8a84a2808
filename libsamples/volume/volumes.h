// SPDX-License-Identifier: GPL-3.0-or-later
// Ambient occlusion volumes of a level: the polygons that block light, how far they reach, and how they are grouped for drawing.
//
// This work is based on: Morgan McGuire, Ambient Occlusion Volumes, 2010 (AOV).
#pragma once

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

inline constexpr std::size_t kMaxOccluderCorners = 16; // of one polygon; larger ones are cut

// A convex, planar polygon. Its front is the side from which its corners run counter-clockwise.
struct Occluder
{
	uint32_t first_corner = 0; // of Occluders::corners
	uint32_t corner_count = 3; // 3 to kMaxOccluderCorners
	uint32_t triangle = 0;     // the lowest of the level's triangles that it is made of
	float alpha = 1.0F;        // ᾱ of AOV eq. 5, in (0, 1]
	bool two_sided = false;    // darkens what lies before its back, too
	float reach = 1.0F;        // in (0, 1]: what is more than this share of δ above it gets nothing
	float side_reach = 1.0F;   // in (0, reach]: the same of what is beyond an edge
};

struct Occluders
{
	std::vector<glm::dvec3> corners; // world space, metres; those of a polygon are consecutive, no two of them equal
	std::vector<Occluder> polygons;

	std::span<const glm::dvec3> cornersOf(const Occluder& polygon) const
	{
		return std::span(corners).subspan(polygon.first_corner, polygon.corner_count);
	}
};

// Sum of all volumes' occlusion at a receiver → its occlusion (AOV §5.4). Linear between equidistant knots from 0 to `range`,
// constant beyond; not decreasing, in [0, 1].
struct Compensation
{
	double range = 1.0;                         // > 0
	std::array<double, 33> occlusion = paper(); // at range · i / 32

	double at(double sum) const;

	// The curve of AOV's figure 7, which it recommends for any level: x − x²/4.
	static std::array<double, 33> paper();
};

// Consecutive polygons that lie close together: what is culled as a whole.
struct VolumeCluster
{
	uint32_t first_polygon = 0;
	uint32_t polygon_count = 0;
	glm::dvec3 least{0.0}; // box of all points that its volumes reach, world space
	glm::dvec3 most{0.0};
};

struct VolumeSet
{
	Occluders occluders;         // in drawing order: cluster by cluster
	double distance_m = 1.0;     // δ of AOV: how far a volume reaches, > 0
	double ray_distance_m = 0.0; // radius of the reference with linear falloff that it stands for
	double plane_error_m = 0.0;  // surfaces may be this far from the planes of their polygons (16-bit corners): receivers no
								 // further from a plane get nothing from its polygon
	bool exact_bounds = false;   // volumes hold every point with a falloff > 0 (else corners move by 2δ at most)
	Compensation compensation;
	std::vector<VolumeCluster> clusters; // cover the polygons in order, without gaps
};

} // namespace nook
