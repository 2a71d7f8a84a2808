// SPDX-License-Identifier: GPL-3.0-or-later
// Refines chosen triangles of a level, and neighbours as needed to avoid cracks.
#pragma once

#include "bake/bake.h"
#include "bake/surface_samples.h"

#include <cstddef>
#include <span>
#include <vector>

namespace nook
{

// Edges of triangles; edges between the same two positions share a number.
class EdgeMarks
{
public:
	EdgeMarks(const Level& level, const Unknowns& unknowns);

	// Marks the longest edge of a triangle and those nearly as long, and in every triangle with a marked edge the longest one
	// (M.-C. Rivara, "Algorithms for Refining Triangular Grids Suitable for Adaptive and Multigrid Techniques", 1984), so that
	// triangles do not become thin.
	void mark(std::size_t triangle);

	bool isMarked(std::size_t triangle, std::size_t edge) const
	{
		return m_marked[m_edge[3 * triangle + edge]] != 0;
	}
	double longest(std::size_t triangle) const; // metres
	std::size_t newVertices() const;            // created by splitting the marked edges
	void clear();

private:
	void markEdge(uint32_t edge);

	const Level& m_level;
	std::vector<uint32_t> m_edge;     // three per triangle: corners 0 1, 1 2, 2 0
	std::vector<double> m_length;     // per edge, metres
	std::vector<std::size_t> m_first; // start of each edge's list in m_triangle
	std::vector<uint32_t> m_triangle; // triangles with that edge
	std::vector<uint8_t> m_marked;
	std::vector<uint32_t> m_todo;
};

// Splits every triangle with marked edges at their midpoints into two, three or four of the same orientation, material and mesh.
// Triangles that share an edge share its parts. Samples move to the triangles that contain them.
void splitMarked(Level& level, std::vector<SurfaceSample>& samples, const EdgeMarks& marks);

// Subdivides a level until its vertex bake meets a requested error.

// Alternates fitting and subdivision until no triangle's error exceeds settings.max_error. Requires max_error > 0 and
// BakeFit::surface.
VertexBake refineBake(const Tracer& tracer, const BakeSettings& settings, const RunSettings& run);

// Fits vertex values whose interpolation over the triangles is closest to the surface samples.

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
