// SPDX-License-Identifier: GPL-3.0-or-later
// Ray-traced statistics of small pictures.
#pragma once

#include "testing.h"

#include "scene/camera.h"
#include "scene/tracer.h"

#include <glm/matrix.hpp>

namespace nook
{

// Rays through a small 4 : 3 picture.
inline int hitsPerCent(const Tracer& tracer, const LevelCamera& camera)
{
	const int width = 48;
	const int height = 36;
	const View view = viewOf(camera, width, height);
	const Projector projector(view.projection, width, height);
	const glm::dmat4 world_from_camera = glm::inverse(view.camera_from_world);
	int hits = 0;
	for (int i = 0; i < width * height; ++i)
	{
		const ViewLine line = projector.lineOf({i % width + 0.5, i / width + 0.5});
		const glm::dvec3 from = glm::dvec3(world_from_camera * glm::dvec4(line.at, 1.0));
		const glm::dvec3 along = glm::dvec3(world_from_camera * glm::dvec4(line.along, 0.0));
		hits += tracer.nearest(from, along, std::numeric_limits<double>::infinity()).hit ? 1 : 0;
	}
	return 100 * hits / (width * height);
}

} // namespace nook
