// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/eye.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <limits>

namespace nook
{

Eye::Eye(const Tracer& tracer, const LevelCamera& camera, int width_px, int height_px)
	: m_tracer(tracer), m_view(viewOf(camera, width_px, height_px)), m_projector(m_view.projection, width_px, height_px),
	  m_world_from_camera(glm::inverse(m_view.camera_from_world))
{
}

std::optional<ReferencePoint> Eye::at(double x, double y) const
{
	const ViewLine line = m_projector.lineOf({x, y});
	return surfaceAlong(m_tracer, glm::dvec3(m_world_from_camera * glm::dvec4(line.at, 1.0)),
						glm::dmat3(m_world_from_camera) * line.along, std::numeric_limits<double>::infinity());
}

std::optional<ReferencePoint> surfaceAlong(const Tracer& tracer, glm::dvec3 from, glm::dvec3 along, double reach)
{
	const RayHit hit = tracer.nearest(from, along, reach);
	if (!hit.hit)
	{
		return std::nullopt;
	}
	const Level& level = tracer.level();
	const glm::uvec3 corner = level.triangles[hit.triangle];
	const glm::dvec3 a = level.positions[corner.x];
	const glm::dvec3 across = glm::cross(level.positions[corner.y] - a, level.positions[corner.z] - a);
	const double area = glm::length(across);
	if (!(area > 0.0))
	{
		return std::nullopt;
	}
	return ReferencePoint{from + hit.distance * along, across * ((hit.front ? 1.0 : -1.0) / area), 0.0};
}

} // namespace nook
