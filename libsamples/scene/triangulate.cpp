// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on:
//   Gary H. Meisters: Polygons Have Ears. The American Mathematical Monthly 82 (6), 1975.
// Cuts the next ear in order, whatever its shape, because long triangles do not matter for rays.
#include "core/lists.h"
#include "scene/mesh_text.h"

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace nook
{
namespace
{

// Twice the signed area.
double areaOf(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c)
{
	return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Newell's normal: correct for any simple polygon, length twice the area.
glm::dvec3 normalOf(std::span<const glm::dvec3> corners)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		// Relative to a corner, which preserves precision for far-away polygons.
		sum += glm::cross(corners[i] - corners[0], corners[(i + 1) % corners.size()] - corners[0]);
	}
	return sum;
}

// Projects to the two coordinates that keep the most area; stays counter-clockwise.
std::vector<glm::dvec2> flattened(std::span<const glm::dvec3> corners, glm::dvec3 normal)
{
	const glm::dvec3 size = glm::abs(normal);
	const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
	const int u = (axis + 1) % 3;
	const int v = (axis + 2) % 3;
	const double turn = normal[axis] < 0.0 ? -1.0 : 1.0;
	return mapped(corners, [&](const glm::dvec3& corner)
				  { return glm::dvec2(corner[u] - corners[0][u], turn * (corner[v] - corners[0][v])); });
}

// The remaining polygon, as a ring.
struct Ring
{
	std::vector<glm::dvec2> at;
	std::vector<uint32_t> next;
	std::vector<uint32_t> previous;
	std::vector<uint32_t> reflex; // corners that may lie in an ear; may include former ones until swept
	std::vector<bool> gone;
	double noise = 0.0; // areas up to this are rounding errors

	double areaAt(uint32_t i) const
	{
		return areaOf(at[previous[i]], at[i], at[next[i]]);
	}

	bool isEar(uint32_t i) const
	{
		const glm::dvec2 a = at[previous[i]];
		const glm::dvec2 b = at[i];
		const glm::dvec2 c = at[next[i]];
		if (areaOf(a, b, c) <= noise)
		{
			return false;
		}
		for (const uint32_t other : reflex)
		{
			const glm::dvec2 p = at[other];
			// Corners that coincide with one of the ear's (both ends of a bridge to a hole) lie on its border.
			if (gone[other] || p == a || p == b || p == c)
			{
				continue;
			}
			if (areaOf(a, b, p) >= 0.0 && areaOf(b, c, p) >= 0.0 && areaOf(c, a, p) >= 0.0)
			{
				return false;
			}
		}
		return true;
	}

	void cut(uint32_t i)
	{
		next[previous[i]] = next[i];
		previous[next[i]] = previous[i];
		gone[i] = true;
		std::erase_if(reflex, [&](uint32_t other) { return gone[other] || areaAt(other) > noise; });
	}
};

Ring ringOf(std::vector<glm::dvec2> flat, double area)
{
	const auto count = static_cast<uint32_t>(flat.size());
	Ring ring;
	ring.at = std::move(flat);
	ring.gone.assign(count, false);
	ring.noise = 1e-12 * area;
	for (uint32_t i = 0; i < count; ++i)
	{
		ring.next.push_back((i + 1) % count);
		ring.previous.push_back((i + count - 1) % count);
	}
	for (uint32_t i = 0; i < count; ++i)
	{
		if (ring.areaAt(i) <= ring.noise)
		{
			ring.reflex.push_back(i);
		}
	}
	return ring;
}

} // namespace

bool triangulate(std::span<const glm::dvec3> corners, std::vector<glm::uvec3>& triangles)
{
	assert(corners.size() >= 3);
	const auto count = static_cast<uint32_t>(corners.size());
	if (count == 3)
	{
		triangles.emplace_back(0, 1, 2);
		return true;
	}
	const glm::dvec3 normal = normalOf(corners);
	const double area = glm::length(normal);
	if (!(area > 0.0))
	{
		for (uint32_t i = 2; i < count; ++i)
		{
			triangles.emplace_back(0, i - 1, i);
		}
		return false;
	}
	Ring ring = ringOf(flattened(corners, normal), area);
	bool simple = true;
	uint32_t at = 0;
	for (uint32_t left = count; left >= 3; --left)
	{
		// The next ear; if there is none, the next corner that is at least convex; else any, since only degenerate ones remain.
		uint32_t ear = at;
		uint32_t convex = count;
		bool found = false;
		for (uint32_t tried = 0; tried < left && !found; ++tried, ear = ring.next[ear])
		{
			found = ring.isEar(ear);
			convex = convex == count && ring.areaAt(ear) > ring.noise ? ear : convex;
			if (found)
			{
				break;
			}
		}
		if (!found && convex < count)
		{
			simple = false;
			ear = convex;
		}
		if (found || convex < count)
		{
			triangles.emplace_back(ring.previous[ear], ear, ring.next[ear]);
		}
		at = ring.next[ear];
		ring.cut(ear);
	}
	return simple;
}

void FaceCutter::send(const FileMesh& mesh, const std::vector<std::string>& path, bool mirrored, ValueWriter& to)
{
	m_triangles.clear();
	std::size_t begin = 0;
	for (const uint32_t end : mesh.ends)
	{
		add({mesh.corners.data() + begin, end - begin}, mesh);
		begin = end;
	}
	for (std::size_t i = 0; i < m_triangles.size() && mirrored; ++i)
	{
		std::swap(m_triangles[i].y, m_triangles[i].z);
	}
	to.value(MeshHead{mesh.material, false});
	to.text(mesh.name);
	nook::send(path, to);
	to.values(mesh.positions);
	to.values(mesh.normals);
	to.values(mesh.uvs);
	to.values(mesh.colours);
	to.values(mesh.sources);
	to.values(m_triangles);
}

void FaceCutter::add(std::span<const uint32_t> corners, const FileMesh& mesh)
{
	if (corners.size() < 3)
	{
		lines.add("mesh '" + mesh.name + "'");
	}
	else if (std::any_of(corners.begin(), corners.end(), [&](uint32_t corner) { return corner >= mesh.positions.size(); }))
	{
		m_triangles.emplace_back(~0U); // refers to no vertex
	}
	else if (corners.size() == 3)
	{
		m_triangles.emplace_back(corners[0], corners[1], corners[2]);
	}
	else
	{
		addPolygon(corners, mesh);
	}
}

void FaceCutter::addPolygon(std::span<const uint32_t> corners, const FileMesh& mesh)
{
	const std::vector<glm::dvec3> points = mapped(corners, [&mesh](uint32_t corner) { return mesh.positions[corner]; });
	const auto bad = std::find_if(points.begin(), points.end(), [](glm::dvec3 p) { return !std::isfinite(p.x + p.y + p.z); });
	if (bad != points.end())
	{
		// The whole polygon is dropped and counted as one triangle with that vertex.
		m_triangles.emplace_back(corners[static_cast<std::size_t>(bad - points.begin())]);
		return;
	}
	const std::size_t first = m_triangles.size();
	if (!triangulate(points, m_triangles))
	{
		bad_polygons.add("mesh '" + mesh.name + "', triangle " + std::to_string(first));
	}
	for (std::size_t i = first; i < m_triangles.size(); ++i)
	{
		glm::uvec3& triangle = m_triangles[i];
		triangle = {corners[triangle.x], corners[triangle.y], corners[triangle.z]};
	}
}

} // namespace nook
