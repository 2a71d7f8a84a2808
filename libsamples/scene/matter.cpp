// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/matter.h"

#include "pattern/starts.h"

#include <glm/geometric.hpp>

#include <array>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr std::size_t kVotes = 9; // odd: surfaces on both sides cannot tie

// Evenly distributed directions, none along an axis.
struct VoteDirections
{
	std::array<float, kVotes> x{}, y{}, z{};

	VoteDirections()
	{
		Recipe recipe;
		recipe.domain = Domain::sphere;
		recipe.method = Method::vogel;
		recipe.count = static_cast<int>(kVotes);
		const std::vector<glm::dvec3> points = vogelPoints(Layout(recipe));
		for (std::size_t i = 0; i < kVotes; ++i)
		{
			x[i] = static_cast<float>(points[i].x);
			y[i] = static_cast<float>(points[i].y);
			z[i] = static_cast<float>(points[i].z);
		}
	}
};

} // namespace

bool isInMatter(const Tracer& tracer, glm::dvec3 position)
{
	static const VoteDirections directions;
	std::array<int8_t, kVotes> sides{};
	tracer.sides(position, {directions.x, directions.y, directions.z}, sides);
	int sum = 0;
	for (const int8_t side : sides)
	{
		sum += side;
	}
	return sum < 0;
}

void matterOfGeometry(const Tracer& tracer, glm::dvec3 origin, const Directions& offsets, std::span<float> matter)
{
	thread_local std::vector<uint8_t> hidden;
	hidden.resize(matter.size());
	tracer.blocked(origin, offsets, 1.0F, hidden);
	for (std::size_t i = 0; i < matter.size(); ++i)
	{
		const glm::dvec3 position = origin + glm::dvec3(glm::vec3(offsets.x[i], offsets.y[i], offsets.z[i]));
		matter[i] = hidden[i] != 0 && isInMatter(tracer, position) ? 1.0F : 0.0F;
	}
}

DepthMatter::DepthMatter(const GBuffer& gbuffer, const RunSettings& run)
	: m_width_px(gbuffer.width_px), m_height_px(gbuffer.height_px)
{
	m_projector.emplace_back(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px);
	const Projector& projector = m_projector.front();
	GBuffer from_depth = gbuffer;
	normalsFromDepth(from_depth, run);
	m_planes.resize(gbuffer.depth.size());
	for (int y = 0; y < m_height_px; ++y)
	{
		for (int x = 0; x < m_width_px; ++x)
		{
			const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(m_width_px) + static_cast<std::size_t>(x);
			if (!std::isfinite(gbuffer.depth[pixel]))
			{
				m_planes[pixel] = {{0.0, 0.0, 0.0}, -1.0}; // no matter
				continue;
			}
			glm::dvec3 normal(from_depth.normals[pixel]);
			if (glm::dot(normal, projector.lineOf({x + 0.5, y + 0.5}).along) > -1e-6)
			{
				normal = {0.0, 0.0, 1.0}; // edge-on: use a plane across the view instead
			}
			m_planes[pixel] = {normal, glm::dot(normal, positionOf(gbuffer, projector, x, y))};
		}
	}
}

bool DepthMatter::isMatter(glm::dvec3 position, glm::dvec2 pixel) const
{
	const auto index = static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(m_width_px) + static_cast<std::size_t>(pixel.x);
	const Plane& plane = m_planes[index];
	return glm::dot(plane.normal, position) < plane.offset;
}

void DepthMatter::sample(glm::dvec3 origin, const Directions& offsets, std::span<float> matter) const
{
	double sum = 0.0;
	std::size_t known = 0;
	for (std::size_t i = 0; i < matter.size(); ++i)
	{
		const glm::dvec3 position = origin + glm::dvec3(glm::vec3(offsets.x[i], offsets.y[i], offsets.z[i]));
		matter[i] = -1.0F; // unknown
		if (position.z < 0.0)
		{
			const glm::dvec2 pixel = m_projector.front().pixelOf(position);
			if (pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < m_width_px && pixel.y < m_height_px)
			{
				matter[i] = isMatter(position, pixel) ? 1.0F : 0.0F;
				sum += static_cast<double>(matter[i]);
				known += 1;
			}
		}
	}
	const float mean = known > 0 ? static_cast<float>(sum / static_cast<double>(known)) : 0.0F;
	for (float& m : matter)
	{
		m = m < 0.0F ? mean : m;
	}
}

} // namespace nook
