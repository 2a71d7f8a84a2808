// SPDX-License-Identifier: GPL-3.0-or-later
// Fits vertex values whose interpolation over the triangles is closest to the surface samples.
#pragma once

#include "bake/surface_samples.h"

#include <span>
#include <vector>

namespace nook
{

struct VertexFitSettings
{
	bool bent = false;
	float least = 0.0F; // lower bound of a value, at most 1; the upper bound is 1
};
VertexFitSettings fitSettingsOf(const BakeSettings& settings);

struct FittedValues
{
	std::vector<float> values;    // one per unknown; 1 without a triangle
	std::vector<glm::dvec3> bent; // one per unknown: visibility times direction, not normalised; empty if not requested
	double standard_error = 0.0;  // root mean square effect of the samples' standard errors
};

// Area-weighted least squares with bounded values. Samples are ordered by triangle, at least one each. Values that no sample
// determines are smooth. Samples inside matter or in gaps have a thousandth of the weight, so they decide only where there are no
// others.
FittedValues fitValues(const Level& level, std::span<const double> areas, const Unknowns& unknowns,
					   std::span<const SurfaceSample> samples, uint32_t seed, const VertexFitSettings& settings = {});

// Stores the vertices' values and standard error. Bent normals are normalised; the vertex normal replaces a zero.
void take(VertexBake& bake, const Level& level, const Unknowns& unknowns, const FittedValues& fitted);

} // namespace nook
