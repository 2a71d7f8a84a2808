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

} // namespace nook
