// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the triangle sides that a camera may see: outside solids, and visible from boxes that contain the cameras.
#pragma once

#include "core/progress.h"
#include "core/random.h"
#include "scene/camera.h"
#include "scene/reference.h"
#include "scene/tracer.h"
#include "volume/evaluate.h"
#include "volume/volumes.h"

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace nook
{

// Bits of ReceiverSides::seen.
inline constexpr uint8_t kFrontSeen = 1;
inline constexpr uint8_t kBackSeen = 2;

// A uniformly distributed direction.
glm::dvec3 directionOf(Random& random);

// Maps a point of the unit square, folded over its diagonal, to the triangle; preserves uniformity.
glm::dvec3 pointOf(const std::array<glm::dvec3, 3>& triangle, double u, double v);

// The nearest surface from a point along a direction, within `reach` times the direction's length, with the normal of the side that
// is hit.
std::optional<ReferencePoint> surfaceAlong(const Tracer& tracer, glm::dvec3 from, glm::dvec3 along, double reach);

class Eye
{
public:
	// Keeps a reference to the tracer. The picture's size is in pixels.
	Eye(const Tracer& tracer, const LevelCamera& camera, int width_px, int height_px);

	// Position in pixels from the upper left corner. The result has the normal of the visible side; none for the sky.
	std::optional<ReferencePoint> at(double x, double y) const;

private:
	const Tracer& m_tracer;
	View m_view;
	Projector m_projector;
	glm::dmat4 m_world_from_camera;
};

// Six boxes around a level, strays left out: one beyond each side of its bounds, three times as thick as the level's longest side.
// They hold a point of every ray that comes from farther away, so they stand for cameras anywhere outside.
std::array<Bounds, 6> boxesAround(const Level& level);

struct SideSettings
{
	bool inside = true;            // exclude sides inside solids (sampled)
	std::span<const Bounds> boxes; // that contain all cameras; empty: anywhere
	int seen_rays = 64;            // rays from the boxes to a triangle before it counts as invisible, ≥ 1
	bool backs = false;            // include the backs of one-sided materials although hardly visible: the level is inside out
	std::span<const uint8_t> receivers{}; // 1 for each triangle that counts as visible at all; empty: all
};

// Visible sides of each material, from rays in all directions from the level's cameras, or from automatic ones.
struct MaterialSides
{
	std::vector<uint8_t> oriented; // per material: almost no ray hits its backs, so they are inside solids or absent
	std::vector<uint64_t> fronts;  // per material: rays that hit its front
	std::vector<uint64_t> backs;
};
MaterialSides materialSides(const Tracer& tracer, const RunSettings& run);

struct ReceiverSides
{
	MaterialSides materials;
	std::vector<uint8_t> there;   // per triangle: 1 if it has area and is not fully transparent
	std::vector<uint8_t> outside; // per triangle: sides that are not inside solids
	std::vector<uint8_t> seen;    // per triangle: those of these sides that are visible from the boxes
	uint64_t inside_sides = 0;
	uint64_t unseen_sides = 0;
	uint64_t check_rays = 0;   // rays of an independent sample from the boxes
	uint64_t check_missed = 0; // rays that hit a side considered invisible, which then counts as visible
};

ReceiverSides receiverSides(const Tracer& tracer, const SideSettings& settings, const RunSettings& run);

// Per triangle 1 if it is opaque and the backs of its piece of surface (connected by vertices) can go: but for half a percent of
// the area no camera sees them, and they see no visible side within δ. So is the back of a cave, of a ground, of a scanned surface.
// Cameras are in the boxes; empty: anywhere, but backs are not seen if people who stand in the level see fronts of the piece
// instead. Sampled, at 32 rays a triangle or more.
std::vector<uint8_t> idleBacks(const Tracer& tracer, double distance_m, std::span<const Bounds> boxes, const RunSettings& run);

// Per triangle 1 if rays from the boxes, from the level's cameras or from automatic ones hit backs of its piece of surface, in at
// least half a percent of the hits. Then someone looks into it, although it may be closed.
std::vector<uint8_t> seenBacks(const Tracer& tracer, std::span<const Bounds> boxes, const RunSettings& run);

// True if a ray from a point, lifted off its surface along the unit `normal`, first hits the sky, a front, or a back of a material
// that is not oriented. Uses 8 directions of the hemisphere, rotated by `turn`. Inside a solid, rays hit only backs.
bool isOpen(const Tracer& tracer, const MaterialSides& materials, glm::dvec3 point, glm::dvec3 normal, uint32_t turn);

// Likewise for a convex polygon, at 4 to 64 points of it, depending on its size relative to `step_m`.
bool isOpen(const Tracer& tracer, const MaterialSides& materials, std::span<const glm::dvec3> corners, glm::dvec3 normal,
			double step_m, uint32_t turn);

// True if one of these rays hits a side that counts as visible within `reach_m`.
bool seesReceiver(const Tracer& tracer, const ReceiverSides& sides, std::span<const glm::dvec3> corners, glm::dvec3 normal,
				  double step_m, double reach_m, uint32_t turn);

struct ReceiverSettings
{
	int views = 4;           // automatic cameras
	int per_view = 1000;     // points per view, on a grid
	int by_area = 4000;      // points on the visible sides of the triangles, uniform by area
	int near_creases = 2000; // points next to triangles' edges, a hundredth of δ away
	uint32_t seed = 1;
	std::span<const uint8_t> idle_backs{}; // 1 for each triangle whose back is no receiver; empty: none
};

// Surface points that can be seen from outside solids, with the triangle's normal on that side.
std::vector<ReferencePoint> sampleReceivers(const Tracer& tracer, double distance_m, const ReceiverSettings& settings,
											const RunSettings& run);

struct VerifyResult
{
	std::size_t receivers = 0;
	double greatest = 0.0;             // |sum of all volumes − sum of the kept ones|, before compensation
	double greatest_compensated = 0.0; // likewise for the drawn values, after `kept`'s curve
	double mean = 0.0;
	double mean_compensated = 0.0;
	glm::dvec3 worst_position{0.0}; // where `greatest` occurs
};

// Order of points that keeps neighbours close together.
std::vector<uint32_t> nearOrder(std::span<const glm::vec3> points);
std::vector<uint32_t> nearOrder(std::span<const ReferencePoint> points);

// Sums of volumes at points.
std::vector<double> sumsAt(const VolumeEvaluator& evaluator, std::span<const ReferencePoint> points, const RunSettings& run,
						   bool roughly = false, double enough = std::numeric_limits<double>::infinity());
std::vector<double> sumsAt(const VolumeSet& volumes, std::span<const ReferencePoint> points, const RunSettings& run);

VerifyResult verifyVolumes(const VolumeSet& all, const VolumeSet& kept, std::span<const ReferencePoint> receivers,
						   const RunSettings& run);

// Returns the area of a convex polygon.
double polygonArea(std::span<const glm::dvec3> corners);

} // namespace nook
