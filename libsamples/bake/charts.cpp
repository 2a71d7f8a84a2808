// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/charts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace nook
{
namespace
{

// In texels: neighbours of one chart share their edges but for rounding.
constexpr double kWellInside_px = 0.1;

uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t i)
{
	while (parent[i] != i)
	{
		parent[i] = parent[parent[i]];
		i = parent[i];
	}
	return i;
}

// Of vertices at one place with the same coordinates the first.
std::vector<uint32_t> joinedVertices(const Level& level, std::span<const glm::vec2> uvs)
{
	std::vector<uint32_t> order(uvs.size());
	std::iota(order.begin(), order.end(), 0U);
	const auto key = [&](uint32_t v)
	{
		const glm::dvec3 p = level.positions[v];
		return std::tuple(uvs[v].x, uvs[v].y, p.x, p.y, p.z);
	};
	std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });
	std::vector<uint32_t> first(uvs.size());
	for (std::size_t i = 0; i < order.size(); ++i)
	{
		first[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? first[order[i - 1]] : order[i];
	}
	return first;
}

} // namespace

std::vector<uint32_t> chartsOf(const Level& level, std::span<const glm::vec2> uvs, std::size_t& count)
{
	std::vector<uint32_t> parent = joinedVertices(level, uvs);
	for (const glm::uvec3& t : level.triangles)
	{
		for (int corner = 1; corner < 3; ++corner)
		{
			const uint32_t a = rootOf(parent, t[0]);
			const uint32_t b = rootOf(parent, t[corner]);
			parent[std::max(a, b)] = std::min(a, b);
		}
	}
	std::vector<uint32_t> number(parent.size(), kNoTriangle);
	std::vector<uint32_t> charts;
	charts.reserve(level.triangles.size());
	count = 0;
	for (const glm::uvec3& t : level.triangles)
	{
		uint32_t& chart = number[rootOf(parent, t.x)];
		if (chart == kNoTriangle)
		{
			chart = static_cast<uint32_t>(count++);
		}
		charts.push_back(chart);
	}
	return charts;
}

glm::dvec3 weightsAt(const Level& level, std::span<const glm::vec2> uvs, std::size_t triangle, glm::dvec2 uv)
{
	const glm::uvec3 t = level.triangles[triangle];
	const glm::dvec2 a(uvs[t.x]);
	const glm::dvec2 u = glm::dvec2(uvs[t.y]) - a;
	const glm::dvec2 v = glm::dvec2(uvs[t.z]) - a;
	const glm::dvec2 w = uv - a;
	const double area = u.x * v.y - u.y * v.x;
	const double b = (w.x * v.y - w.y * v.x) / area;
	const double c = (u.x * w.y - u.y * w.x) / area;
	return {1.0 - b - c, b, c};
}

std::vector<uint32_t> rasterise(const Level& level, std::span<const glm::vec2> uvs, int size_px, int first_row, int rows,
								std::size_t& overlaps, std::vector<uint8_t>& hit)
{
	const int across = kSamplesAcross * size_px;
	const int top = kSamplesAcross * first_row;
	const int bottom = top + kSamplesAcross * rows;
	std::vector<uint32_t> owner(static_cast<std::size_t>(across) * static_cast<std::size_t>(bottom - top), kNoTriangle);
	std::vector<uint8_t> well(owner.size(), 0);
	for (std::size_t t = 0; t < level.triangles.size(); ++t)
	{
		const glm::uvec3 corner = level.triangles[t];
		const glm::dvec2 a = static_cast<double>(across) * glm::dvec2(uvs[corner.x]);
		const glm::dvec2 b = static_cast<double>(across) * glm::dvec2(uvs[corner.y]);
		const glm::dvec2 c = static_cast<double>(across) * glm::dvec2(uvs[corner.z]);
		const glm::dvec2 least = glm::min(a, glm::min(b, c));
		const glm::dvec2 most = glm::max(a, glm::max(b, c));
		const double twice = std::fabs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
		const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
		// Samples lie at the middles; a weight times the height above the edge across is at least weight × twice / longest.
		const double well_inside = kSamplesAcross * kWellInside_px * longest / twice;
		const int x0 = std::max(0, static_cast<int>(std::ceil(least.x - 0.5)));
		const int x1 = std::min(across - 1, static_cast<int>(std::floor(most.x - 0.5)));
		const int y0 = std::max(top, static_cast<int>(std::ceil(least.y - 0.5)));
		const int y1 = std::min(bottom - 1, static_cast<int>(std::floor(most.y - 0.5)));
		for (int y = y0; y <= y1; ++y)
		{
			for (int x = x0; x <= x1; ++x)
			{
				const glm::dvec3 weights = weightsAt(level, uvs, t, glm::dvec2(x + 0.5, y + 0.5) / static_cast<double>(across));
				const double inside = std::min({weights.x, weights.y, weights.z});
				if (!(inside >= 0.0)) // or NaN
				{
					continue;
				}
				const std::size_t i =
					static_cast<std::size_t>(y - top) * static_cast<std::size_t>(across) + static_cast<std::size_t>(x);
				const bool is_well = inside > well_inside;
				overlaps += is_well && well[i] != 0 ? 1U : 0U;
				hit[t] = 1;
				if (owner[i] == kNoTriangle || (is_well && well[i] == 0))
				{
					owner[i] = static_cast<uint32_t>(t);
				}
				well[i] = is_well ? 1 : well[i];
			}
		}
	}
	return owner;
}

} // namespace nook
