// SPDX-License-Identifier: GPL-3.0-or-later
// Samples of a surface → the values at its vertices whose interpolation over the triangles is nearest to them.
#pragma once

#include "bake/surface_samples.h"
#include "bake/unknowns.h"

#include <span>
#include <vector>

namespace nook
{

struct VertexFitSettings
{
	bool bent = false;
	float least = 0.0F; // of a value, at most 1; the most is 1
};
VertexFitSettings fitSettingsOf(const BakeSettings& settings);

struct FittedValues
{
	std::vector<float> values;    // one an unknown; 1 where no triangle is
	std::vector<glm::dvec3> bent; // one an unknown, of any length: of visibility times direction; empty where not asked for
	double standard_error = 0.0;  // root mean square over them, of what the samples' standard errors make of it
};

// Least squares over the area, with values kept within bounds; samples in the order of the triangles, at least one each. What no
// sample decides is smooth. Samples inside matter or shut in count a thousandth: they decide where there are no
// others.
FittedValues fitValues(const Level& level, std::span<const double> areas, const Unknowns& unknowns,
					   std::span<const SurfaceSample> samples, uint32_t seed, const VertexFitSettings& settings = {});

// The values of the vertices, and how sure they are. Bent normals become unit; the vertex's normal where there is none.
void take(VertexBake& bake, const Level& level, const Unknowns& unknowns, const FittedValues& fitted);

} // namespace nook
