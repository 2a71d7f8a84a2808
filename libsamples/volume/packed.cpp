// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/packed.h"

#include "core/lists.h"
#include "core/parallel.h"
#include "volume/volumes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>
#include <utility>

#define GLM_ENABLE_EXPERIMENTAL
#include <glm/gtx/hash.hpp>

namespace nook
{
namespace
{

constexpr double kMost = 65535.0;

// At least a micrometre, or a 16 384th of the reach if that is less. Finer steps than these would only cost bytes: half a step is
// less than the distance that receivers keep from a polygon's plane (1e-4 δ), and tilts a polygon that is `size_m` across by less
// than a degree.
double leastStep(double distance_m, double size_m)
{
	const double least = std::min(0x1p-20, std::ldexp(1.0, std::ilogb(distance_m) - 14));
	return std::max(least, std::ldexp(1.0, std::ilogb(std::min(distance_m * 0x1p-13, std::max(size_m * 0x1p-6, least)))));
}

// Origin and step of 16-bit coordinates. Steps are powers of two and origins multiples of them, so that coordinates that are such
// multiples are preserved, and decoding does not round.
struct Frame
{
	glm::dvec3 origin{0.0};
	glm::dvec3 step{0.0};

	Frame(const Bounds& box, double least_step)
	{
		for (int i = 0; i < 3; ++i)
		{
			step[i] = least_step;
			origin[i] = std::floor(box.least[i] / step[i]) * step[i];
			while ((box.most[i] - origin[i]) / step[i] > kMost)
			{
				step[i] *= 2.0;
				origin[i] = std::floor(box.least[i] / step[i]) * step[i];
			}
		}
	}

	glm::u16vec3 packed(glm::dvec3 point) const
	{
		glm::u16vec3 numbers;
		for (int i = 0; i < 3; ++i)
		{
			// Rounding up at the far end may exceed it, by less than a step.
			const double number = std::min(std::floor((point[i] - origin[i]) / step[i] + 0.5), kMost);
			numbers[i] = static_cast<uint16_t>(std::max(number, 0.0));
		}
		return numbers;
	}

	// The grid point, among the 27 around the nearest one, closest to the planes through the point; a small deviation along a
	// plane does not matter. Exact points are kept.
	glm::u16vec3 packedNear(glm::dvec3 point, std::span<const glm::dvec3> normals) const
	{
		constexpr double kAlong = 0.02; // weight of a deviation along a plane relative to one off the plane
		const glm::u16vec3 nearest = packed(point);
		glm::u16vec3 best = nearest;
		double least = 1e300;
		for (int i = 0; i < 27 && unpacked(glm::dvec3(nearest)) != point; ++i)
		{
			const glm::ivec3 numbers = glm::ivec3(nearest) + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
			if (std::min({numbers.x, numbers.y, numbers.z}) < 0 || std::max({numbers.x, numbers.y, numbers.z}) > 65535)
			{
				continue;
			}
			const glm::dvec3 off = unpacked(glm::dvec3(numbers)) - point;
			double cost = 0.0;
			for (const glm::dvec3 normal : normals)
			{
				cost = std::max(cost, std::fabs(glm::dot(off, normal)));
			}
			cost += kAlong * glm::length(off);
			if (cost < least)
			{
				least = cost;
				best = glm::u16vec3(numbers);
			}
		}
		return best;
	}

	glm::dvec3 unpacked(glm::dvec3 numbers) const
	{
		return origin + step * numbers;
	}
};

void store(double (&to)[3], glm::dvec3 from)
{
	std::copy_n(&from.x, 3, to);
}

void store(float (&to)[3], glm::dvec3 from)
{
	for (int i = 0; i < 3; ++i)
	{
		to[i] = static_cast<float>(from[i]);
	}
}

// Rounded outward, so that the box still contains everything.
void storeBox(nook_volumes::Cluster& cluster, const Bounds& box, glm::dvec3 origin)
{
	constexpr float kInfinite = std::numeric_limits<float>::infinity();
	store(cluster.least, box.least - origin);
	store(cluster.most, box.most - origin);
	for (int i = 0; i < 3; ++i)
	{
		cluster.least[i] = std::nextafter(cluster.least[i], -kInfinite);
		cluster.most[i] = std::nextafter(cluster.most[i], kInfinite);
	}
}

// A cluster's part of all arrays; ranges count from 0.
struct PackedPart
{
	PackedVolumes packed;
	nook_volumes::Cluster cluster{};
};

class ClusterPacker
{
public:
	ClusterPacker(const VolumeSet& volumes, const VolumeCluster& cluster, const PackSettings& settings)
		: m_volumes(volumes), m_cluster(cluster), m_settings(settings), m_least_step(leastStep(volumes.distance_m, smallSize())),
		  m_frame(cornerBox(), m_least_step)
	{
	}

