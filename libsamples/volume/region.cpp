// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/region.h"

#include "core/convex_clip.h"
#include "core/lists.h"
#include "core/math.h"
#include "core/parallel.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

// Grows the box by the extension of corner i: eqs. 9 to 11 of AOV without the far end, |e| = δ / sin(half of the corner's angle).
double extensionOf(glm::dvec3 before, glm::dvec3 after, double distance_m, bool exact_bounds)
{
	// The sum of two edges' inward normals has length 2 sin(angle / 2).
	const double sine = 0.5 * glm::length(before + after);
	const double length_m = distance_m / std::max(sine, 1e-9);
	return exact_bounds ? length_m : std::min(length_m, 2.0 * distance_m);
}

using Clipped = std::array<glm::dvec3, 3 + kMaxOccluderCorners + 8>; // every plane adds at most one corner

// The part of the triangle inside the region; returns its number of corners.
std::size_t clipped(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle, Clipped& shape)
{
	Clipped cut;
	std::copy(triangle.begin(), triangle.end(), shape.begin());
	std::size_t size = 3;
	const auto clip = [&](glm::dvec3 normal, double offset)
	{
		std::size_t kept = 0;
		clipConvex(
			shape.data(), size, LastEdge::first, [&](const glm::dvec3& x) { return glm::dot(normal, x) - offset; }, OnEdge{},
			[&](const glm::dvec3& x) { cut[kept++] = x; });
		std::swap(shape, cut);
		size = kept;
		return size > 0;
	};
	uint32_t cuts = 0; // planes that intersect it
	for (const HalfSpace& half : region.planes())
	{
		const double a = glm::dot(half.normal, triangle[0]);
		const double b = glm::dot(half.normal, triangle[1]);
		const double c = glm::dot(half.normal, triangle[2]);
		if (std::max({a, b, c}) < half.offset)
		{
			return 0;
		}
		cuts |= std::min({a, b, c}) < half.offset ? 1U << static_cast<unsigned>(&half - region.planes().data()) : 0U;
	}
	for (std::size_t k = 0; k < region.count; ++k)
	{
		const HalfSpace& half = region.halves[k];
		if ((cuts >> k & 1U) != 0 && !clip(half.normal, half.offset))
		{
			return 0;
		}
	}
	for (int axis = 0; axis < 3; ++axis)
	{
		glm::dvec3 along(0.0);
		along[axis] = 1.0;
		const auto [least, most] = std::minmax({triangle[0][axis], triangle[1][axis], triangle[2][axis]});
		if ((least < region.box.least[axis] && !clip(along, region.box.least[axis])) ||
			(most > region.box.most[axis] && !clip(-along, -region.box.most[axis])))
		{
			return 0;
		}
	}
	return size;
}

// Split at the median of the boxes' centres along the longest axis, down to a few triangles.
// Not Embree's tree, whose 32-bit boxes would miss what just touches a volume. Not CGAL's, whose order depends on the standard
// library's nth_element, so that a search would stop at different triangles on different systems.

constexpr std::size_t kLeaf = 4;
constexpr std::size_t kTreeBlock = 4096; // minimum triangles per thread

// The number of nodes of a subtree depends only on n, so that all positions in the list are known in advance.
std::size_t nodesOf(std::size_t n)
{
	return n <= kLeaf ? 1 : 1 + nodesOf(n / 2) + nodesOf(n - n / 2);
}

std::vector<uint32_t> indicesOf(std::span<const uint8_t> counted)
{
	return mapped(indicesWhere(counted.size(), [counted](std::size_t i) { return counted[i] != 0; }),
				  [](std::size_t i) { return static_cast<uint32_t>(i); });
}

} // namespace

VolumeRegion regionOf(std::span<const glm::dvec3> corners, glm::dvec3 front, glm::dvec3 winding, double distance_m,
					  bool exact_bounds)
{
	assert(corners.size() >= 3 && corners.size() <= kMaxOccluderCorners);
	VolumeRegion region;
	region.distance_m = distance_m;
	glm::dvec3 largest(0.0);
	for (const glm::dvec3& corner : corners)
	{
		largest = glm::max(largest, glm::abs(corner));
	}
	const double slack_m = 1e-9 * distance_m + 1e-14 * (largest.x + largest.y + largest.z);
	const auto add = [&](glm::dvec3 normal, double offset)
	{
		region.halves[region.count++] = {normal, offset - slack_m};
	};
	// Starts beyond the bias, unless rounding to 32 bits is coarser: then directly in front.
	const double height = glm::dot(front, corners[0]);
	add(front, height + 0.5 * kPlaneBias * distance_m);
	add(-front, -height - distance_m);
	const std::size_t n = corners.size();
	std::array<glm::dvec3, kMaxOccluderCorners> inward;
	for (std::size_t i = 0; i < n; ++i)
	{
		const glm::dvec3 across = glm::cross(winding, corners[(i + 1) % n] - corners[i]); // eq. 7, inward
		inward[i] = across / std::max(glm::length(across), 1e-300);
		add(inward[i], glm::dot(inward[i], corners[i]) - distance_m);
	}
	for (std::size_t i = 0; i < n; ++i)
	{
		const double extension_m = extensionOf(inward[(i + n - 1) % n], inward[i], distance_m, exact_bounds) + slack_m;
		region.box.least = glm::min(region.box.least, corners[i] - extension_m);
		region.box.most = glm::max(region.box.most, corners[i] + extension_m);
	}
	return region;
}

