// SPDX-License-Identifier: GPL-3.0-or-later
// Sample points of a volume → which of them are in matter: by the geometry, or by a depth buffer alone.
#pragma once

#include "scene/gbuffer.h"
#include "scene/tracer.h"

#include <span>
#include <vector>

namespace nook
{

// matter[i] becomes 1 where origin + offset i is inside a solid, else 0. `origin` (world) is in the open. A point that `origin`
// sees is open; any other is inside where most of nine directions from it meet the back of a surface first (a solid has only backs
// inside; a single sheet has its back on one side). Surfaces with a mask have no inside.
void matterOfGeometry(const Tracer& tracer, glm::dvec3 origin, const Directions& offsets, std::span<float> matter);

// Whether most of these nine directions meet a back first.
bool isInMatter(const Tracer& tracer, glm::dvec3 position);

// The depth buffer as a piecewise plane surface: every pixel is a piece of the plane through its position with the normal that the
// depths around it give. Matter is whatever lies behind.
class DepthMatter
{
public:
	DepthMatter() = default;
	DepthMatter(const GBuffer& gbuffer, const RunSettings& run);

	// As matterOfGeometry, in view space. Points outside the picture are unknown: they get the mean of the others (0 where
	// there is none).
	void sample(glm::dvec3 origin, const Directions& offsets, std::span<float> matter) const;

private:
	struct Plane
	{
		glm::dvec3 normal{0.0}; // faces the camera
		double offset = 0.0;    // matter is where normal · position is less
	};
	bool isMatter(glm::dvec3 position, glm::dvec2 pixel) const;

	std::vector<Plane> m_planes;
	std::vector<Projector> m_projector; // one, or none yet
	int m_width_px = 0;
	int m_height_px = 0;
};

} // namespace nook
