// SPDX-License-Identifier: GPL-3.0-or-later
// A level → visibility at its vertices, for programs that interpolate it over triangles.
#pragma once

#include "core/progress.h"
#include "scene/gbuffer.h"
#include "scene/reference.h"
#include "scene/tracer.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace nook
{

// Rays of a point where several points share a vertex's: enough for Embree's streams and for a standard error. More points of fewer
// rays are the better fit for as many rays in all.
inline constexpr int kRaysOfPoint = 32;

enum class BakeFit
{
	surface, // what is nearest to the surface, interpolated: least squares at points of the triangles
	points,  // the value at the vertex itself, as most programs bake
};

// What is baked of a material with two sides.
enum class BakeSides
{
	separate, // a value for each side of a vertex
	mean,     // one for both
};

struct BakeSettings
{
	double radius_m = 1.0; // > 0; as ReferenceSettings has them
	Falloff falloff = Falloff::hard;
	double falloff_u_m = 0.1;
	int rays = 256; // a vertex, 1 to kMaxSamples; least squares share them out over points of the surface
	uint32_t seed = 1;
	BakeFit fit = BakeFit::surface;
	NormalKind normals = NormalKind::geometric; // that rays lie around, not from_depth
	double max_error = 0.0;                     // > 0, with BakeFit::surface: triangles are split until theirs is no more
	std::size_t max_vertices = 2'000'000;       // but to no more vertices than that
	double few = 0.0;                           // [0, 1): or until fewer than that share of the triangles could be split further
	BakeSides sides = BakeSides::separate;
	bool bent = false; // bent normals as well (ReferenceMeasure::bent)

	// Visibility at a point with a unit normal that something else draws: what is baked is then the difference to it, −1 to 1. With
	// BakeFit::surface, without bent normals. Called from any thread.
	std::function<double(glm::dvec3 position, glm::dvec3 normal)> beside{};
};

// How far interpolated values are from rays, at points of the surface that were not asked before.
struct BakeCheck
{
	std::size_t points = 0; // those inside matter are left out
	std::size_t buried = 0;
	std::size_t shut = 0; // of the points, where hardly a ray gets out
	std::size_t rays = 0;
	double rmse = 0.0;           // the rays' own standard error is in it
	double rmse_seen = 0.0;      // of the points that are not shut in
	double bias = 0.0;           // mean of bake − rays
	double standard_error = 0.0; // root mean square, of the rays of a point
	double rmse_without = 0.0;   // of `beside` alone, with nothing baked
	double angle_rad = 0.0;      // with bent normals: mean angle to those of the rays
};

struct VertexBake
{
	std::vector<float> visibility;    // one a vertex of the level, in [0, 1]; with `beside` the difference
	std::vector<float> back;          // of the vertices' other side; empty where nothing has two
	std::vector<glm::vec3> bent;      // with BakeSettings::bent: unit, world space
	std::vector<glm::vec3> bent_back; // as `back`
	std::size_t unknowns = 0;         // values; vertices of one position and one normal share theirs
	std::size_t points = 0;           // where rays were traced
	std::size_t buried = 0;           // of those that decided, inside matter, which hardly count
	std::size_t shut = 0;             // of the others, where hardly a ray gets out, which hardly count either
	std::size_t rays = 0;
	double standard_error = 0.0; // root mean square over the values, as far as it comes from the rays

	// Of max_error.
	std::optional<Level> refined; // what the values belong to, where that is not the level itself
	std::size_t above = 0;        // triangles whose error is above it all the same
	double area_above_m2 = 0.0;   // of these
	bool capped = false;          // because of max_vertices
};

// Same bytes for any thread count. Stages "rays", "fit", by turns where there is a max_error.
VertexBake bakeVertices(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run);

// At `points` points, even over the surface by area, with 1024 rays each. Stage "check".
BakeCheck checkBake(const Tracer& tracer, const Level& baked, const VertexBake& bake, const BakeSettings& settings,
					std::size_t points, const RunSettings& run);

} // namespace nook
