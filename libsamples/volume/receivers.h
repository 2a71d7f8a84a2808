// SPDX-License-Identifier: GPL-3.0-or-later
// A level → the sides of its triangles that a camera may see: outside solids, and in sight of boxes in which the cameras are.
#pragma once

#include "core/progress.h"
#include "core/random.h"
#include "scene/tracer.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// Bits of ReceiverSides::seen.
inline constexpr uint8_t kFrontSeen = 1;
inline constexpr uint8_t kBackSeen = 2;

// A random one, of equal chance over the sphere.
glm::dvec3 directionOf(Random& random);

struct SideSettings
{
	bool inside = true;            // leaves out sides within solids (sampled)
	std::span<const Bounds> boxes; // of cameras; none: anywhere
	int seen_rays = 64;            // from the boxes to a triangle before it counts as out of sight, ≥ 1
	bool backs = false;            // backs of materials of one side count, though hardly any is seen: the level is inside out
};

// What of each material is seen: by rays in all directions from the eyes of the level's cameras, or of automatic ones.
struct MaterialSides
{
	std::vector<uint8_t> oriented; // one a material: hardly a ray meets its backs, so that these are within solids, or nowhere
	std::vector<uint64_t> fronts;  // rays that met its front, one a material
	std::vector<uint64_t> backs;
};
MaterialSides materialSides(const Tracer& tracer, const RunSettings& run);

struct ReceiverSides
{
	MaterialSides materials;
	std::vector<uint8_t> there;   // one a triangle: 1 where it has an area and lets not all light through
	std::vector<uint8_t> outside; // one a triangle: its sides that are not within solids
	std::vector<uint8_t> seen;    // one a triangle: of those, its sides in sight of the boxes
	uint64_t inside_sides = 0;
	uint64_t unseen_sides = 0;
	uint64_t check_rays = 0;   // of an independent sample from the boxes
	uint64_t check_missed = 0; // of those, met a side that was taken for unseen; these sides count as seen from then on
};

ReceiverSides receiverSides(const Tracer& tracer, const SideSettings& settings, const RunSettings& run);

// True where a ray from a point, lifted off its surface along the unit `normal`, meets the sky, a front, or a back of a material
// that is not oriented first: 8 directions of that hemisphere, turned by `turn`. A point within a solid meets nothing but backs.
bool isOpen(const Tracer& tracer, const MaterialSides& materials, glm::dvec3 point, glm::dvec3 normal, uint32_t turn);

// The same of a convex polygon: several points of it, more the larger it is against `step_m`; 4 to 64.
bool isOpen(const Tracer& tracer, const MaterialSides& materials, std::span<const glm::dvec3> corners, glm::dvec3 normal,
			double step_m, uint32_t turn);

// True where one of such rays meets a side that counts as seen, no further away than `reach_m`.
bool seesReceiver(const Tracer& tracer, const ReceiverSides& sides, std::span<const glm::dvec3> corners, glm::dvec3 normal,
				  double step_m, double reach_m, uint32_t turn);

} // namespace nook
