// SPDX-License-Identifier: GPL-3.0-or-later
// Bakes visibility at a level's vertices, for renderers that interpolate it over triangles.
#pragma once

#include "core/progress.h"
#include "scene/gbuffer.h"
#include "scene/level.h"
#include "scene/level_glb.h"
#include "scene/reference.h"
#include "scene/tracer.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace nook
{

struct AssetEstimate;
struct LevelFacts;

// Rays per point if several points share a vertex's rays: enough for Embree's streams and for a standard error. For a fixed number
// of rays, more points with fewer rays each give a better fit.
inline constexpr int kRaysOfPoint = 32;

enum class BakeFit
{
	surface, // least-squares fit of the interpolated values over the surface
	points,  // values at the vertices themselves, as most programs bake
};

// Treatment of two-sided materials.
enum class BakeSides
{
	separate, // one value per side of a vertex
	mean,     // one value for both sides
};

struct BakeSettings
{
	double radius_m = 1.0; // > 0; as in ReferenceSettings
	Falloff falloff = Falloff::hard;
	double falloff_u_m = 0.1;
	int rays = 256; // per vertex, 1 to kMaxSamples; the fit distributes them over points of the surface
	uint32_t seed = 1;
	BakeFit fit = BakeFit::surface;
	NormalKind normals = NormalKind::geometric; // centre of the hemisphere of rays; not from_depth
	double max_error = 0.0;                     // > 0, with BakeFit::surface: subdivide triangles until their error is at most this
	std::size_t max_vertices = 2'000'000;       // limit for the subdivision
	double few = 0.0; // [0, 1): stop earlier if less than this fraction of the triangles could be split further
	BakeSides sides = BakeSides::separate;
	bool bent = false;                // also bake bent normals (ReferenceMeasure::bent)
	const Level* receivers = nullptr; // what gets values: a part of the tracer's level, or with cage_m another; null: all of it
	// > 0: the tracer's level is the detailed one that `receivers` stands for. Rays of a point start where a line along its smooth
	// normal first meets that, from this far outside to as far inside; at the point itself if it does not.
	double cage_m = 0.0;

	// Visibility that another method draws at a point with a unit normal: the bake then stores the difference from it, −1 to 1.
	// Requires BakeFit::surface without bent normals. Called from any thread.
	std::function<std::vector<double>(std::span<const ReferencePoint>)> base{};
};

// Errors of the interpolated values against rays at new points of the surface.
struct BakeCheck
{
	std::size_t points = 0; // without those inside matter
	std::size_t buried = 0;
	std::size_t shut = 0; // points in gaps where hardly any ray escapes
	std::size_t rays = 0;
	std::size_t missed = 0;      // points that met no detailed surface (BakeSettings::cage_m)
	double rmse = 0.0;           // includes the rays' own standard error
	double rmse_seen = 0.0;      // without points in gaps
	double bias = 0.0;           // mean of bake − rays
	double standard_error = 0.0; // root mean square of the points' standard errors
	double rmse_without = 0.0;   // of `base` alone, without the bake
	double angle_rad = 0.0;      // with bent normals: mean angle to the rays' bent normals
};

struct VertexBake
{
	std::vector<float> visibility;    // one per vertex of the level, in [0, 1]; with `base` the difference
	std::vector<float> back;          // the vertices' other side; empty without two-sided materials
	std::vector<glm::vec3> bent;      // with BakeSettings::bent: unit, world space
	std::vector<glm::vec3> bent_back; // for `back`
	std::size_t unknowns = 0;         // number of values; vertices with equal position and normal share one
	std::size_t points = 0;           // number of points where rays were traced
	std::size_t buried = 0;           // of the points that decide a value: inside matter, with almost no weight
	std::size_t shut = 0;             // of the others: in gaps where hardly any ray escapes, also with almost no weight
	std::size_t rays = 0;
	double standard_error = 0.0; // root mean square over the values; the part due to the rays' noise

	// Results with max_error.
	std::optional<Level> refined; // the level that the values belong to, if it was subdivided
	LevelSplit split;             // how that was made
	std::size_t above = 0;        // triangles whose error still exceeds it
	double area_above_m2 = 0.0;   // their area
	bool capped = false;          // stopped by max_vertices
};

// Same bytes for any thread count. Progress stages "rays" and "fit", repeated alternately with max_error.
VertexBake bakeVertices(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run);

// Checks at `points` points, uniform by area, with 1024 rays each. Progress stage "check".
BakeCheck checkBake(const Tracer& tracer, const Level& baked, const VertexBake& bake, const BakeSettings& settings,
					std::size_t points, const RunSettings& run);

// Flips each triangle of a two-sided material whose normal opposes that of its neighbours, weighted by area, at all three corners;
// otherwise its front would share values with adjacent backs. The picture is unchanged. Returns the number of flipped triangles;
// the same for any thread count.
std::size_t alignSheets(Level& level, int threads);

// Turns them back, with their values. `turned`: 1 for each triangle that was flipped before the bake; empty: none.
void turnBack(Level& level, VertexBake& bake, std::span<const uint8_t> turned);

// True for a glTF file whose level is not a cell of another: it can take values itself.
bool takesValues(const std::string& path, const Level& level);

// True if, of nine directions over the hemisphere about `normal` (unit), at least seven more meet the back of a surface first than
// meet a front: under a box that stands on a floor, or in a wall that intersects another. `origin` is off its own surface. Masked
// surfaces have no inside.
bool isBuried(const Tracer& tracer, glm::dvec3 origin, glm::dvec3 normal);

struct BakedPicture
{
	std::vector<float> values;     // where the pixel shows the baked surface; 0 elsewhere
	std::vector<uint8_t> is_baked; // 1: shows the baked surface; 0: something else, or sky
	GBuffer fixed;                 // depth and normals of the baked level; the G-buffer's own where they agree
};

// `tracer` holds the file's level. A pixel shows the baked surface if both depths agree within 0.1 % plus the G-buffer's own
// uncertainty. Throws like Projector. Progress stage "baked pixels".
BakedPicture bakedPicture(const Tracer& tracer, const BakedValues& baked, const GBuffer& gbuffer, const RunSettings& run);

// Where `fixed` shows the same surface as `gbuffer` (by that rule), copies its depth and normal exactly; returns 1 for such pixels.
std::vector<uint8_t> alignStatic(GBuffer& fixed, const GBuffer& gbuffer);

// Estimates what `nook bake` adds to a level at the suggested distance with 256 rays per vertex, its default.
AssetEstimate bakeEstimate(const Level& level, const LevelFacts& facts);

} // namespace nook
