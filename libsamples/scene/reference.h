// SPDX-License-Identifier: GPL-3.0-or-later
// Ray-traced reference visibility, with standard error, at points of a level or pixels of a G-buffer.
#pragma once

#include "core/image.h"
#include "core/progress.h"
#include "scene/gbuffer.h"
#include "scene/tracer.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace nook
{

// The integral to estimate.
enum class ReferenceMeasure
{
	obscurance, // cosine-weighted rays over the hemisphere: 1 − (1/π) ∫ g(t) (n·ω) dω (ALC eq. 4 with eq. 3's 1/π)
	sphere,     // open fraction of the ball of that radius (VO §4)
	hemisphere, // open fraction of its half above the tangent plane (VO §4.4): an open flat surface reads 1
	box,        // open fraction of the box with that half side, aligned with the camera (SVO)
	bent,       // obscurance, and the mean open direction: ReferenceValue::bent
};

// True for rays over the hemisphere, false for samples in a volume.
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

// Definition of matter for the volumetric measures.
enum class MatterSource
{
	geometry, // inside solids, by the triangles' winding
	depth,    // behind the depth buffer
};

struct ReferenceSettings
{
	ReferenceMeasure measure = ReferenceMeasure::obscurance;
	Falloff falloff = Falloff::hard;
	MatterSource source = MatterSource::geometry; // for the volumetric measures
	double radius_m = 1.0;                        // > 0; may be infinite for hard and alchemy
	double falloff_u_m = 0.1;                     // alchemy's u, > 0
	int rays = 256;         // rays, or samples of the volume; 1 to kMaxSamples; the maximum if max_error is set
	double max_error = 0.0; // > 0: stop at a point once its standard error is at most this
	double lift_m = 0.0;    // ≥ 0: distance of points from the surface, besides rounding
	uint32_t seed = 1;
};

struct ReferencePoint
{
	glm::dvec3 position; // world, metres
	glm::dvec3 normal;   // world, unit
	double lift_m = 0.0; // bound on its distance from the surface due to rounding; rays start that much further along the normal
};

struct ReferenceValue
{
	double visibility = 1.0;
	double standard_error = 0.0;
	int rays = 0; // number used
	// With ReferenceMeasure::bent, unit: direction of (1/π) ∫ (1 − g(t)) ω (n·ω) dω (H. Landis, "Production-Ready Global
	// Illumination", 2002); the normal if nothing is open; world space for points, view space for pixels; 0 for sky.
	glm::vec3 bent{0.0F};
};

// Half angle in radians of the cone around the normal with the same cosine-weighted visibility, sin²α.
double coneAngle(double visibility);

// A value depends only on its point's index, the seed and the level. Not for MatterSource::depth or ReferenceMeasure::box.
std::vector<ReferenceValue> referenceAtPoints(const Tracer& tracer, std::span<const ReferencePoint> points,
											  const ReferenceSettings& settings, const RunSettings& run);

// Likewise for points created on demand, from any thread; a part creates only its own.
std::vector<ReferenceValue> referenceAtPoints(const Tracer& tracer, std::size_t count,
											  const std::function<ReferencePoint(std::size_t i)>& point,
											  const ReferenceSettings& settings, const RunSettings& run);

// Visibilities within each radius instead of the settings', one list per radius, from the same rays: the nearest surface within
// the greatest radius decides for all. For obscurance by linear falloff without max_error; the values of referenceAtPoints().
std::vector<std::vector<double>> visibilitiesWithin(const Tracer& tracer, std::span<const ReferencePoint> points,
													const ReferenceSettings& settings, std::span<const double> radii_m,
													const RunSettings& run);

// Every pixel; sky has visibility 1 and uses no rays. `tracer` may be null for MatterSource::depth and if parts have traced
// everything; otherwise its level must be the G-buffer's. Requires normals. Throws like Projector.
std::vector<ReferenceValue> referenceOfGBuffer(const Tracer* tracer, const GBuffer& gbuffer, const ReferenceSettings& settings,
											   const RunSettings& run);

// Region that the rays of referenceOfGBuffer() can reach, for constructing its tracer; none if rays are infinite, or if volumes
// need surfaces at any distance. The level must have triangles.
std::optional<Vicinity> reachOf(const Level& level, const GBuffer& gbuffer, const ReferenceSettings& settings);

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

	// Like matterOfGeometry, in view space. Points outside the picture get the mean of the others (0 if there are none).
	void sample(glm::dvec3 origin, const Directions& offsets, std::span<float> matter) const;

private:
	struct Plane
	{
		glm::dvec3 normal{0.0}; // faces the camera
		double offset = 0.0;    // matter is where normal · position is smaller
	};
	std::vector<Plane> m_planes;
	std::vector<Projector> m_projector; // zero or one
	int m_width_px = 0;
	int m_height_px = 0;
};

// A point from another program; none if a position is further than kFarthest_m or not a number, or the normal has no direction.
// Positions are assumed to be rounded to 32 bits: rays start that much above them.
std::optional<ReferencePoint> pointOf(glm::dvec3 position, glm::dvec3 normal);

// Comma-separated rows x,y,z,nx,ny,nz (position in metres, normal of any length), after an optional header with these names and
// comments (#). Throws Error: file; invalid_input with the line.
std::vector<ReferencePoint> readPoints(const std::string& path);

// Channels `visibility` and `standard_error`, 32-bit floats.
std::string visibilityExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);

// Additionally `bent.X`, `bent.Y`, `bent.Z` (unit, view space, 0 for sky) and `cone_angle` (coneAngle, radians).
std::string bentExr(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);

// For a method: channels `bent.X`, `bent.Y`, `bent.Z`, `cone_angle`, `visibility`. Both lists have equal sizes.
std::string bentExr(int width_px, int height_px, std::span<const glm::vec3> bent, std::span<const float> visibility,
					const Notes& notes);

// Bent normals as colours: 127.5 + 127.5 times each component; sky is black.
std::string bentPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);
std::string bentPng(int width_px, int height_px, std::span<const glm::vec3> bent, const Notes& notes);

// Header visibility,standard_error,rays,bx,by,bz,cone_angle and one row per point; bent normals in world space.
std::string bentCsv(std::span<const ReferenceValue> values);

// Channel `visibility` only.
std::string visibilityExr(int width_px, int height_px, std::span<const float> visibility, const Notes& notes);

// Visibility as 8-bit gray: black 0, white 1, linear.
std::string visibilityPng(int width_px, int height_px, std::span<const ReferenceValue> values, const Notes& notes);
std::string visibilityPng(int width_px, int height_px, std::span<const float> visibility, const Notes& notes);

// Header visibility,standard_error,rays and one row per point, in the order of the points.
std::string visibilityCsv(std::span<const ReferenceValue> values);

} // namespace nook
