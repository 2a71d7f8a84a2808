// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Stefan Hertel and Kurt Mehlhorn, Fast Triangulation of Simple Polygons, 1983: a triangulation (here CGAL's
// constrained Delaunay triangulation, which supports holes) loses every diagonal whose removal leaves no reflex corner. At most
// four times the optimal number of pieces. CGAL's own partitions do not support holes.
#include "volume/surface.h"

#include <CGAL/Constrained_Delaunay_triangulation_2.h>
#include <CGAL/Constrained_triangulation_face_base_2.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>

#include <algorithm>
#include <numeric>

namespace nook::detail
{
namespace
{

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using FaceInfo = CGAL::Triangulation_face_base_with_info_2<int, Kernel, CGAL::Constrained_triangulation_face_base_2<Kernel>>;
using Structure = CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<uint32_t, Kernel>, FaceInfo>;
using Triangulation =
	CGAL::Constrained_Delaunay_triangulation_2<Kernel, Structure, CGAL::No_constraint_intersection_requiring_constructions_tag>;

constexpr int kUnknown = -1;

double cross(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Number of lines between a face and infinity; even means outside.
void findDepths(Triangulation& mesh)
{
	std::vector<Triangulation::Face_handle> now{mesh.infinite_face()};
	std::vector<Triangulation::Face_handle> later;
	for (int depth = 0; !now.empty(); ++depth)
	{
		while (!now.empty())
		{
			const Triangulation::Face_handle face = now.back();
			now.pop_back();
			if (face->info() != kUnknown)
			{
				continue;
			}
			face->info() = depth;
			for (int i = 0; i < 3; ++i)
			{
				const Triangulation::Face_handle next = face->neighbor(i);
				if (next->info() == kUnknown)
				{
					(face->is_constrained(i) ? later : now).push_back(next);
				}
			}
		}
		now.swap(later);
	}
}

struct Diagonal
{
	double square = 0.0; // length
	uint32_t a = 0;
	uint32_t b = 0;
	uint32_t left = 0; // triangles
	uint32_t right = 0;
};

class Merger
{
public:
	Merger(std::span<const glm::dvec2> points, std::vector<Piece> triangles, std::size_t most_corners)
		: m_points(points), m_most_corners(most_corners), m_pieces(std::move(triangles))
	{
	}

	// Removes the longest diagonals first, so that the pieces stay compact.
	std::vector<Piece> merge(std::vector<Diagonal> diagonals)
	{
		m_parents.resize(m_pieces.size());
		std::iota(m_parents.begin(), m_parents.end(), 0U);
		std::sort(diagonals.begin(), diagonals.end(),
				  [](const Diagonal& x, const Diagonal& y)
				  { return x.square != y.square ? x.square > y.square : (x.a != y.a ? x.a < y.a : x.b < y.b); });
		for (const Diagonal& diagonal : diagonals)
		{
			const uint32_t left = find(diagonal.left);
			const uint32_t right = find(diagonal.right);
			Piece joined;
			if (left != right && join(m_pieces[left], m_pieces[right], diagonal.a, diagonal.b, joined))
			{
				m_pieces[left] = std::move(joined);
				m_pieces[right].clear();
				m_parents[right] = left;
			}
		}
		std::erase_if(m_pieces, [](const Piece& piece) { return piece.empty(); });
		return std::move(m_pieces);
	}

private:
	uint32_t find(uint32_t piece)
	{
		while (m_parents[piece] != piece)
		{
			piece = m_parents[piece] = m_parents[m_parents[piece]];
		}
		return piece;
	}

	bool isLeft(uint32_t a, uint32_t b, uint32_t c) const
	{
		return CGAL::orientation(Kernel::Point_2(m_points[a].x, m_points[a].y), Kernel::Point_2(m_points[b].x, m_points[b].y),
								 Kernel::Point_2(m_points[c].x, m_points[c].y)) != CGAL::RIGHT_TURN;
	}

	static bool runsAlong(const Piece& piece, uint32_t from, uint32_t to)
	{
		for (std::size_t i = 0; i < piece.size(); ++i)
		{
			if (piece[i] == from && piece[(i + 1) % piece.size()] == to)
			{
				return true;
			}
		}
		return false;
	}

	// `one` traverses the diagonal from a to b, `other` from b to a.
	bool join(const Piece& one, const Piece& other, uint32_t a, uint32_t b, Piece& joined) const
	{
		if (one.size() + other.size() - 2 > m_most_corners)
		{
			return false;
		}
		if (!runsAlong(one, a, b) || !runsAlong(other, b, a))
		{
			return false; // part of the line between them is already gone
		}
		const auto at_b = static_cast<std::size_t>(std::find(one.begin(), one.end(), b) - one.begin());
		const auto at_a = static_cast<std::size_t>(std::find(other.begin(), other.end(), a) - other.begin());
		for (std::size_t i = 0; i < one.size(); ++i) // from b around to a
		{
			joined.push_back(one[(at_b + i) % one.size()]);
		}
		for (std::size_t i = 1; i + 1 < other.size(); ++i) // past a, short of b
		{
			joined.push_back(other[(at_a + i) % other.size()]);
		}
		const std::size_t size = joined.size();
		const std::size_t a_now = one.size() - 1;
		return isLeft(joined[size - 1], joined[0], joined[1]) &&
			   isLeft(joined[a_now - 1], joined[a_now], joined[(a_now + 1) % size]);
	}

	std::span<const glm::dvec2> m_points;
	std::size_t m_most_corners;
	std::vector<Piece> m_pieces;
	std::vector<uint32_t> m_parents;
};

std::vector<Piece> mergeInside(Triangulation& mesh, std::span<const glm::dvec2> points, std::size_t most_corners)
{
	for (Triangulation::Face_handle face : mesh.all_face_handles())
	{
		face->info() = kUnknown;
	}
	findDepths(mesh);
	std::vector<Piece> triangles;
	for (Triangulation::Face_handle face : mesh.all_face_handles())
	{
		if (mesh.is_infinite(face) || face->info() % 2 == 0)
		{
			face->info() = kUnknown;
			continue;
		}
		face->info() = static_cast<int>(triangles.size());
		triangles.push_back({face->vertex(0)->info(), face->vertex(1)->info(), face->vertex(2)->info()});
	}
	std::vector<Diagonal> diagonals;
	for (Triangulation::Face_handle face : mesh.finite_face_handles())
	{
		for (int i = 0; i < 3; ++i)
		{
			const Triangulation::Face_handle next = face->neighbor(i);
			if (face->info() != kUnknown && next->info() > face->info() && !face->is_constrained(i))
			{
				const uint32_t a = face->vertex(Triangulation::ccw(i))->info();
				const uint32_t b = face->vertex(Triangulation::cw(i))->info();
				const glm::dvec2 along = points[b] - points[a];
				diagonals.push_back({along.x * along.x + along.y * along.y, a, b, static_cast<uint32_t>(face->info()),
									 static_cast<uint32_t>(next->info())});
			}
		}
	}
	return Merger(points, std::move(triangles), most_corners).merge(std::move(diagonals));
}

} // namespace

std::vector<Piece> convexPieces(std::span<const std::vector<glm::dvec2>> loops, std::size_t most_corners)
{
	Triangulation mesh;
	std::vector<glm::dvec2> points;
	try
	{
		for (const std::vector<glm::dvec2>& loop : loops)
		{
			std::vector<Triangulation::Vertex_handle> corners;
			for (const glm::dvec2 point : loop)
			{
				const std::size_t before = mesh.number_of_vertices();
				corners.push_back(mesh.insert({point.x, point.y}));
				if (mesh.number_of_vertices() > before)
				{
					corners.back()->info() = static_cast<uint32_t>(points.size());
				}
				points.push_back(point);
			}
			for (std::size_t i = 0; i < corners.size(); ++i)
			{
				const Triangulation::Vertex_handle next = corners[(i + 1) % corners.size()];
				if (corners[i] != next)
				{
					mesh.insert_constraint(corners[i], next);
				}
			}
		}
	}
	catch (const Triangulation::Intersection_of_constraints_exception&)
	{
		return {};
	}
	return mesh.dimension() == 2 ? mergeInside(mesh, points, most_corners) : std::vector<Piece>{};
}

std::vector<Piece> joinTriangles(std::span<const glm::dvec2> points, std::vector<Piece> triangles,
								 std::span<const std::pair<uint32_t, uint32_t>> neighbours, std::size_t most_corners)
{
	std::vector<Diagonal> diagonals;
	for (const auto& [left, right] : neighbours)
	{
		for (std::size_t i = 0; i < 3; ++i)
		{
			const uint32_t a = triangles[left][i];
			const uint32_t b = triangles[left][(i + 1) % 3];
			const Piece& other = triangles[right];
			for (std::size_t j = 0; j < 3; ++j)
			{
				if (other[j] == b && other[(j + 1) % 3] == a)
				{
					const glm::dvec2 along = points[b] - points[a];
					diagonals.push_back({along.x * along.x + along.y * along.y, a, b, left, right});
				}
			}
		}
	}
	return Merger(points, std::move(triangles), most_corners).merge(std::move(diagonals));
}

bool isConvex(std::span<const glm::dvec2> loop)
{
	const std::size_t count = loop.size();
	int down = 0; // changes from rising to falling; two or more: the loop winds around more than once
	for (std::size_t i = 0; i < count; ++i)
	{
		const glm::dvec2 a = loop[i];
		const glm::dvec2 b = loop[(i + 1) % count];
		const glm::dvec2 c = loop[(i + 2) % count];
		if (!(cross(a, b, c) > 0.0))
		{
			return false;
		}
		const bool rises = b.y != a.y ? b.y > a.y : b.x > a.x;
		const bool will_rise = c.y != b.y ? c.y > b.y : c.x > b.x;
		down += rises && !will_rise ? 1 : 0;
	}
	return down == 1;
}

std::vector<Piece> cutConvex(std::size_t count, std::size_t most_corners)
{
	Piece whole(count);
	std::iota(whole.begin(), whole.end(), 0U);
	std::vector<Piece> open{whole};
	std::vector<Piece> done;
	while (!open.empty())
	{
		Piece piece = std::move(open.back());
		open.pop_back();
		if (piece.size() <= most_corners)
		{
			done.push_back(std::move(piece));
			continue;
		}
		const auto middle = piece.begin() + static_cast<std::ptrdiff_t>(piece.size() / 2);
		Piece rest(middle, piece.end());
		rest.push_back(piece.front());
		piece.erase(middle + 1, piece.end());
		open.push_back(std::move(rest));
		open.push_back(std::move(piece));
	}
	return done;
}

} // namespace nook::detail
