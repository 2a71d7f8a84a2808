// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles that are to be finer → the level with these and their neighbours split, without cracks.
#pragma once

#include "bake/surface_samples.h"
#include "bake/unknowns.h"

#include <cstddef>
#include <span>
#include <vector>

namespace nook
{

// Edges of triangles, one number for all that lie between the same two places.
class EdgeMarks
{
public:
	EdgeMarks(const Level& level, const Unknowns& unknowns);

	// Marks the longest edge of a triangle and those that are nearly as long; and of every triangle that has a marked edge the
	// longest one (M.-C. Rivara, "Algorithms for Refining Triangular Grids Suitable for Adaptive and Multigrid Techniques", 1984),
	// so that triangles do not grow thin.
	void mark(std::size_t triangle);

	bool isMarked(std::size_t triangle, std::size_t edge) const
	{
		return m_marked[m_edge[3 * triangle + edge]] != 0;
	}
	double longest(std::size_t triangle) const; // metres
	std::size_t newVertices() const;            // that splitting the marked edges makes
	void clear();

private:
	void markEdge(uint32_t edge);

	const Level& m_level;
	std::vector<uint32_t> m_edge;     // three a triangle: corners 0 1, 1 2, 2 0
	std::vector<double> m_length;     // of each edge, metres
	std::vector<std::size_t> m_first; // of each edge in m_triangle
	std::vector<uint32_t> m_triangle; // that have the edge
	std::vector<uint8_t> m_marked;
	std::vector<uint32_t> m_todo;
};

// Splits every triangle with marked edges at their middles, in two, three or four of its orientation, material and mesh. Triangles
// that share an edge share what it becomes. Samples move to the triangles that hold them.
void splitMarked(Level& level, std::vector<SurfaceSample>& samples, const EdgeMarks& marks);

} // namespace nook
