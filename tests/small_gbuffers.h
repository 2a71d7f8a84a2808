// SPDX-License-Identifier: GPL-3.0-or-later
// Projections of every kind, and G-buffers from a formula.
#pragma once

#include "testing.h"

#include "scene/gbuffer.h"

#include <glm/matrix.hpp>

namespace nook
{

struct NamedProjection
{
	const char* name;
	glm::dmat4 matrix;
	ClipRange clip;
};

// OpenGL's, Direct3D's and reversed ones; finite, infinite, off-centre, parallel.
inline std::vector<NamedProjection> projections(double aspect)
{
	const glm::dmat4 finite = projectionOf({false, 1.2, 1.0, 0.1, 100.0}, aspect);
	const glm::dmat4 infinite = projectionOf({false, 1.2, 1.0, 0.1, std::numeric_limits<double>::infinity()}, aspect);
	const glm::dmat4 parallel = projectionOf({true, 1.0, 3.0, 0.1, 100.0}, aspect);
	glm::dmat4 direct = finite;
	direct[2][2] = -100.0 / (100.0 - 0.1);
	direct[3][2] = -100.0 * 0.1 / (100.0 - 0.1);
	glm::dmat4 reversed = infinite;
	reversed[2][2] = 0.0;
	reversed[3][2] = 0.1;
	glm::dmat4 reversed_finite = finite;
	reversed_finite[2][2] = 0.1 / (100.0 - 0.1);
	reversed_finite[3][2] = 100.0 * 0.1 / (100.0 - 0.1);
	glm::dmat4 shifted = finite;
	shifted[2][0] = 0.4;
	shifted[2][1] = -0.7;
	glm::dmat4 oblique = parallel;
	oblique[2][0] = 0.02;
	return {{"finite", finite, ClipRange::minus_one_to_one},         {"infinite", infinite, ClipRange::minus_one_to_one},
			{"off-centre", shifted, ClipRange::minus_one_to_one},    {"direct", direct, ClipRange::zero_to_one},
			{"reversed infinite", reversed, ClipRange::zero_to_one}, {"reversed finite", reversed_finite, ClipRange::zero_to_one},
			{"parallel", parallel, ClipRange::minus_one_to_one},     {"oblique parallel", oblique, ClipRange::minus_one_to_one}};
}

inline glm::dmat4 someView()
{
	return glm::inverse(worldFromCamera({3.0, 2.0, 5.0}, {0.5, 0.25, -1.0}));
}

using DepthOf = std::function<double(int x, int y, const ViewLine& line)>;

inline GBuffer made(int width, int height, const glm::dmat4& projection, const DepthOf& depth)
{
	GBuffer gbuffer;
	gbuffer.width_px = width;
	gbuffer.height_px = height;
	gbuffer.view = {someView(), projection};
	const Projector projector(projection, width, height);
	for (int y = 0; y < height; ++y)
	{
		for (int x = 0; x < width; ++x)
		{
			gbuffer.depth.push_back(static_cast<float>(depth(x, y, projector.lineOf({x + 0.5, y + 0.5}))));
		}
	}
	return gbuffer;
}

// The plane normal · p = offset.
inline DepthOf plane(const glm::dvec3& normal, double offset)
{
	return [=](int, int, const ViewLine& line)
	{
		const double depth = (offset - glm::dot(normal, line.at)) / glm::dot(normal, line.along);
		return depth > 0.0 ? depth : std::numeric_limits<double>::infinity();
	};
}

} // namespace nook
