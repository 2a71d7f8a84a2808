// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Michael Garland and Paul Heckbert, Surface Simplification Using Quadric Error Metrics, 1997, as
// meshoptimizer has it.
#include "volume/proxies.h"

#include "core/parallel.h"
#include "scene/topology.h"
#include "volume/groups.h"
#include "volume/surface.h"

#include <glm/common.hpp>

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <limits>

namespace nook::detail
{
namespace
{

constexpr std::size_t kFewest = 8; // triangles of a piece that may become fewer: a box has twelve

struct Part
{
	std::vector<uint32_t> triangles; // of the level
	std::vector<glm::uvec3> simpler; // vertices of the level
	double error_m = 0.0;
};

void simplify(Part& piece, const Level& level, std::span<const uint32_t> first, double error_m)
{
	std::vector<uint32_t> vertices;
	for (const uint32_t t : piece.triangles)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			vertices.push_back(first[level.triangles[t][corner]]);
		}
	}
	std::vector<uint32_t> indices = vertices;
	std::sort(vertices.begin(), vertices.end());
	vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
	for (uint32_t& index : indices)
	{
		index = static_cast<uint32_t>(std::lower_bound(vertices.begin(), vertices.end(), index) - vertices.begin());
	}
	std::vector<float> positions;
	for (const uint32_t vertex : vertices) // from the piece itself: 32 bits keep its shape wherever it is
	{
		const glm::vec3 at(level.positions[vertex] - level.positions[vertices[0]]);
		positions.insert(positions.end(), {at.x, at.y, at.z});
	}
	constexpr std::size_t kStride = 3 * sizeof(float);
	const float scale = meshopt_simplifyScale(positions.data(), vertices.size(), kStride);
	if (!(scale > 0.0F))
	{
		return;
	}
	std::vector<uint32_t> simpler(indices.size());
	float error = 0.0F;
	simpler.resize(meshopt_simplify(simpler.data(), indices.data(), indices.size(), positions.data(), vertices.size(), kStride, 0,
									static_cast<float>(error_m) / scale, meshopt_SimplifyLockBorder, &error));
	for (std::size_t i = 0; i + 2 < simpler.size(); i += 3)
	{
		piece.simpler.emplace_back(vertices[simpler[i]], vertices[simpler[i + 1]], vertices[simpler[i + 2]]);
	}
	piece.error_m = static_cast<double>(error) * static_cast<double>(scale);
}

// One piece for each material of a surface joined by corners: what meets another material is a border.
std::vector<Part> piecesOf(const Level& level, std::span<const uint8_t> may_change, std::span<const uint32_t> first)
{
	Groups groups(level.positions.size());
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		if (may_change[i] != 0)
		{
			const glm::uvec3& t = level.triangles[i];
			groups.join(first[t.x], first[t.y]);
			groups.join(first[t.x], first[t.z]);
		}
	}
	std::vector<std::array<uint32_t, 3>> order; // surface, material, triangle
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		if (may_change[i] != 0)
		{
			order.push_back({groups.of(first[level.triangles[i].x]), level.materials[i], static_cast<uint32_t>(i)});
		}
	}
	std::sort(order.begin(), order.end());
	std::vector<Part> pieces;
	for (std::size_t i = 0; i < order.size(); ++i)
	{
		if (i == 0 || order[i][0] != order[i - 1][0] || order[i][1] != order[i - 1][1])
		{
			pieces.emplace_back();
		}
		pieces.back().triangles.push_back(order[i][2]);
	}
	return pieces;
}

} // namespace

Proxies proxiesOf(const Level& level, std::span<const uint8_t> may_change, double error_m, const RunSettings& run)
{
	const std::vector<uint32_t> first = weldPositions(level.positions, run.threads);
	std::vector<Part> pieces = piecesOf(level, may_change, first);
	parallelFor(pieces.size(), run.threads,
				[&](std::size_t i)
				{
					if (pieces[i].triangles.size() >= kFewest)
					{
						simplify(pieces[i], level, first, error_m);
					}
				});
	Proxies proxies;
	const auto add = [&](const glm::uvec3& triangle, uint32_t source)
	{
		proxies.triangles.push_back(triangle);
		proxies.materials.push_back(level.materials[source]);
		proxies.sources.push_back(source);
	};
	for (const Part& piece : pieces)
	{
		for (const glm::uvec3& triangle : piece.simpler)
		{
			add(triangle, piece.triangles[0]);
		}
		for (std::size_t i = 0; piece.simpler.empty() && i < piece.triangles.size(); ++i)
		{
			add(level.triangles[piece.triangles[i]], piece.triangles[i]);
		}
		proxies.deviation_m = piece.simpler.empty() ? proxies.deviation_m : std::max(proxies.deviation_m, piece.error_m);
	}
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		if (may_change[i] == 0)
		{
			add(level.triangles[i], static_cast<uint32_t>(i));
		}
	}
	return proxies;
}

} // namespace nook::detail
