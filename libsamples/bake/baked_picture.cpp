// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/baked_picture.h"

#include "core/parallel.h"

#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <cassert>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr double kSameDepth = 1e-3; // relative depth: above the precision of 24-bit depth in a level, below visible contact

// Value of the side that was hit; NaN if a vertex has none.
float valueOf(const Level& level, const BakedValues& baked, const RayHit& hit)
{
	const glm::uvec3 t = level.triangles[hit.triangle];
	const std::vector<float>& values = hit.front ? baked.front : baked.back;
	const auto b = static_cast<float>(hit.barycentric.x);
	const auto c = static_cast<float>(hit.barycentric.y);
	return (1.0F - b - c) * values[t.x] + b * values[t.y] + c * values[t.z];
}

} // namespace

std::vector<uint8_t> alignStatic(GBuffer& fixed, const GBuffer& gbuffer)
{
	assert(fixed.depth.size() == gbuffer.depth.size());
	std::vector<uint8_t> same(gbuffer.depth.size(), 0);
	for (std::size_t i = 0; i < same.size(); ++i)
	{
		const auto here = static_cast<double>(gbuffer.depth[i]);
		const auto there = static_cast<double>(fixed.depth[i]);
		const double unsure = gbuffer.depth_error_m.empty() ? 0.0 : static_cast<double>(gbuffer.depth_error_m[i]);
		const bool sky = std::isinf(here) && std::isinf(there);
		if (sky || std::fabs(here - there) <= kSameDepth * here + 4.0 * unsure) // false if one is infinite
		{
			same[i] = 1;
			fixed.depth[i] = gbuffer.depth[i];
			fixed.normals[i] = gbuffer.normals[i];
		}
	}
	fixed.view_error_m = gbuffer.view_error_m;
	fixed.depth_error_m = gbuffer.depth_error_m;
	return same;
}

BakedPicture bakedPicture(const Tracer& tracer, const BakedValues& baked, const GBuffer& gbuffer, const RunSettings& run)
{
	const std::size_t count = gbuffer.depth.size();
	assert(gbuffer.normals.size() == count && baked.front.size() == tracer.level().positions.size());
	BakedPicture picture;
	picture.fixed = castGBuffer(tracer, gbuffer.view, gbuffer.width_px, gbuffer.height_px, NormalKind::geometric, run);
	picture.is_baked = alignStatic(picture.fixed, gbuffer);
	picture.values.assign(count, 0.0F);
	const Projector projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px);
	const glm::dmat4 world_from_camera = glm::inverse(gbuffer.view.camera_from_world);
	const glm::dmat3 turn_to_world(world_from_camera);
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	ProgressCounter progress(run.progress, "baked pixels", static_cast<std::size_t>(gbuffer.height_px));
	const auto row = [&](std::size_t y)
	{
		for (std::size_t i = y * width; i < (y + 1) * width; ++i)
		{
			if (picture.is_baked[i] == 0 || std::isinf(gbuffer.depth[i]))
			{
				picture.is_baked[i] = 0;
				continue;
			}
			const ViewLine line = projector.lineOf({static_cast<double>(i - y * width) + 0.5, static_cast<double>(y) + 0.5});
			const RayHit hit = tracer.nearest(glm::dvec3(world_from_camera * glm::dvec4(line.at, 1.0)), turn_to_world * line.along,
											  std::numeric_limits<double>::infinity());
			const float value = hit.hit ? valueOf(tracer.level(), baked, hit) : std::numeric_limits<float>::quiet_NaN();
			picture.is_baked[i] = std::isnan(value) ? 0 : 1;
			picture.values[i] = std::isnan(value) ? 0.0F : value;
		}
		progress.finishOne();
	};
	parallelFor(static_cast<std::size_t>(gbuffer.height_px), run.threads, row);
	return picture;
}

} // namespace nook