	PackedPart pack()
	{
		for (const Occluder& polygon : polygons())
		{
			const glm::dvec3 front = frontOf(cornersOf(polygon));
			for (const glm::dvec3 corner : cornersOf(polygon))
			{
				m_fronts[corner].push_back(front);
			}
		}
		for (const Occluder& polygon : polygons())
		{
			add(polygon);
		}
		PackedPart part;
		const Frame points = m_points.empty() ? m_frame : Frame(m_box, m_least_step);
		store(part.cluster.origin, m_frame.origin);
		store(part.cluster.step, m_frame.step);
		storeBox(part.cluster, m_box, m_frame.origin);
		if (m_settings.prisms || m_settings.shared_corners)
		{
			store(part.cluster.vertex_origin, points.origin);
			store(part.cluster.vertex_step, points.step);
			for (std::size_t i = 0; i < m_points.size(); ++i)
			{
				const glm::u16vec3 p = points.packed(m_points[i]);
				m_made.vertices.push_back({p.x, p.y, p.z, m_polygon_of[i]});
			}
		}
		part.packed = std::move(m_made);
		return part;
	}

private:
	std::span<const Occluder> polygons() const
	{
		return std::span(m_volumes.occluders.polygons).subspan(m_cluster.first_polygon, m_cluster.polygon_count);
	}

	std::span<const glm::dvec3> cornersOf(const Occluder& polygon) const
	{
		return m_volumes.occluders.cornersOf(polygon);
	}

	Bounds cornerBox() const
	{
		Bounds box;
		for (const Occluder& polygon : polygons())
		{
			for (const glm::dvec3 corner : cornersOf(polygon))
			{
				include(box, corner);
			}
		}
		return box;
	}

	// The square root of a polygon's area, such that a tenth of the polygons are smaller.
	double smallSize() const
	{
		std::vector<double> areas =
			mapped(polygons(), [this](const Occluder& polygon) { return 0.5 * glm::length(areaVector(cornersOf(polygon))); });
		const auto tenth = areas.begin() + static_cast<std::ptrdiff_t>(areas.size() / 10);
		std::nth_element(areas.begin(), tenth, areas.end());
		return std::sqrt(*tenth);
	}

	// Polygons that meet at a corner get the same numbers for it, if these stay close to the plane of each.
	glm::u16vec3 packed(glm::dvec3 corner, glm::dvec3 front) const
	{
		const glm::u16vec3 shared = m_frame.packedNear(corner, m_fronts.at(corner));
		const double off_m = std::fabs(glm::dot(front, m_frame.unpacked(glm::dvec3(shared)) - corner));
		return off_m <= 0.5e-4 * m_volumes.distance_m ? shared : m_frame.packedNear(corner, std::span(&front, 1));
	}

	void add(const Occluder& polygon)
	{
		const std::span<const glm::dvec3> corners = cornersOf(polygon);
		const glm::dvec3 front = frontOf(corners);
		std::vector<glm::u16vec3> numbers;
		for (const glm::dvec3 corner : corners)
		{
			numbers.push_back(packed(corner, front));
			m_made.greatest_error_m =
				std::max(m_made.greatest_error_m, glm::distance(corner, m_frame.unpacked(glm::dvec3(numbers.back()))));
		}
		const std::size_t before = numbers.size();
		straighten(numbers, front);
		m_made.flat_corners += before - numbers.size();
		if (numbers.empty())
		{
			m_made.flat_polygons += 1;
			m_made.flat_area_m2 += 0.5 * glm::length(areaVector(corners));
			return;
		}
		append(polygon, numbers);
		const std::span<const glm::dvec3> made = std::span(m_corners);
		const glm::dvec3 made_front = frontOf(made);
		for (const glm::dvec3 corner : corners)
		{
			m_made.plane_error_m = std::max(m_made.plane_error_m, std::fabs(glm::dot(made_front, corner - made[0])));
		}
	}

