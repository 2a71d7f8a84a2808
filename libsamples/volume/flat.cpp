// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/flat.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace nook::detail
{
namespace
{

// The plane of a triangle or of a whole group.
struct Plane
{
	glm::dvec3 normal{0.0}; // unit
	double least = 1e300;   // normal · position
	double most = -1e300;
	glm::dvec3 box_least{1e300};
	glm::dvec3 box_most{-1e300};

	void add(glm::dvec3 position)
	{
		const double height = glm::dot(normal, position);
		least = std::min(least, height);
		most = std::max(most, height);
		box_least = glm::min(box_least, position);
		box_most = glm::max(box_most, position);
	}

	double flatnessFor(bool two_sided, const OccluderSettings& settings) const
	{
		const glm::dvec3 far = glm::max(glm::abs(box_least), glm::abs(box_most));
		return flatness(std::max({far.x, far.y, far.z}), two_sided, settings);
	}
};

// What stays the same while regions are found.
struct Work
{
	const Soup& soup;
	const Surface& surface;
	const OccluderSettings& settings;
	std::span<uint32_t> labels;
	glm::dvec3 origin; // heights are taken from here: they keep their digits far from the world's

	glm::dvec3 corner(uint32_t triangle, int at) const
	{
		return soup.level->positions[surface.triangles[triangle][at]] - origin;
	}
	glm::dvec3 area(uint32_t triangle) const
	{
		return areaOf(soup.level->positions, surface.triangles[triangle]);
	}
	double flatnessOf(uint32_t triangle) const
	{
		Plane plane;
		for (int at = 0; at < 3; ++at)
		{
			plane.add(corner(triangle, at) + origin);
		}
		return plane.flatnessFor(surface.two_sided[triangle] != 0, settings);
	}
};

Region regionOf(const Work& work, std::vector<uint32_t> triangles, glm::dvec3 normal, double flat_m)
{
	Region region{std::move(triangles), normal, flat_m, 0.0};
	for (const uint32_t t : region.triangles)
	{
		region.area_m2 += 0.5 * glm::dot(work.area(t), normal);
	}
	return region;
}

bool isWholeFlat(const Work& work, std::span<const uint32_t> group, glm::dvec3 normal, double& flat_m)
{
	Plane plane;
	plane.normal = normal;
	for (const uint32_t t : group)
	{
		if (!(glm::dot(work.area(t), normal) > 0.0))
		{
			return false;
		}
		for (int at = 0; at < 3; ++at)
		{
			plane.add(work.corner(t, at));
		}
	}
	plane.box_least += work.origin;
	plane.box_most += work.origin;
	flat_m = plane.flatnessFor(work.surface.two_sided[group[0]] != 0, work.settings);
	return plane.most - plane.least <= 2.0 * flat_m;
}

// All triangles that can be reached from `seed` and lie in its plane.
std::vector<uint32_t> grow(const Work& work, uint32_t seed, glm::dvec3 normal, double flat_m)
{
	const double height = glm::dot(normal, work.corner(seed, 0));
	const auto fits = [&](uint32_t t)
	{
		for (int at = 0; at < 3; ++at)
		{
			if (std::fabs(glm::dot(normal, work.corner(t, at)) - height) > flat_m)
			{
				return false;
			}
		}
		return glm::dot(work.area(t), normal) > 0.0;
	};
	std::vector<uint32_t> grown{seed};
	work.labels[seed] = seed;
	for (std::size_t next = 0; next < grown.size(); ++next)
	{
		for (std::size_t h = 3 * std::size_t{grown[next]}; h < 3 * std::size_t{grown[next]} + 3; ++h)
		{
			const uint32_t across = work.surface.opposite[h];
			if (across != kNone && work.labels[across / 3] == kNone && fits(across / 3))
			{
				work.labels[across / 3] = seed;
				grown.push_back(across / 3);
			}
		}
	}
	std::sort(grown.begin(), grown.end());
	return grown;
}

} // namespace

std::vector<Region> flatRegions(std::span<const uint32_t> group, const Soup& soup, const Surface& surface,
								const OccluderSettings& settings, std::span<uint32_t> labels)
{
	const Work work{soup, surface, settings, labels, soup.level->positions[surface.triangles[group[0]].x]};
	glm::dvec3 sum(0.0);
	std::vector<std::pair<double, uint32_t>> seeds;
	for (const uint32_t t : group)
	{
		const glm::dvec3 area = work.area(t);
		sum += area;
		seeds.emplace_back(-glm::length(area), t);
		labels[t] = kNone;
	}
	double flat_m = 0.0;
	const double length = glm::length(sum);
	std::vector<Region> regions;
	if (length > 0.0 && isWholeFlat(work, group, sum / length, flat_m))
	{
		for (const uint32_t t : group)
		{
			labels[t] = group[0];
		}
		regions.push_back(regionOf(work, {group.begin(), group.end()}, sum / length, flat_m));
		return regions;
	}
	std::sort(seeds.begin(), seeds.end());
	for (const auto& [size, seed] : seeds)
	{
		if (labels[seed] == kNone)
		{
			const glm::dvec3 normal = work.area(seed) / -size;
			flat_m = work.flatnessOf(seed);
			regions.push_back(regionOf(work, grow(work, seed, normal, flat_m), normal, flat_m));
		}
	}
	return regions;
}

PlaneAxes::PlaneAxes(glm::dvec3 origin_, glm::dvec3 normal) : origin(origin_)
{
	const glm::dvec3 size = glm::abs(normal);
	const glm::dvec3 least = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
							 : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
																  : glm::dvec3(0, 0, 1);
	x = glm::normalize(glm::cross(least, normal));
	y = glm::cross(normal, x);
}

glm::dvec2 PlaneAxes::of(glm::dvec3 position) const
{
	const glm::dvec3 offset = position - origin;
	return {glm::dot(x, offset), glm::dot(y, offset)};
}

} // namespace nook::detail
