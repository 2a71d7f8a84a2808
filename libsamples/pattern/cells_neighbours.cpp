// SPDX-License-Identifier: GPL-3.0-or-later
// Neighbouring cells from CGAL's triangulations with exact predicates.
#include "core/lists.h"
#include "pattern/cells.h"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Regular_triangulation_2.h>
#include <CGAL/Regular_triangulation_3.h>
#include <CGAL/Regular_triangulation_vertex_base_3.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>
#include <CGAL/convex_hull_3.h>

#include <algorithm>
#include <array>
#include <map>

namespace nook::detail
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

using Delaunay2 =
	CGAL::Delaunay_triangulation_2<Kernel,
								   CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<int, Kernel>>>;

using Delaunay3 =
	CGAL::Delaunay_triangulation_3<Kernel,
								   CGAL::Triangulation_data_structure_3<CGAL::Triangulation_vertex_base_with_info_3<int, Kernel>,
																		CGAL::Delaunay_triangulation_cell_base_3<Kernel>>>;

using Regular2 = CGAL::Regular_triangulation_2<
	Kernel, CGAL::Triangulation_data_structure_2<
				CGAL::Triangulation_vertex_base_with_info_2<int, Kernel, CGAL::Regular_triangulation_vertex_base_2<Kernel>>,
				CGAL::Regular_triangulation_face_base_2<Kernel>>>;

using Regular3 = CGAL::Regular_triangulation_3<
	Kernel, CGAL::Triangulation_data_structure_3<
				CGAL::Triangulation_vertex_base_with_info_3<int, Kernel, CGAL::Regular_triangulation_vertex_base_3<Kernel>>,
				CGAL::Regular_triangulation_cell_base_3<Kernel>>>;

Kernel::Point_2 point2(const glm::dvec3& p)
{
	return {p.x, p.y};
}

Kernel::Point_3 point3(const glm::dvec3& p)
{
	return {p.x, p.y, p.z};
}

// Inserts all points at once (CGAL orders them along a space-filling curve) and reads the edges.
template <class Triangulation, class MakePoint> Neighbours neighboursOf(std::size_t count, const MakePoint& make_point)
{
	const auto input = listOf(count, [&](std::size_t i) { return std::pair(make_point(i), static_cast<int>(i)); });
	Triangulation triangulation;
	triangulation.insert(input.begin(), input.end());

	Neighbours result(count);
	for (auto vertex = triangulation.finite_vertices_begin(); vertex != triangulation.finite_vertices_end(); ++vertex)
	{
		result.visible[static_cast<std::size_t>(vertex->info())] = 1;
	}
	for (auto edge = triangulation.finite_edges_begin(); edge != triangulation.finite_edges_end(); ++edge)
	{
		if constexpr (requires { edge->third; })
		{
			result.link(edge->first->vertex(edge->second)->info(), edge->first->vertex(edge->third)->info());
		}
		else
		{
			const auto face = edge->first;
			result.link(face->vertex(face->cw(edge->second))->info(), face->vertex(face->ccw(edge->second))->info());
		}
	}
	result.sort();
	return result;
}

} // namespace

void Neighbours::link(int a, int b)
{
	lists[static_cast<std::size_t>(a)].push_back(b);
	lists[static_cast<std::size_t>(b)].push_back(a);
}

void Neighbours::sort()
{
	for (std::vector<int>& list : lists)
	{
		std::sort(list.begin(), list.end());
		list.erase(std::unique(list.begin(), list.end()), list.end());
	}
}

Neighbours planeNeighbours(std::span<const glm::dvec3> points, std::span<const double> powers)
{
	if (powers.empty())
	{
		return neighboursOf<Delaunay2>(points.size(), [&](std::size_t i) { return point2(points[i]); });
	}
	return neighboursOf<Regular2>(points.size(),
								  [&](std::size_t i) { return Regular2::Weighted_point(point2(points[i]), powers[i]); });
}

Neighbours spaceNeighbours(std::span<const glm::dvec3> points, std::span<const double> powers)
{
	if (powers.empty())
	{
		return neighboursOf<Delaunay3>(points.size(), [&](std::size_t i) { return point3(points[i]); });
	}
	return neighboursOf<Regular3>(points.size(),
								  [&](std::size_t i) { return Regular3::Weighted_point(point3(points[i]), powers[i]); });
}

Neighbours directionNeighbours(std::span<const glm::dvec3> scaled_directions)
{
	// The cells are the normal fan of the convex hull: neighbours share a hull edge, points inside the hull have no cell.
	const std::size_t count = scaled_directions.size();
	std::map<Kernel::Point_3, int> index_of;
	std::vector<Kernel::Point_3> input;
	for (std::size_t i = 0; i < count; ++i)
	{
		if (index_of.emplace(point3(scaled_directions[i]), static_cast<int>(i)).second)
		{
			input.push_back(point3(scaled_directions[i]));
		}
	}
	Neighbours result(count);
	std::vector<Kernel::Point_3> corners;
	std::vector<std::array<std::size_t, 3>> triangles;
	if (input.size() >= 4)
	{
		CGAL::convex_hull_3(input.begin(), input.end(), corners, triangles);
	}
	if (corners.size() < 4) // at most three corners: assume that all pairs touch
	{
		for (auto a = index_of.begin(); a != index_of.end(); ++a)
		{
			result.visible[static_cast<std::size_t>(a->second)] = 1;
			for (auto b = std::next(a); b != index_of.end(); ++b)
			{
				result.link(a->second, b->second);
			}
		}
		result.sort();
		return result;
	}
	const auto link = [&](std::size_t a, std::size_t b)
	{
		const int corner = index_of.at(corners[a]);
		result.visible[static_cast<std::size_t>(corner)] = 1;
		result.link(corner, index_of.at(corners[b]));
	};
	// All corners are coplanar and in order: two triangles fewer, which CGAL 5.5.1 numbers past the last corner.
	if (triangles.size() + 2 == corners.size())
	{
		for (std::size_t i = 0; i < corners.size(); ++i)
		{
			link(i, (i + 1) % corners.size());
		}
		triangles.clear();
	}
	for (const auto& [a, b, c] : triangles)
	{
		link(a, b);
		link(b, c);
		link(c, a);
	}
	result.sort();
	return result;
}

} // namespace nook::detail