	// Removes corners where the outline does not turn left, seen from the front, until it is convex; removes all if nothing
	// remains. Sums of products of integers and powers of two are exact, so the sign of a turn is reliable.
	void straighten(std::vector<glm::u16vec3>& numbers, glm::dvec3 front) const
	{
		for (std::size_t i = 0, good = 0; good < numbers.size() && numbers.size() >= 3;)
		{
			const std::size_t count = numbers.size();
			i %= count;
			const glm::dvec3 before = m_frame.unpacked(glm::dvec3(numbers[(i + count - 1) % count]));
			const glm::dvec3 at = m_frame.unpacked(glm::dvec3(numbers[i]));
			const glm::dvec3 after = m_frame.unpacked(glm::dvec3(numbers[(i + 1) % count]));
			if (glm::dot(glm::cross(at - before, after - at), front) > 0.0)
			{
				good += 1;
				i += 1;
				continue;
			}
			numbers.erase(numbers.begin() + static_cast<std::ptrdiff_t>(i));
			good = 0;
			i = i == 0 ? 0 : i - 1;
		}
		if (numbers.size() < 3)
		{
			numbers.clear();
		}
	}

	void append(const Occluder& polygon, const std::vector<glm::u16vec3>& numbers)
	{
		const auto index = static_cast<uint16_t>(m_made.polygons.size());
		const auto first = static_cast<uint32_t>(m_made.corners.size());
		const double alpha = std::max(1.0, std::floor(static_cast<double>(polygon.alpha) * kMost + 0.5));
		const auto cut = [](double steps, double share) // never above the input
		{
			return static_cast<unsigned>(std::clamp(std::floor(steps * (1.0 - share)), 0.0, steps - 1.0));
		};
		const unsigned flags = (cut(nook_volumes::kReachSteps, static_cast<double>(polygon.reach)) << 1U) |
							   (polygon.two_sided ? nook_volumes::kTwoSided : 0U);
		nook_volumes::Polygon& made = m_made.polygons.emplace_back(
			nook_volumes::Polygon{first, static_cast<uint8_t>(numbers.size()), static_cast<uint8_t>(flags),
								  static_cast<uint16_t>(std::min(alpha, kMost))});
		const double sides = static_cast<double>(polygon.side_reach) / nook_volumes::reachOf(made);
		made.corner_bits |= static_cast<uint8_t>(cut(nook_volumes::kSideSteps, sides) << 5U);
		std::vector<glm::dvec3>& corners = m_corners;
		corners.clear();
		for (const glm::u16vec3 p : numbers)
		{
			m_made.corners.push_back({p.x, p.y, p.z, index});
			corners.push_back(m_frame.unpacked(glm::dvec3(p)));
		}
		std::vector<glm::dvec3> points(2 * corners.size());
		Occluder kept = polygon;
		kept.reach = static_cast<float>(nook_volumes::reachOf(made));
		kept.side_reach = static_cast<float>(nook_volumes::sideReachOf(made));
		prismOf(corners, frontOf(corners), shapeOf(m_volumes, kept), points);
		for (const glm::dvec3 point : points)
		{
			include(m_box, point);
		}
		if (m_settings.prisms)
		{
			appendPrism(static_cast<uint32_t>(m_points.size()), static_cast<uint32_t>(corners.size()));
			m_points.insert(m_points.end(), points.begin(), points.end());
			m_polygon_of.insert(m_polygon_of.end(), points.size(), index);
			return;
		}
		std::vector<uint32_t> vertices = listOf(corners.size(), [&](std::size_t i) { return first + static_cast<uint32_t>(i); });
		for (std::size_t i = 0; i < corners.size() && m_settings.shared_corners; ++i)
		{
			const auto [vertex, added] = m_vertices.try_emplace(corners[i], static_cast<uint32_t>(m_made.vertices.size()));
			vertices[i] = vertex->second;
			if (added)
			{
				m_made.vertices.push_back({numbers[i].x, numbers[i].y, numbers[i].z, 0});
			}
		}
		for (std::size_t i = 2; i < corners.size(); ++i)
		{
			triangle(vertices[0], vertices[i - 1], vertices[i]);
		}
	}

	// Outward faces: the lower ring from below, the upper one from above, and two triangles per side.
	void appendPrism(uint32_t first, uint32_t count)
	{
		for (uint32_t i = 2; i < count; ++i)
		{
			triangle(first, first + i, first + i - 1);
			triangle(first + count, first + count + i - 1, first + count + i);
		}
		for (uint32_t i = 0; i < count; ++i)
		{
			const uint32_t a = first + i;
			const uint32_t b = first + (i + 1) % count;
			triangle(a, b, b + count);
			triangle(a, b + count, a + count);
		}
	}