bool reaches(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle)
{
	Clipped shape;
	return clipped(region, triangle, shape) > 0;
}

bool receiverSide(const Level& level, uint32_t triangle, int side, bool smooth_normals, ReceiverSide& receiver)
{
	const glm::uvec3 corner = level.triangles[triangle];
	receiver.corners = {level.positions[corner.x], level.positions[corner.y], level.positions[corner.z]};
	const glm::dvec3 across = glm::cross(receiver.corners[1] - receiver.corners[0], receiver.corners[2] - receiver.corners[0]);
	const double length = glm::length(across);
	if (!(length > 0.0))
	{
		return false;
	}
	receiver.flat = across * ((side == 0 ? 1.0 : -1.0) / length);
	receiver.has_smooth = smooth_normals;
	receiver.mixed = false;
	if (smooth_normals)
	{
		int turned = 0;
		for (int i = 0; i < 3; ++i)
		{
			const auto at = static_cast<std::size_t>(i);
			receiver.smooth[at] = glm::dvec3(level.normals[corner[i]]);
			turned += glm::dot(receiver.smooth[at], receiver.flat) < 0.0 ? 1 : 0;
		}
		receiver.mixed = turned != 0 && turned != 3;
		if (turned == 3)
		{
			for (glm::dvec3& normal : receiver.smooth)
			{
				normal = -normal;
			}
		}
	}
	return true;
}

double riseOf(std::span<const glm::dvec3> polygon, const ReceiverSide& receiver)
{
	const auto& p = receiver.corners;
	double rise = -1e300;
	for (const glm::dvec3& c : polygon)
	{
		rise = std::max(rise, glm::dot(receiver.flat, c - p[0]));
	}
	if (!receiver.has_smooth)
	{
		return rise;
	}
	const auto& n = receiver.smooth;
	double shortest = 1.0;
	double smooth = -1e300;
	for (std::size_t i = 0; i < 3; ++i)
	{
		for (std::size_t j = i; j < 3; ++j)
		{
			shortest = std::min(shortest, glm::dot(n[i], n[j]));
			for (const glm::dvec3& c : polygon)
			{
				smooth = std::max(smooth, 0.5 * (glm::dot(n[i], c - p[j]) + glm::dot(n[j], c - p[i])));
			}
		}
	}
	if (receiver.mixed || (smooth > 0.0 && !(shortest > 0.01)))
	{
		return 1e300;
	}
	return std::max(rise, smooth > 0.0 ? smooth / std::sqrt(shortest) : smooth);
}

double greatestShare(const VolumeRegion& region, std::span<const glm::dvec3> polygon, double area_m2, double alpha,
					 const ReceiverSide& receiver, double rise_m)
{
	// Falloff: each factor of eq. 5 is linear in x, so its maximum is at one of the corners. The first half-space is the polygon's
	// plane (slightly in front), the second the far end; the others lie δ beyond the edges.
	const double distance_m = region.distance_m;
	double g = alpha;
	double least_m = 0.0;    // lower bound of the triangle's distance
	double greatest_m = 0.0; // upper bound of its distance from the polygon's plane
	for (std::size_t k = 1; k < region.count; ++k)
	{
		const HalfSpace& half = region.halves[k];
		double most = -1e300;
		for (const glm::dvec3& corner : receiver.corners)
		{
			most = std::max(most, glm::dot(half.normal, corner) - half.offset);
		}
		g *= std::clamp(most / distance_m, 0.0, 1.0);
		least_m = std::max(least_m, distance_m - most);
	}
	for (const glm::dvec3& corner : receiver.corners)
	{
		greatest_m = std::max(greatest_m, glm::dot(region.halves[0].normal, corner) - region.halves[0].offset);
	}
	greatest_m = std::min(greatest_m, distance_m) + kPlaneBias * distance_m;
	// Distance between the two boxes.
	const Bounds box = boundsAround(polygon);
	const Bounds part = boundsAround(receiver.corners);
	const glm::dvec3 apart = glm::max(glm::dvec3(0.0), glm::max(box.least - part.most, part.least - box.most));
	least_m = std::max({least_m, glm::length(apart), 0.5 * kPlaneBias * distance_m});
	// Form factor = ∫ cos θ cos θ' / (π r²) dA with cos θ ≤ rise / r and cos θ' ≤ height / r; the lowest part of the hemisphere, up
	// to the elevation asin(rise / r), contributes sin² of that.
	const double cosine = std::min(1.0, rise_m / least_m);
	const double by_area = area_m2 * cosine * std::min(1.0, greatest_m / least_m) / (kPi * least_m * least_m);
	return g * std::min(by_area, cosine * cosine);
}

