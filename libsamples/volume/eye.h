// SPDX-License-Identifier: GPL-3.0-or-later
// A camera and a place of its picture → the surface that is seen there.
#pragma once

#include "scene/camera.h"
#include "scene/reference.h"
#include "scene/tracer.h"

#include <glm/mat4x4.hpp>

#include <optional>

namespace nook
{

// The nearest surface from a point along a direction, no further than `reach` lengths of it, with the normal of the triangle's side
// that is met.
std::optional<ReferencePoint> surfaceAlong(const Tracer& tracer, glm::dvec3 from, glm::dvec3 along, double reach);

class Eye
{
public:
	// Keeps a reference to the tracer. The picture's size in pixels.
	Eye(const Tracer& tracer, const LevelCamera& camera, int width_px, int height_px);

	// Pixels from the upper left corner. With the normal of the triangle's side that is seen; none for the sky.
	std::optional<ReferencePoint> at(double x, double y) const;

private:
	const Tracer& m_tracer;
	View m_view;
	Projector m_projector;
	glm::dmat4 m_world_from_camera;
};

} // namespace nook