	void triangle(uint32_t a, uint32_t b, uint32_t c)
	{
		for (const uint32_t corner : {a, b, c})
		{
			assert(corner <= 65535);
			m_made.indices.push_back(static_cast<uint16_t>(corner));
		}
	}

	const VolumeSet& m_volumes;
	const VolumeCluster& m_cluster;
	const PackSettings& m_settings;
	double m_least_step;
	Frame m_frame;
	PackedVolumes m_made;
	std::unordered_map<glm::dvec3, std::vector<glm::dvec3>> m_fronts; // of the polygons at a corner
	std::unordered_map<glm::dvec3, uint32_t> m_vertices;              // of shared corners, decoded
	std::vector<glm::dvec3> m_corners;                                // of the last polygon, decoded
	Bounds m_box;                                                     // bounds of all volume points
	std::vector<glm::dvec3> m_points;                                 // of prisms
	std::vector<uint16_t> m_polygon_of;                               // polygon of each point
};

template <class Item> void moveTo(std::vector<Item>& all, std::vector<Item>& some)
{
	all.insert(all.end(), some.begin(), some.end());
	std::vector<Item>().swap(some);
}

void append(PackedVolumes& all, PackedPart& part)
{
	PackedVolumes& some = part.packed;
	all.greatest_error_m = std::max(all.greatest_error_m, some.greatest_error_m);
	all.plane_error_m = std::max(all.plane_error_m, some.plane_error_m);
	all.flat_corners += some.flat_corners;
	all.flat_polygons += some.flat_polygons;
	all.flat_area_m2 += some.flat_area_m2;
	if (some.polygons.empty())
	{
		return;
	}
	nook_volumes::Cluster& cluster = part.cluster;
	const auto place = [](uint32_t& first, uint32_t& count, std::size_t before, std::size_t size)
	{
		first = static_cast<uint32_t>(before);
		count = static_cast<uint32_t>(size);
	};
	place(cluster.first_polygon, cluster.polygon_count, all.polygons.size(), some.polygons.size());
	place(cluster.first_corner, cluster.corner_count, all.corners.size(), some.corners.size());
	place(cluster.first_vertex, cluster.vertex_count, all.vertices.size(), some.vertices.size());
	place(cluster.first_index, cluster.index_count, all.indices.size(), some.indices.size());
	for (nook_volumes::Polygon& polygon : some.polygons)
	{
		polygon.first_corner += cluster.first_corner;
	}
	all.clusters.push_back(cluster);
	moveTo(all.polygons, some.polygons);
	moveTo(all.corners, some.corners);
	moveTo(all.vertices, some.vertices);
	moveTo(all.indices, some.indices);
}

// Sort keys of a polygon.
struct Item
{
	glm::dvec3 middle{0.0};
	int kind = 0; // polygons of different kinds never share a cluster; larger ones first
};

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
	return {0.5 * (box.least + box.most), 4 * size_class + (size_class > 0 ? axisOf(area) : 0)};
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
		const auto [least, most] = boundsAround(mapped(order, [this](uint32_t i) { return m_items[i].middle; }));
		std::size_t left = 0;
		if (order.size() > m_most)
		{
			left = halve(order, longest(most - least));
		}
		else if (const int axis = longest((most - least) / m_limit);
				 order.size() > m_fewest && most[axis] - least[axis] > m_limit[axis])
		{
			const double middle = 0.5 * (least[axis] + most[axis]);
			const auto end = std::partition(order.begin(), order.end(),
											[this, axis, middle](uint32_t i) { return m_items[i].middle[axis] < middle; });
			left = static_cast<std::size_t>(end - order.begin());
		}
		if (left == 0 || left == order.size())
		{
			sortAlongCurve(order, least, most - least);
			ends.push_back(before + order.size());
			return;
		}
		sort(order.first(left), before, ends);
		sort(order.subspan(left), before + left, ends);
	}

private:
	// Neighbours follow one another (Morton order), so compressed files are smaller.
	void sortAlongCurve(std::span<uint32_t> order, glm::dvec3 least, glm::dvec3 extent) const
	{
		const double size = std::max({extent.x, extent.y, extent.z, 1e-300});
		std::vector<std::pair<uint32_t, uint32_t>> places;
		for (const uint32_t i : order)
		{
			const glm::uvec3 cell((m_items[i].middle - least) * (1023.0 / size));
			uint32_t place = 0;
			for (int bit = 29; bit >= 0; --bit)
			{
				place = 2 * place + (cell[2 - bit % 3] >> (bit / 3) & 1U);
			}
			places.emplace_back(place, i);
		}
		std::sort(places.begin(), places.end());
		std::transform(places.begin(), places.end(), order.begin(), [](const auto& place) { return place.second; });
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
		made.add(occluders.polygons[i], occluders.cornersOf(occluders.polygons[i]));
	}
	return made;
}

} // namespace

