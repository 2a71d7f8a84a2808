// SPDX-License-Identifier: GPL-3.0-or-later
// Points of a level, or pixels of a G-buffer → reference visibility with its standard error.
#pragma once

#include "core/progress.h"
#include "scene/gbuffer.h"
#include "scene/tracer.h"
#include "scene/vicinity.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace nook
{

// What is integrated.
enum class ReferenceMeasure
{
	obscurance, // rays over the hemisphere, cosine-weighted: 1 − (1/π) ∫ g(t) (n·ω) dω (ALC eq. 4 with eq. 3's 1/π)
	sphere,     // open share of the ball of that radius (VO §4)
	hemisphere, // open share of its half above the tangent plane (VO §4.4): an open flat surface reads 1
	box,        // open share of the box of that half side, aligned with the camera (SVO)
	bent,       // obscurance, and the mean direction of what is open: ReferenceValue::bent
};

// True where rays go out over the hemisphere, false where samples fill a volume.
inline bool isByRays(ReferenceMeasure measure)
{
	return measure == ReferenceMeasure::obscurance || measure == ReferenceMeasure::bent;
}

// Weight g(t) of a surface at distance t < radius.
enum class Falloff
{
	hard,    // 1
	linear,  // 1 − t/radius (AOV's ray tracer)
	alchemy, // u·t / max(u, t)² (ALC §2)
};

// Where matter is, for the volumetric measures.
enum class MatterSource
{
	geometry, // inside solids, as the triangles' winding says
	depth,    // behind the depth buffer
};

struct ReferenceSettings
{
	ReferenceMeasure measure = ReferenceMeasure::obscurance;
	Falloff falloff = Falloff::hard;
	MatterSource source = MatterSource::geometry; // of the volumetric measures
	double radius_m = 1.0;                        // > 0; may be infinite for hard and alchemy
	double falloff_u_m = 0.1;                     // alchemy's u, > 0
	int rays = 256;                               // or samples of the volume; 1 to kMaxSamples; the most where max_error is set
	double max_error = 0.0;                       // > 0: a point is done once its standard error is at most this
	double lift_m = 0.0;                          // ≥ 0: how far points may be off the surface beside rounding
	uint32_t seed = 1;
};

struct ReferencePoint
{
	glm::dvec3 position; // world, metres
	glm::dvec3 normal;   // world, unit
	double lift_m = 0.0; // how far `position` may be off its surface by rounding; rays begin that much further along the normal
};

struct ReferenceValue
{
	double visibility = 1.0;
	double standard_error = 0.0;
	int rays = 0;         // spent
	glm::vec3 bent{0.0F}; // with ReferenceMeasure::bent, unit: direction of (1/π) ∫ (1 − g(t)) ω (n·ω) dω (H. Landis,
						  // "Production-Ready Global Illumination", 2002); the normal where nothing is open; of points in world
						  // space, of pixels in view space; 0 for sky
};

// Half angle, radians, of the cone around the normal that sees as much, cosine-weighted: sin²α is its visibility.
double coneAngle(double visibility);

// Every point by itself: its value depends on its place in the list, the seed and the level, not on threads or other points.
// Not for MatterSource::depth or ReferenceMeasure::box.
std::vector<ReferenceValue> referenceAtPoints(const Tracer& tracer, std::span<const ReferencePoint> points,
											  const ReferenceSettings& settings, const RunSettings& run);

// The same for points that are made when they are asked, from any thread: a part makes its own alone.
std::vector<ReferenceValue> referenceAtPoints(const Tracer& tracer, std::size_t count,
											  const std::function<ReferencePoint(std::size_t i)>& point,
											  const ReferenceSettings& settings, const RunSettings& run);

// Every pixel; sky is open: visibility 1, no rays. `tracer` may be null for MatterSource::depth and where parts have traced
// all, else the level must be that of the G-buffer. Requires normals. Throws as Projector.
std::vector<ReferenceValue> referenceOfGBuffer(const Tracer* tracer, const GBuffer& gbuffer, const ReferenceSettings& settings,
											   const RunSettings& run);

// What the rays of referenceOfGBuffer() can meet, for the tracer that it takes; none where they have no end, or where volumes ask
// for surfaces at any distance. The level must have triangles.
std::optional<Vicinity> reachOf(const Level& level, const GBuffer& gbuffer, const ReferenceSettings& settings);

} // namespace nook
