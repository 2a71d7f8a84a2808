// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the sample points of a volume that are in matter: by the geometry, or by a depth buffer alone.
#pragma once

#include "scene/gbuffer.h"
#include "scene/tracer.h"

#include <span>
#include <vector>

namespace nook
{

// Sets matter[i] to 1 if origin + offset i is inside a solid, else to 0. `origin` (world) is in the open. A point visible from
// `origin` is open; any other is inside if most of nine directions from it hit the back of a surface first (inside a solid all are
// backs; a single sheet has its back on one side). Masked surfaces have no inside.
void matterOfGeometry(const Tracer& tracer, glm::dvec3 origin, const Directions& offsets, std::span<float> matter);

// True if most of these nine directions hit a back first.
bool isInMatter(const Tracer& tracer, glm::dvec3 position);

// Treats the depth buffer as a piecewise planar surface: each pixel is a piece of the plane through its position with the normal
// reconstructed from surrounding depths. Everything behind it is matter.
class DepthMatter
{
public:
	DepthMatter() = default;
	DepthMatter(const GBuffer& gbuffer, const RunSettings& run);

	// Like matterOfGeometry, in view space. Points outside the picture are unknown and get the mean of the others (0 if there are
	// none).
	void sample(glm::dvec3 origin, const Directions& offsets, std::span<float> matter) const;

private:
	struct Plane
	{
		glm::dvec3 normal{0.0}; // faces the camera
		double offset = 0.0;    // matter is where normal · position is smaller
	};
	bool isMatter(glm::dvec3 position, glm::dvec2 pixel) const;

	std::vector<Plane> m_planes;
	std::vector<Projector> m_projector; // zero or one
	int m_width_px = 0;
	int m_height_px = 0;
};

} // namespace nook