PackedVolumes packVolumes(const VolumeSet& volumes, const PackSettings& settings, const RunSettings& run)
{
	PackedVolumes packed;
	constexpr std::size_t kBatch = 1024; // clusters held in memory twice
	for (std::size_t first = 0; first < volumes.clusters.size(); first += kBatch)
	{
		std::vector<PackedPart> parts(std::min(kBatch, volumes.clusters.size() - first));
		parallelFor(parts.size(), run.threads,
					[&](std::size_t i) { parts[i] = ClusterPacker(volumes, volumes.clusters[first + i], settings).pack(); });
		for (PackedPart& part : parts)
		{
			append(packed, part);
		}
	}
	return packed;
}

VolumeSet unpacked(const PackedVolumes& packed, VolumeSet volumes)
{
	Occluders& occluders = volumes.occluders;
	occluders = {};
	volumes.plane_error_m = std::max(volumes.plane_error_m, packed.plane_error_m);
	volumes.clusters.clear();
	occluders.corners.reserve(packed.corners.size());
	occluders.polygons.reserve(packed.polygons.size());
	for (const nook_volumes::Cluster& cluster : packed.clusters)
	{
		const glm::dvec3 origin(cluster.origin[0], cluster.origin[1], cluster.origin[2]);
		const glm::dvec3 step(cluster.step[0], cluster.step[1], cluster.step[2]);
		for (uint32_t i = cluster.first_corner; i < cluster.first_corner + cluster.corner_count; ++i)
		{
			const nook_volumes::Corner& corner = packed.corners[i];
			occluders.corners.push_back(origin + step * glm::dvec3(corner.x, corner.y, corner.z));
		}
		for (uint32_t i = cluster.first_polygon; i < cluster.first_polygon + cluster.polygon_count; ++i)
		{
			const nook_volumes::Polygon& polygon = packed.polygons[i];
			Occluder& made = occluders.polygons.emplace_back();
			made.first_corner = polygon.first_corner;
			made.corner_count = nook_volumes::cornerCountOf(polygon);
			made.alpha = static_cast<float>(static_cast<double>(polygon.alpha) / kMost);
			made.two_sided = (polygon.flags & nook_volumes::kTwoSided) != 0;
			made.reach = static_cast<float>(nook_volumes::reachOf(polygon));
			made.side_reach = static_cast<float>(nook_volumes::sideReachOf(polygon));
		}
		const glm::dvec3 least(cluster.least[0], cluster.least[1], cluster.least[2]);
		const glm::dvec3 most(cluster.most[0], cluster.most[1], cluster.most[2]);
		volumes.clusters.push_back({cluster.first_polygon, cluster.polygon_count, origin + least, origin + most});
	}
	return volumes;
}

Bounds boundsAround(std::span<const glm::dvec3> points)
{
	Bounds bounds;
	for (const glm::dvec3& point : points)
	{
		include(bounds, point);
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
	std::vector<Item> items(count);
	inBlocks(count, 4096, run, nullptr, [&](std::size_t i) { items[i] = itemOf(volumes, volumes.occluders.polygons[i]); });
	std::vector<uint32_t> order(count);
	std::iota(order.begin(), order.end(), 0U);
	std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return items[a].kind > items[b].kind; });

	std::vector<std::size_t> ends;
	const auto sort = [&](std::size_t first, std::size_t last)
	{
		const int kind = items[order[first]].kind;
		const Sorter sorter(items, settings.polygons, kind < 4 ? settings.fewest : settings.fewest_large,
							limitOf(kind, volumes.distance_m));
		sorter.sort(std::span(order).subspan(first, last - first), first, ends);
	};
	forRuns(
		order, [&](uint32_t a, uint32_t b) { return items[a].kind == items[b].kind; }, sort);
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
			include(box, one.least);
			include(box, one.most);
		}
		cluster = {static_cast<uint32_t>(first), static_cast<uint32_t>(ends[i] - first), box.least, box.most};
	};
	parallelFor(ends.size(), run.threads, bound);
}

} // namespace nook
