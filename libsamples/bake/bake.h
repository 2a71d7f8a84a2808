// SPDX-License-Identifier: GPL-3.0-or-later
// A level → visibility at its vertices, for programs that interpolate it over triangles.
#pragma once

#include "core/progress.h"
#include "scene/gbuffer.h"
#include "scene/reference.h"
#include "scene/tracer.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace nook
{

enum class BakeFit
{
	surface, // what is nearest to the surface, interpolated: least squares at points of the triangles
	points,  // the value at the vertex itself, as most programs bake
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
};

// How far interpolated values are from rays, at points of the surface that were not asked before.
struct BakeCheck
{
	std::size_t points = 0; // those inside matter are left out
	std::size_t buried = 0;
	std::size_t rays = 0;
	double rmse = 0.0;           // the rays' own standard error is in it
	double bias = 0.0;           // mean of bake − rays
	double standard_error = 0.0; // root mean square, of the rays of a point
};

struct VertexBake
{
	std::vector<float> visibility; // one a vertex of the level, in [0, 1]
	std::size_t unknowns = 0;      // vertices of one position and one normal have one value
	std::size_t points = 0;        // where rays were traced
	std::size_t buried = 0;        // of those inside matter, which hardly count
	std::size_t rays = 0;
	double standard_error = 0.0; // root mean square over the values, as far as it comes from the rays
};

// Same bytes for any thread count. Stages "rays", "fit".
VertexBake bakeVertices(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run);

// At `points` points, even over the surface by area, with 1024 rays each. Stage "check".
BakeCheck checkBake(const Tracer& tracer, const Level& baked, const std::vector<float>& visibility, const BakeSettings& settings,
					std::size_t points, const RunSettings& run);

} // namespace nook
