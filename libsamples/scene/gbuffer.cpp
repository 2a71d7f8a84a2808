// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gbuffer.h"

#include "core/parallel.h"
#include "scene/ray_triangle.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cassert>
#include <cmath>
#include <limits>

namespace nook
{

glm::dvec3 positionOf(const GBuffer& gbuffer, const Projector& projector, int x, int y)
{
	const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(gbuffer.width_px) + static_cast<std::size_t>(x);
	const auto depth = static_cast<double>(gbuffer.depth[pixel]);
	assert(std::isfinite(depth));
	const ViewLine line = projector.lineOf({x + 0.5, y + 0.5});
	return line.at + depth * line.along;
}

GBuffer castGBuffer(const Tracer& tracer, const View& view, int width_px, int height_px, NormalKind normals, const RunSettings& run)
{
	assert(width_px >= 1 && height_px >= 1);
	const Projector projector(view.projection, width_px, height_px);
	const glm::dmat4 world_from_camera = glm::inverse(view.camera_from_world);
	const glm::dmat3 turn_to_world(world_from_camera);
	const glm::dmat3 turn_to_camera(view.camera_from_world);
	const auto width = static_cast<std::size_t>(width_px);
	GBuffer gbuffer{width_px, height_px, view, 0.0, {}, {}, {}};
	gbuffer.depth.assign(width * static_cast<std::size_t>(height_px), std::numeric_limits<float>::infinity());
	gbuffer.normals.assign(gbuffer.depth.size(), glm::vec3(0.0F));
	ProgressCounter progress(run.progress, "depth", static_cast<std::size_t>(height_px));
	const auto row = [&](std::size_t y)
	{
		for (std::size_t x = 0; x < width; ++x)
		{
			const ViewLine line = projector.lineOf({static_cast<double>(x) + 0.5, static_cast<double>(y) + 0.5});
			const glm::dvec3 eye(world_from_camera * glm::dvec4(line.at, 1.0));
			const glm::dvec3 along = turn_to_world * line.along; // advances one metre of depth
			const RayHit hit = tracer.nearest(eye, along, std::numeric_limits<double>::infinity());
			if (hit.hit && hit.distance > 0.0)
			{
				const glm::dvec3 normal = normals == NormalKind::interpolated
											  ? interpolatedNormal(tracer.level(), hit.triangle, hit.barycentric)
											  : geometricNormal(tracer.level(), hit.triangle);
				gbuffer.depth[y * width + x] = static_cast<float>(hit.distance);
				gbuffer.normals[y * width + x] = glm::vec3(glm::normalize(turn_to_camera * (hit.front ? normal : -normal)));
			}
		}
		progress.finishOne();
	};
	parallelFor(static_cast<std::size_t>(height_px), run.threads, row);
	if (normals == NormalKind::from_depth)
	{
		normalsFromDepth(gbuffer);
	}
	return gbuffer;
}

} // namespace nook
