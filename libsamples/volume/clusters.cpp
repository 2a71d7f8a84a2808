// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/volumes.h"

#include "core/parallel.h"
#include "volume/prism.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <span>

namespace nook
{
namespace
{

// Sort keys of a polygon.
struct Item
{
	glm::dvec3 middle{0.0};
	double share = 0.0; // α · area, m²: its contribution to occlusion
	int kind = 0;       // polygons of different kinds never share a cluster; larger ones first
};

// Normal of the front with a length of twice the area.
glm::dvec3 areaVector(std::span<const glm::dvec3> corners)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 2; i < corners.size(); ++i)
	{
		sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
	}
	return sum;
}

// Bounding boxes of volumes are never smaller than δ, so polygons up to that size form one class; each further class is four times
// the previous.
int classOf(double extent_m, double distance_m)
{
	int size_class = 0;
	for (double most = distance_m; extent_m > most && size_class < 32; most *= 4.0)
	{
		size_class += 1;
	}
	return size_class;
}

// Large polygons across one axis share a cluster: if they are coplanar, the cluster is thin along that axis and 16-bit rounding
// hardly moves them.
int axisOf(glm::dvec3 area)
{
	const glm::dvec3 size = glm::abs(area);
	const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
	return size[axis] > 0.999 * glm::length(area) ? 1 + axis : 0;
}

Item itemOf(const VolumeSet& volumes, const Occluder& polygon)
{
	const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(polygon);
	const Bounds box = boundsAround(corners);
	const glm::dvec3 extent = box.most - box.least;
	const glm::dvec3 area = areaVector(corners);
	const int size_class = classOf(std::max({extent.x, extent.y, extent.z}), volumes.distance_m);
	return {0.5 * (box.least + box.most), static_cast<double>(polygon.alpha) * glm::length(area),
			4 * size_class + (size_class > 0 ? axisOf(area) : 0)};
}

// Maximum extent of a cluster's polygon centres along each axis, such that half a step of 16-bit coordinates stays within the
// distance that AOV's receivers keep from a polygon's plane (1e-4 δ). Applies to all axes, or only to the one that all polygons lie
// across.
glm::dvec3 limitOf(int kind, double distance_m)
{
	double step_m = 1.0; // steps are powers of two
	while (step_m > 2e-4 * distance_m)
	{
		step_m *= 0.5;
	}
	while (2.0 * step_m <= 2e-4 * distance_m)
	{
		step_m *= 2.0;
	}
	const double limit_m = 65535.0 * step_m - distance_m;
	glm::dvec3 limit(kind < 4 ? limit_m : 1e300);
	if (kind % 4 > 0)
	{
		limit[kind % 4 - 1] = limit_m;
	}
	return limit;
}

class Sorter
{
public:
	Sorter(const std::vector<Item>& items, std::size_t most, std::size_t fewest, glm::dvec3 limit)
		: m_items(items), m_most(most), m_fewest(fewest), m_limit(limit)
	{
	}

	// Sorts in place and appends the ends of the clusters. Splits into halves of equal count while there are too many polygons,
	// then of equal extent while too wide, as long as enough polygons remain.
	void sort(std::span<uint32_t> order, std::size_t before, std::vector<std::size_t>& ends) const
	{
		glm::dvec3 least(1e300);
		glm::dvec3 most(-1e300);
		for (const uint32_t i : order)
		{
			least = glm::min(least, m_items[i].middle);
			most = glm::max(most, m_items[i].middle);
		}
		std::size_t left = 0;
		if (order.size() > m_most)
		{
			left = halve(order, longest(most - least));
		}
		else if (const int axis = longest((most - least) / m_limit);
				 order.size() > m_fewest && most[axis] - least[axis] > m_limit[axis])
		{
			const double middle = 0.5 * (least[axis] + most[axis]);
			const auto before_middle = [this, axis, middle](uint32_t i)
			{
				return m_items[i].middle[axis] < middle;
			};
			const auto end = std::partition(order.begin(), order.end(), before_middle);
			left = static_cast<std::size_t>(end - order.begin());
		}
		if (left == 0 || left == order.size())
		{
			std::sort(order.begin(), order.end(), [this](uint32_t a, uint32_t b) { return precedes(a, b); });
			ends.push_back(before + order.size());
			return;
		}
		sort(order.first(left), before, ends);
		sort(order.subspan(left), before + left, ends);
	}

private:
	bool precedes(uint32_t a, uint32_t b) const
	{
		return m_items[a].share != m_items[b].share ? m_items[a].share > m_items[b].share : a < b;
	}