// A subtree's first node and its triangles. Empty: none.
struct TriangleTree::Range
{
	std::size_t node;
	std::size_t first;
	std::size_t last;
};

class TriangleTree::Builder
{
public:
	Builder(TriangleTree& tree, const Level& level, int threads)
		: m_nodes(tree.m_nodes), m_triangles(tree.m_triangles), m_level(level), m_middles(level.triangles.size())
	{
		inBlocks(m_triangles.size(), kTreeBlock, {threads, {}, nullptr}, nullptr,
				 [&](std::size_t i) { findMiddle(m_triangles[i]); });
	}

	// Fills one node and returns the ranges of its halves.
	std::array<Range, 2> split(const Range& range)
	{
		Node& node = m_nodes[range.node];
		findBounds(node, range);
		const std::size_t n = range.last - range.first;
		if (n <= kLeaf)
		{
			// The order left by nth_element differs between libraries.
			std::sort(at(range.first), at(range.last));
			node.first = static_cast<uint32_t>(range.first);
			node.count = static_cast<uint32_t>(n);
			return {};
		}
		const glm::dvec3 size = node.most - node.least;
		const std::size_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
		const std::size_t half = range.first + n / 2;
		std::nth_element(at(range.first), at(half), at(range.last),
						 [&](uint32_t a, uint32_t b)
						 { return m_middles[a][axis] != m_middles[b][axis] ? m_middles[a][axis] < m_middles[b][axis] : a < b; });
		const std::size_t second = range.node + 1 + nodesOf(n / 2);
		node.first = static_cast<uint32_t>(second);
		return {Range{range.node + 1, range.first, half}, Range{second, half, range.last}};
	}

	void fill(const Range& range)
	{
		for (const Range& half : split(range))
		{
			if (half.last > half.first)
			{
				fill(half);
			}
		}
	}

private:
	std::array<glm::dvec3, 3> cornersOf(uint32_t triangle) const
	{
		const glm::uvec3 corner = m_level.triangles[triangle];
		return {m_level.positions[corner.x], m_level.positions[corner.y], m_level.positions[corner.z]};
	}

	void findMiddle(uint32_t triangle)
	{
		const auto [a, b, c] = cornersOf(triangle);
		const glm::dvec3 middle = 0.5 * (glm::min(a, glm::min(b, c)) + glm::max(a, glm::max(b, c)));
		m_middles[triangle] = {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z)};
	}

	void findBounds(Node& node, const Range& range) const
	{
		node.least = glm::dvec3(1e300);
		node.most = glm::dvec3(-1e300);
		for (std::size_t i = range.first; i < range.last; ++i)
		{
			for (const glm::dvec3& corner : cornersOf(m_triangles[i]))
			{
				node.least = glm::min(node.least, corner);
				node.most = glm::max(node.most, corner);
			}
		}
	}

	std::vector<uint32_t>::iterator at(std::size_t i)
	{
		return m_triangles.begin() + static_cast<std::ptrdiff_t>(i);
	}

	std::vector<Node>& m_nodes;
	std::vector<uint32_t>& m_triangles;
	const Level& m_level;
	std::vector<std::array<float, 3>> m_middles; // only used to choose the split, so 32 bits suffice
};

TriangleTree::TriangleTree(const Level& level, std::span<const uint8_t> counted, int threads) : m_triangles(indicesOf(counted))
{
	assert(counted.size() == level.triangles.size());
	if (m_triangles.empty())
	{
		return;
	}
	m_nodes.resize(nodesOf(m_triangles.size()));
	Builder builder(*this, level, threads);
	std::vector<Range> open{{0, 0, m_triangles.size()}};
	while (open.size() < 64 && m_triangles.size() > kTreeBlock)
	{
		std::vector<Range> next(2 * open.size());
		parallelFor(open.size(), threads,
					[&](std::size_t i)
					{
						const auto halves = builder.split(open[i]);
						next[2 * i] = halves[0];
						next[2 * i + 1] = halves[1];
					});
		open = std::move(next);
	}
	parallelFor(open.size(), threads, [&](std::size_t i) { builder.fill(open[i]); });
}

} // namespace nook
