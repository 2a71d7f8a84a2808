// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/cut_faces.h"

#include <algorithm>
#include <cmath>

namespace nook
{

void FaceCutter::start(std::string name, std::span<const glm::dvec3> positions, bool mirrored)
{
	m_name = std::move(name);
	m_positions = positions;
	m_mirrored = mirrored;
	triangles.clear();
}

void FaceCutter::add(std::span<const uint32_t> corners)
{
	if (corners.size() < 3)
	{
		lines.add("mesh '" + m_name + "'");
		return;
	}
	const std::size_t first = triangles.size();
	const bool inside = std::all_of(corners.begin(), corners.end(), [&](uint32_t corner) { return corner < m_positions.size(); });
	if (!inside)
	{
		triangles.emplace_back(~0U); // refers to no vertex
	}
	else if (corners.size() == 3)
	{
		triangles.emplace_back(corners[0], corners[1], corners[2]);
	}
	else
	{
		addPolygon(corners);
	}
	for (std::size_t i = first; i < triangles.size() && m_mirrored; ++i)
	{
		std::swap(triangles[i].y, triangles[i].z);
	}
}

void FaceCutter::addPolygon(std::span<const uint32_t> corners)
{
	m_corners.clear();
	for (const uint32_t corner : corners)
	{
		m_corners.push_back(m_positions[corner]);
	}
	const auto bad = std::find_if(m_corners.begin(), m_corners.end(), [](glm::dvec3 p) { return !std::isfinite(p.x + p.y + p.z); });
	if (bad != m_corners.end())
	{
		// The whole polygon is dropped and counted as one triangle with that vertex.
		triangles.emplace_back(corners[static_cast<std::size_t>(bad - m_corners.begin())]);
		return;
	}
	const std::size_t first = triangles.size();
	if (!triangulate(m_corners, triangles))
	{
		bad_polygons.add("mesh '" + m_name + "', triangle " + std::to_string(first));
	}
	for (std::size_t i = first; i < triangles.size(); ++i)
	{
		glm::uvec3& triangle = triangles[i];
		triangle = {corners[triangle.x], corners[triangle.y], corners[triangle.z]};
	}
}

} // namespace nook
