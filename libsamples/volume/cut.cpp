// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/cut.h"

#include "volume/coverage.h"
#include "volume/halves.h"
#include "volume/prism.h"
#include "volume/texture_map.h"

#include <algorithm>
#include <cmath>

namespace nook::detail
{
namespace
{

double sumOfHalves(const Occluders& occluders, double length_m)
{
	double sum = 0.0;
	for (const Occluder& polygon : occluders.polygons)
	{
		sum += halvesOf(occluders.cornersOf(polygon), length_m);
	}
	return sum;
}

} // namespace

double alphaOf(const Soup& soup, uint32_t look, std::span<const glm::dvec3> corners)
{
	const Material& material = soup.level->material_list[soup.materials[look]];
	if (material.alpha_mode == AlphaMode::opaque)
	{
		return 1.0;
	}
	const TextureMap map = textureMapOf(soup, look);
	std::vector<glm::dvec2> uvs;
	for (const glm::dvec3 corner : corners)
	{
		uvs.push_back(map.at(corner));
	}
	return coverageOf(*soup.level, material, uvs);
}

double cutLength(const Occluders& occluders, const OccluderSettings& settings)
{
	const double most = 1.25 * static_cast<double>(occluders.polygons.size());
	for (double length_m = settings.extent * settings.distance_m; length_m < kFarthest_m; length_m *= 2.0)
	{
		if (settings.extent_always || sumOfHalves(occluders, length_m) <= most)
		{
			return length_m;
		}
	}
	return INFINITY;
}

uint64_t piecesOf(const Occluders& occluders, double length_m)
{
	return static_cast<uint64_t>(std::min(sumOfHalves(occluders, length_m), 1e18));
}

Occluders cutOccluders(const Soup& soup, const Occluders& occluders, const std::vector<uint32_t>& looks, double length_m,
					   OccluderCounts& counts)
{
	Occluders cut;
	for (std::size_t i = 0; i < occluders.polygons.size(); ++i)
	{
		const Occluder& polygon = occluders.polygons[i];
		Occluder piece = polygon;
		const std::span<const glm::dvec3> whole = occluders.cornersOf(polygon);
		if (halvesOf(whole, length_m) == 1.0)
		{
			piece.first_corner = static_cast<uint32_t>(cut.corners.size());
			cut.corners.insert(cut.corners.end(), whole.begin(), whole.end());
			cut.polygons.push_back(piece);
			continue;
		}
		for (const std::vector<glm::dvec3>& corners : halvedPolygon(whole, length_m, kMaxOccluderCorners))
		{
			const double alpha = alphaOf(soup, looks[i], corners);
			if (alpha < kClear)
			{
				counts.clear += 1;
				continue;
			}
			piece.alpha = static_cast<float>(alpha);
			piece.first_corner = static_cast<uint32_t>(cut.corners.size());
			piece.corner_count = static_cast<uint32_t>(corners.size());
			cut.corners.insert(cut.corners.end(), corners.begin(), corners.end());
			cut.polygons.push_back(piece);
		}
	}
	return cut;
}

} // namespace nook::detail
