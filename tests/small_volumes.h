// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes of small levels, and a straightforward reference evaluation.
#pragma once

#include "testing.h"

#include "methods/volume_kernels.h"
#include "scene/builtin.h"
#include "scene/gbuffer.h"
#include "shade/aov.h"
#include "volume/packed.h"
#include "volume/volumes.h"

#include <glm/matrix.hpp>

namespace nook::test
{

using Corners = std::vector<glm::dvec3>;

inline Corners cornersOf(const Level& level, std::size_t triangle)
{
	const glm::uvec3& at = level.triangles[triangle];
	return {level.positions[at.x], level.positions[at.y], level.positions[at.z]};
}

// One polygon per triangle.
inline Occluders trianglesOf(const Level& level, bool two_sided = false)
{
	Occluders occluders;
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		const bool both = two_sided || level.material_list[level.materials[t]].two_sided;
		occluders.add({.triangle = static_cast<uint32_t>(t), .two_sided = both}, cornersOf(level, t));
	}
	return occluders;
}

inline VolumeSet setOf(const Occluders& occluders, double distance_m, bool exact_bounds = true)
{
	VolumeSet set;
	set.occluders = occluders;
	set.distance_m = distance_m;
	set.exact_bounds = exact_bounds;
	return set;
}

// One polygon per triangle with area, rounded to 16 bits.
inline VolumeSet volumesOf(const Level& level, double distance_m, std::size_t cluster, bool two_sided = false)
{
	VolumeSet set = setOf({}, distance_m); // the reference supports no other bounds
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		const Corners corners = cornersOf(level, t);
		if (glm::length(frontOf(corners)) >= 0.5)
		{
			set.occluders.add({.triangle = static_cast<uint32_t>(t), .alpha = t % 3 == 0 ? 0.5F : 1.0F, .two_sided = two_sided},
							  corners);
		}
	}
	clusterVolumes(set, {cluster}, {});
	return unpacked(packVolumes(set, {}, {}), set);
}

// Sum over all volumes at a receiver, without acceleration.
inline double sumAt(const VolumeSet& set, glm::dvec3 position, glm::dvec3 normal)
{
	double sum = 0.0;
	volume_kernels::Kernels kernels;
	std::vector<glm::vec3> corners;
	for (const Occluder& polygon : set.occluders.polygons)
	{
		const std::span<const glm::dvec3> all =
			std::span(set.occluders.corners).subspan(polygon.first_corner, polygon.corner_count);
		corners.clear();
		for (const glm::dvec3 corner : all)
		{
			corners.emplace_back(corner - position);
		}
		kernels.corners = corners;
		const auto delta = static_cast<float>(set.distance_m);
		const glm::vec3 front(frontOf(all));
		const float lift = kernels.nookLift(kernels.nookHeight(front), polygon.two_sided ? 1.0F : 0.0F, 1e-4F * delta,
											glm::dot(glm::vec3(normal), front));
		for (glm::vec3& corner : corners)
		{
			corner -= lift * front;
		}
		sum += static_cast<double>(kernels.nookVolume(static_cast<int>(all.size()), glm::vec3(normal), front, polygon.alpha,
													  polygon.two_sided ? 1.0F : 0.0F, kernels.nookHeight(front), delta,
													  glm::vec2(polygon.reach, polygon.side_reach), 1e-4F * delta));
	}
	return sum;
}

inline std::vector<float> visibilityOf(const GBuffer& gbuffer, const VolumeSet& set, bool compensate)
{
	const glm::dmat4 world_from_camera = glm::inverse(gbuffer.view.camera_from_world);
	const Projector projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px);
	std::vector<float> visibility(gbuffer.depth.size(), 1.0F);
	for (std::size_t i = 0; i < visibility.size(); ++i)
	{
		if (std::isfinite(gbuffer.depth[i]))
		{
			const auto width = static_cast<std::size_t>(gbuffer.width_px);
			const glm::dvec3 at = positionOf(gbuffer, projector, static_cast<int>(i % width), static_cast<int>(i / width));
			const double sum = sumAt(set, glm::dvec3(world_from_camera * glm::dvec4(at, 1.0)),
									 glm::dmat3(world_from_camera) * glm::dvec3(gbuffer.normals[i]));
			visibility[i] = static_cast<float>(1.0 - (compensate ? set.compensation.at(sum) : std::min(sum, 1.0)));
		}
	}
	return visibility;
}

} // namespace nook::test
