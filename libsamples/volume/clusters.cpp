// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/clusters.h"

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

// What the sort looks at.
struct Item
{
	glm::dvec3 middle{0.0};
	double share = 0.0; // α · area, m²: how much light it takes
	int size_class = 0;
};

std::span<const glm::dvec3> cornersOf(const Occluders& occluders, const Occluder& polygon)
{
	return std::span(occluders.corners).subspan(polygon.first_corner, polygon.corner_count);
}

// Twice the area, along the front.
glm::dvec3 areaVector(std::span<const glm::dvec3> corners)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 2; i < corners.size(); ++i)
	{
		sum += glm::cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
	}
	return sum;
}

// Boxes of volumes are never smaller than δ, so polygons up to that are of one class; beyond, each class is four times the last.
int classOf(double extent_m, double distance_m)
{
	int size_class = 0;
	for (double most = distance_m; extent_m > most && size_class < 32; most *= 4.0)
	{
		size_class += 1;
	}
	return size_class;
}

Item itemOf(const VolumeSet& volumes, const Occluder& polygon)
{
	const std::span<const glm::dvec3> corners = cornersOf(volumes.occluders, polygon);
	glm::dvec3 least(1e300);
	glm::dvec3 most(-1e300);
	for (const glm::dvec3 corner : corners)
	{
		least = glm::min(least, corner);
		most = glm::max(most, corner);
	}
	const glm::dvec3 extent = most - least;
	return {0.5 * (least + most), static_cast<double>(polygon.alpha) * glm::length(areaVector(corners)),
			classOf(std::max({extent.x, extent.y, extent.z}), volumes.distance_m)};
}

class Sorter
{
public:
	Sorter(const std::vector<Item>& items, std::size_t most) : m_items(items), m_most(most) {}

	// In place; the ends of the clusters are appended.
	void sort(std::span<uint32_t> order, std::size_t before, std::vector<std::size_t>& ends) const
	{
		if (order.size() <= m_most)
		{
			std::sort(order.begin(), order.end(), [this](uint32_t a, uint32_t b) { return precedes(a, b); });
			ends.push_back(before + order.size());
			return;
		}
		const int axis = longestAxis(order);
		// Whole clusters to the left: as few as possible in all.
		const std::size_t clusters = (order.size() + m_most - 1) / m_most;
		const std::size_t left = order.size() * (clusters / 2) / clusters;
		const auto along = [this, axis](uint32_t a, uint32_t b)
		{
			const double at_a = m_items[a].middle[axis];
			const double at_b = m_items[b].middle[axis];
			return at_a != at_b ? at_a < at_b : a < b;
		};
		std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(left), order.end(), along);
		sort(order.first(left), before, ends);
		sort(order.subspan(left), before + left, ends);
	}

private:
	bool precedes(uint32_t a, uint32_t b) const
	{
		return m_items[a].share != m_items[b].share ? m_items[a].share > m_items[b].share : a < b;
	}

	int longestAxis(std::span<const uint32_t> order) const
	{
		glm::dvec3 least(1e300);
		glm::dvec3 most(-1e300);
		for (const uint32_t i : order)
		{
			least = glm::min(least, m_items[i].middle);
			most = glm::max(most, m_items[i].middle);
		}
		const glm::dvec3 extent = most - least;
		return extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
	}

	const std::vector<Item>& m_items;
	std::size_t m_most;
};

Occluders reordered(const Occluders& occluders, std::span<const uint32_t> order)
{
	Occluders made;
	made.corners.reserve(occluders.corners.size());
	made.polygons.reserve(order.size());
	for (const uint32_t i : order)
	{
		Occluder polygon = occluders.polygons[i];
		const std::span<const glm::dvec3> corners = cornersOf(occluders, polygon);
		polygon.first_corner = static_cast<uint32_t>(made.corners.size());
		made.corners.insert(made.corners.end(), corners.begin(), corners.end());
		made.polygons.push_back(polygon);
	}
	return made;
}

} // namespace

VolumeBox volumeBox(const VolumeSet& volumes, std::size_t index)
{
	const Occluder& polygon = volumes.occluders.polygons[index];
	const std::span<const glm::dvec3> corners = cornersOf(volumes.occluders, polygon);
	std::array<glm::dvec3, 2 * kMaxOccluderCorners> points;
	const std::span<glm::dvec3> used = std::span(points).first(2 * corners.size());
	prismOf(corners, frontOf(corners), {volumes.distance_m, polygon.two_sided, volumes.exact_bounds}, used);
	VolumeBox box;
	for (const glm::dvec3 point : used)
	{
		box.least = glm::min(box.least, point);
		box.most = glm::max(box.most, point);
	}
	return box;
}

void clusterVolumes(VolumeSet& volumes, const ClusterSettings& settings, const RunSettings& run)
{
	assert(settings.polygons >= 1 && settings.polygons <= 2048);
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
	std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return items[a].size_class > items[b].size_class; });

	std::vector<std::size_t> ends;
	const Sorter sorter(items, settings.polygons);
	for (std::size_t first = 0; first < count;)
	{
		std::size_t last = first;
		while (last < count && items[order[last]].size_class == items[order[first]].size_class)
		{
			++last;
		}
		sorter.sort(std::span(order).subspan(first, last - first), first, ends);
		first = last;
	}
	volumes.occluders = reordered(volumes.occluders, order);
	volumes.clusters.assign(ends.size(), {});
	const auto bound = [&](std::size_t i)
	{
		VolumeCluster& cluster = volumes.clusters[i];
		const std::size_t first = i == 0 ? 0 : ends[i - 1];
		VolumeBox box;
		for (std::size_t polygon = first; polygon < ends[i]; ++polygon)
		{
			const VolumeBox one = volumeBox(volumes, polygon);
			box.least = glm::min(box.least, one.least);
			box.most = glm::max(box.most, one.most);
		}
		cluster = {static_cast<uint32_t>(first), static_cast<uint32_t>(ends[i] - first), box.least, box.most};
	};
	parallelFor(ends.size(), run.threads, bound);
}

} // namespace nook
