// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gbuffer.h"

#include "core/parallel.h"
#include "scene/ray_triangle.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec4.hpp>

#include <cassert>
#include <cmath>
#include <limits>

namespace nook
{

glm::dvec3 positionOf(const GBuffer& gbuffer, const Projector& projector, int x, int y)
{
	const auto depth = static_cast<double>(gbuffer.depth[gbuffer.index(x, y)]);
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

// Normals from depth: on each axis one difference, to the neighbour on the side where the surface continues.
//
// The choice of side follows Yuwen Wu, "Accurate Normal Reconstruction from Depth Buffer", 2019 (a note on the web): the side whose
// two neighbours, extrapolated linearly, come closest to the pixel. There are three differences. The extrapolation is linear in 1/w
// (in depth if w is constant), which on a plane is an affine function of the picture, so that planes are exact in perspective and
// parallel projections. A side also counts as good if its nearer neighbour alone is close, so that surfaces two pixels wide are
// detected. And if both sides are equally good up to rounding, the right or lower one is used. Kernel with the same result:
// methods/kernels/normals.glsl.

namespace
{

class Surface
{
public:
	Surface(const GBuffer& gbuffer, const RunSettings& run)
		: m_gbuffer(gbuffer), m_projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px),
		  m_affine(gbuffer.depth.size())
	{
		parallelFor(static_cast<std::size_t>(gbuffer.height_px), run.threads,
					[&](std::size_t y)
					{
						for (int x = 0; x < gbuffer.width_px; ++x)
						{
							const int row = static_cast<int>(y);
							const glm::dvec4 clip =
								gbuffer.view.projection * glm::dvec4(there(x, row) ? positionAt(x, row) : glm::dvec3(0.0), 1.0);
							const double depth = static_cast<double>(gbuffer.depth[m_gbuffer.index(x, row)]);
							m_affine[m_gbuffer.index(x, row)] = gbuffer.view.projection[2][3] == 0.0 ? depth : 1.0 / clip.w;
						}
					});
	}

	bool there(int x, int y) const
	{
		return x >= 0 && y >= 0 && x < m_gbuffer.width_px && y < m_gbuffer.height_px &&
			   std::isfinite(m_gbuffer.depth[m_gbuffer.index(x, y)]);
	}

	// Unit, facing the camera. Requires there(x, y).
	glm::dvec3 normalAt(int x, int y) const
	{
		const glm::dvec3 position = positionAt(x, y);
		const glm::dvec3 towards = -glm::normalize(m_projector.lineOf({x + 0.5, y + 0.5}).along);
		const glm::dvec3 right = along(x, y, 1, 0, position);
		const glm::dvec3 down = along(x, y, 0, 1, position);
		glm::dvec3 normal = glm::cross(down, right);
		const glm::dvec3 only = right + down; // one of them is 0
		if (glm::dot(normal, normal) == 0.0)
		{
			// With one direction or none: faces the camera as far as possible.
			const double square = glm::dot(only, only);
			normal = square > 0.0 ? towards - glm::dot(towards, only) / square * only : towards;
		}
		const double length = glm::length(normal);
		if (!(length > 0.0))
		{
			return towards;
		}
		normal /= length;
		return glm::dot(normal, towards) < 0.0 ? -normal : normal;
	}

private:
	glm::dvec3 positionAt(int x, int y) const
	{
		return positionOf(m_gbuffer, m_projector, x, y);
	}

	// How badly the side (dx, dy) continues to the pixel; requires the nearer neighbour.
	double misfit(int x, int y, int dx, int dy) const
	{
		const double here = m_affine[m_gbuffer.index(x, y)];
		const double near = m_affine[m_gbuffer.index(x + dx, y + dy)];
		const double step = std::fabs(near - here);
		if (!there(x + 2 * dx, y + 2 * dy))
		{
			return step;
		}
		return std::min(step, std::fabs(2.0 * near - m_affine[m_gbuffer.index(x + 2 * dx, y + 2 * dy)] - here));
	}

	// The surface's step in the positive direction of an axis; 0 if neither neighbour exists.
	glm::dvec3 along(int x, int y, int dx, int dy, const glm::dvec3& position) const
	{
		const bool after = there(x + dx, y + dy);
		const bool before = there(x - dx, y - dy);
		constexpr double kRounding = 2e-6; // several steps of the 32-bit floats that kernels compute with
		const double tie = kRounding * std::fabs(m_affine[m_gbuffer.index(x, y)]);
		if (after && (!before || misfit(x, y, dx, dy) <= misfit(x, y, -dx, -dy) + tie))
		{
			return positionAt(x + dx, y + dy) - position;
		}
		return before ? position - positionAt(x - dx, y - dy) : glm::dvec3(0.0);
	}

	const GBuffer& m_gbuffer;
	Projector m_projector;
	std::vector<double> m_affine; // 1/w or depth of every pixel; undefined for sky
};

} // namespace

void normalsFromDepth(GBuffer& gbuffer, const RunSettings& run)
{
	const Surface surface(gbuffer, run);
	std::vector<glm::vec3> normals(gbuffer.depth.size(), glm::vec3(0.0F));
	ProgressCounter progress(run.progress, "normals", static_cast<std::size_t>(gbuffer.height_px));
	parallelFor(static_cast<std::size_t>(gbuffer.height_px), run.threads,
				[&](std::size_t y)
				{
					for (int x = 0; x < gbuffer.width_px; ++x)
					{
						if (surface.there(x, static_cast<int>(y)))
						{
							normals[y * static_cast<std::size_t>(gbuffer.width_px) + static_cast<std::size_t>(x)] =
								glm::vec3(surface.normalAt(x, static_cast<int>(y)));
						}
					}
					progress.finishOne();
				});
	gbuffer.normals = std::move(normals);
}

} // namespace nook