	static int longest(glm::dvec3 extent)
	{
		return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
	}

	// The left half gets whole clusters, so that the total number is minimal.
	std::size_t halve(std::span<uint32_t> order, int axis) const
	{
		const std::size_t clusters = (order.size() + m_most - 1) / m_most;
		const std::size_t left = order.size() * (clusters / 2) / clusters;
		const auto along = [this, axis](uint32_t a, uint32_t b)
		{
			const double at_a = m_items[a].middle[axis];
			const double at_b = m_items[b].middle[axis];
			return at_a != at_b ? at_a < at_b : a < b;
		};
		std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(left), order.end(), along);
		return left;
	}

	const std::vector<Item>& m_items;
	std::size_t m_most;
	std::size_t m_fewest;
	glm::dvec3 m_limit;
};

Occluders reordered(const Occluders& occluders, std::span<const uint32_t> order)
{
	Occluders made;
	made.corners.reserve(occluders.corners.size());
	made.polygons.reserve(order.size());
	for (const uint32_t i : order)
	{
		Occluder polygon = occluders.polygons[i];
		const std::span<const glm::dvec3> corners = occluders.cornersOf(polygon);
		polygon.first_corner = static_cast<uint32_t>(made.corners.size());
		made.corners.insert(made.corners.end(), corners.begin(), corners.end());
		made.polygons.push_back(polygon);
	}
	return made;
}

} // namespace

Bounds boundsAround(std::span<const glm::dvec3> points)
{
	Bounds bounds;
	for (const glm::dvec3& point : points)
	{
		bounds.least = glm::min(bounds.least, point);
		bounds.most = glm::max(bounds.most, point);
	}
	return bounds;
}

Bounds volumeBox(const VolumeSet& volumes, std::size_t index)
{
	const Occluder& polygon = volumes.occluders.polygons[index];
	const std::span<const glm::dvec3> corners = volumes.occluders.cornersOf(polygon);
	std::array<glm::dvec3, 2 * kMaxOccluderCorners> points;
	const std::span<glm::dvec3> used = std::span(points).first(2 * corners.size());
	prismOf(corners, frontOf(corners), shapeOf(volumes, polygon), used);
	return boundsAround(used);
}

void clusterVolumes(VolumeSet& volumes, const ClusterSettings& settings, const RunSettings& run)
{
	assert(settings.polygons >= 1 && settings.polygons <= 2048);
	const ProgressCounter stage(run.progress, "clusters");
	const std::size_t count = volumes.occluders.polygons.size();
	constexpr std::size_t kBlock = 4096;
	const std::size_t blocks = (count + kBlock - 1) / kBlock;
	std::vector<Item> items(count);
	const auto measure = [&](std::size_t block)
	{
		for (std::size_t i = block * kBlock; i < std::min(count, (block + 1) * kBlock); ++i)
		{
			items[i] = itemOf(volumes, volumes.occluders.polygons[i]);
		}
	};
	parallelFor(blocks, run.threads, measure);
	std::vector<uint32_t> order(count);
	std::iota(order.begin(), order.end(), 0U);
	std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return items[a].kind > items[b].kind; });

	std::vector<std::size_t> ends;
	for (std::size_t first = 0; first < count;)
	{
		std::size_t last = first;
		while (last < count && items[order[last]].kind == items[order[first]].kind)
		{
			++last;
		}
		const int kind = items[order[first]].kind;
		const Sorter sorter(items, settings.polygons, kind < 4 ? settings.fewest : settings.fewest_large,
							limitOf(kind, volumes.distance_m));
		sorter.sort(std::span(order).subspan(first, last - first), first, ends);
		first = last;
	}
	volumes.occluders = reordered(volumes.occluders, order);
	volumes.clusters.assign(ends.size(), {});
	const auto bound = [&](std::size_t i)
	{
		VolumeCluster& cluster = volumes.clusters[i];
		const std::size_t first = i == 0 ? 0 : ends[i - 1];
		Bounds box;
		for (std::size_t polygon = first; polygon < ends[i]; ++polygon)
		{
			const Bounds one = volumeBox(volumes, polygon);
			box.least = glm::min(box.least, one.least);
			box.most = glm::max(box.most, one.most);
		}
		cluster = {static_cast<uint32_t>(first), static_cast<uint32_t>(ends[i] - first), box.least, box.most};
	};
	parallelFor(ends.size(), run.threads, bound);
}

} // namespace nook
