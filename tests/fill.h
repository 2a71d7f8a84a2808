// SPDX-License-Identifier: GPL-3.0-or-later
// Counts on the CPU how many fragments drawing the volumes shades in a view: a volume has a fragment in a pixel if the line from
// the eye to the pixel's surface intersects it (its front faces pass the depth test, or the eye is inside).
#pragma once

#include "core/parallel.h"
#include "core/progress.h"
#include "scene/gbuffer.h"
#include "volume/volumes.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace nook::fill
{

struct FillCount
{
	uint64_t pixels = 0;    // pixels with a surface; the sky's fragments are not counted
	uint64_t fragments = 0; // without culling clusters
	uint64_t within = 0;    // fragments whose pixel's surface is inside the volume; the others contribute nothing
};

// A prism in view space: inside where normal · x ≥ offset.
struct Prism
{
	struct Plane
	{
		glm::dvec3 normal{0.0};
		double offset = 0.0;
	};
	std::array<Plane, kMaxOccluderCorners + 2> planes;
	std::size_t count = 0;
	std::array<double, 4> rectangle{}; // pixels: left, top, right, bottom
};

class Picture
{
public:
	explicit Picture(const GBuffer& gbuffer)
		: m_gbuffer(gbuffer), m_projector(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px),
		  m_eye(m_projector.lineOf({0.0, 0.0}).at)
	{
	}

	// False if the prism is behind the eye or outside the picture.
	bool prism(const VolumeSet& volumes, const Occluder& occluder, Prism& prism) const
	{
		std::array<glm::dvec3, kMaxOccluderCorners> corners;
		std::array<glm::dvec3, 2 * kMaxOccluderCorners> points;
		const std::size_t n = occluder.corner_count;
		for (std::size_t i = 0; i < n; ++i)
		{
			corners[i] = glm::dvec3(m_gbuffer.view.camera_from_world *
									glm::dvec4(volumes.occluders.corners[occluder.first_corner + i], 1.0));
		}
		const std::span<const glm::dvec3> of(corners.data(), n);
		const glm::dvec3 front = frontOf(of);
		prismOf(of, front, shapeOf(volumes, occluder), std::span(points.data(), 2 * n));
		prism.count = 0;
		const auto add = [&](glm::dvec3 normal, glm::dvec3 at)
		{
			prism.planes[prism.count++] = {normal, glm::dot(normal, at)};
		};
		add(front, points[0]);
		add(-front, points[n]);
		for (std::size_t i = 0; i < n; ++i)
		{
			add(glm::cross(front, points[(i + 1) % n] - points[i]), points[i]);
		}
		return frame(std::span(points.data(), 2 * n), prism.rectangle);
	}

	void count(const Prism& prism, int x, int y, FillCount& counts) const
	{
		const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(m_gbuffer.width_px) + static_cast<std::size_t>(x);
		const auto depth = static_cast<double>(m_gbuffer.depth[pixel]);
		if (!std::isfinite(depth))
		{
			return;
		}
		const glm::dvec3 way = depth * m_projector.lineOf({x + 0.5, y + 0.5}).along;
		double from = 0.0;
		double to = 1.0;
		for (std::size_t k = 0; k < prism.count && from <= to; ++k)
		{
			const double start = glm::dot(prism.planes[k].normal, m_eye) - prism.planes[k].offset;
			const double step = glm::dot(prism.planes[k].normal, way);
			if (step > 0.0)
			{
				from = std::max(from, -start / step);
			}
			else if (step < 0.0)
			{
				to = std::min(to, -start / step);
			}
			else if (start < 0.0)
			{
				return;
			}
		}
		counts.fragments += from <= to ? 1U : 0U;
		counts.within += from <= to && to >= 1.0 ? 1U : 0U;
	}

	const GBuffer& gbuffer() const
	{
		return m_gbuffer;
	}

private:
	bool frame(std::span<const glm::dvec3> points, std::array<double, 4>& rectangle) const
	{
		const double nearest_m = 1e-3;
		std::size_t behind = 0;
		rectangle = {1e300, 1e300, -1e300, -1e300};
		for (const glm::dvec3& point : points)
		{
			if (-point.z < nearest_m)
			{
				behind += 1;
				continue;
			}
			const glm::dvec2 at = m_projector.pixelOf(point);
			rectangle = {std::min(rectangle[0], at.x), std::min(rectangle[1], at.y), std::max(rectangle[2], at.x),
						 std::max(rectangle[3], at.y)};
		}
		const std::array<double, 4> whole{0.0, 0.0, static_cast<double>(m_gbuffer.width_px),
										  static_cast<double>(m_gbuffer.height_px)};
		if (behind > 0)
		{
			rectangle = whole;
			return behind < points.size();
		}
		rectangle = {std::max(rectangle[0], 0.0), std::max(rectangle[1], 0.0), std::min(rectangle[2], whole[2]),
					 std::min(rectangle[3], whole[3])};
		return rectangle[0] < rectangle[2] && rectangle[1] < rectangle[3];
	}

	const GBuffer& m_gbuffer;
	Projector m_projector;
	glm::dvec3 m_eye;
};

// Perspective views only.
inline FillCount countFill(const GBuffer& gbuffer, const VolumeSet& volumes, const RunSettings& run)
{
	constexpr std::size_t kBlock = 512;
	const Picture view(gbuffer);
	const std::size_t count = volumes.occluders.polygons.size();
	std::vector<FillCount> parts((count + kBlock - 1) / kBlock);
	parallelFor(parts.size(), run.threads,
				[&](std::size_t block)
				{
					Prism prism;
					for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
					{
						if (!view.prism(volumes, volumes.occluders.polygons[i], prism))
						{
							continue;
						}
						const auto& [left, top, right, bottom] = prism.rectangle;
						for (int y = static_cast<int>(top); y < static_cast<int>(std::ceil(bottom)); ++y)
						{
							for (int x = static_cast<int>(left); x < static_cast<int>(std::ceil(right)); ++x)
							{
								view.count(prism, x, y, parts[block]);
							}
						}
					}
				});
	FillCount all;
	for (const float depth : gbuffer.depth)
	{
		all.pixels += std::isfinite(depth) ? 1U : 0U;
	}
	for (const FillCount& part : parts)
	{
		all.fragments += part.fragments;
		all.within += part.within;
	}
	return all;
}

} // namespace nook::fill
