// SPDX-License-Identifier: GPL-3.0-or-later
// The region that one side of an occluder polygon may darken, and the triangles that reach into it. In double precision and
// conservative: what is just outside counts as inside.
#pragma once

#include "scene/level.h"
#include "volume/volumes.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

// Bounding-box tree over a level's triangles that finds those reaching into a convex volume. In double precision, so that nothing
// is missed.

// Inside: normal · x ≥ offset.
struct HalfSpace
{
	glm::dvec3 normal{0.0}; // unit
	double offset = 0.0;
};

class TriangleTree
{
public:
	// Contains the triangles with counted[i] ≠ 0. Same tree for any thread count.
	TriangleTree(const Level& level, std::span<const uint8_t> counted, int threads);

	// Calls visit(triangle), until it returns false, for every triangle whose box intersects `box` and is not entirely outside one
	// of the half-spaces; returns false if visit did. Roughly in order of distance from `centre`.
	template <class Visit> bool visit(const Bounds& box, std::span<const HalfSpace> volume, glm::dvec3 centre, Visit&& visit) const;

private:
	struct Range;
	class Builder;
	struct Node
	{
		glm::dvec3 least;
		glm::dvec3 most;
		uint32_t first = 0; // leaves: index into m_triangles
		uint32_t count = 0; // 0: inner; its children are the next node and `first`
	};

	// Squared distance of a node's box from a point.
	static double distance2(const Node& node, glm::dvec3 point)
	{
		const glm::dvec3 off = glm::max(glm::dvec3(0.0), glm::max(node.least - point, point - node.most));
		return glm::dot(off, off);
	}
	static bool meets(const Node& node, const Bounds& box, std::span<const HalfSpace> volume);

	std::vector<Node> m_nodes;
	std::vector<uint32_t> m_triangles;
};

inline bool TriangleTree::meets(const Node& node, const Bounds& box, std::span<const HalfSpace> volume)
{
	for (int axis = 0; axis < 3; ++axis)
	{
		if (node.most[axis] < box.least[axis] || node.least[axis] > box.most[axis])
		{
			return false;
		}
	}
	for (const HalfSpace& half : volume)
	{
		// The corner furthest along the normal.
		const double x = half.normal.x * (half.normal.x > 0.0 ? node.most.x : node.least.x);
		const double y = half.normal.y * (half.normal.y > 0.0 ? node.most.y : node.least.y);
		const double z = half.normal.z * (half.normal.z > 0.0 ? node.most.z : node.least.z);
		if (x + y + z < half.offset)
		{
			return false;
		}
	}
	return true;
}

template <class Visit>
bool TriangleTree::visit(const Bounds& box, std::span<const HalfSpace> volume, glm::dvec3 centre, Visit&& visit) const
{
	std::array<uint32_t, 64> stack{}; // 2³² triangles have a depth of 32
	std::size_t size = 0;
	if (!m_nodes.empty())
	{
		stack[size++] = 0;
	}
	while (size > 0)
	{
		const uint32_t at = stack[--size];
		const Node& node = m_nodes[at];
		if (!meets(node, box, volume))
		{
			continue;
		}
		if (node.count == 0)
		{
			const bool swap = distance2(m_nodes[node.first], centre) < distance2(m_nodes[at + 1], centre);
			stack[size++] = swap ? at + 1 : node.first;
			stack[size++] = swap ? node.first : at + 1;
			continue;
		}
		for (uint32_t i = 0; i < node.count; ++i)
		{
			if (!visit(m_triangles[node.first + i]))
			{
				return false;
			}
		}
	}
	return true;
}

// Receivers within this fraction of δ of a polygon's plane are not darkened by it.
inline constexpr double kPlaneBias = 1e-4;

// A polygon counts as above a tangent plane if it rises by more than this fraction of δ. A polygon that rises less and is at least
// kPlaneBias · δ away covers at most the lowest 0.01 rad of the hemisphere: a form factor of at most sin² 0.01 = 1e-4.
inline constexpr double kRise = 1e-6;

struct VolumeRegion
{
	std::array<HalfSpace, kMaxOccluderCorners + 2> halves;
	std::size_t count = 0;
	Bounds box;
	double distance_m = 1.0; // δ

	std::span<const HalfSpace> planes() const
	{
		return {halves.data(), count};
	}
};

// Region of the side that `front` (unit, perpendicular to the polygon) points to; corners counter-clockwise seen from `winding`,
// which is front or −front. Unless exact, limited to 2δ from the nearest corner on each axis.
VolumeRegion regionOf(std::span<const glm::dvec3> corners, glm::dvec3 front, glm::dvec3 winding, double distance_m,
					  bool exact_bounds);

// True if some point of the triangle is in the region.
bool reaches(const VolumeRegion& region, const std::array<glm::dvec3, 3>& triangle);

// A side of a triangle as receiver.
struct ReceiverSide
{
	std::array<glm::dvec3, 3> corners;
	glm::dvec3 flat{0.0};               // unit
	std::array<glm::dvec3, 3> smooth{}; // vertex normals flipped to this side; 0 without them
	bool has_smooth = false;
	bool mixed = false; // the normals disagree about the side, so nothing is known in between
};

// `side`: 0 front, 1 back. False for a triangle without area.
bool receiverSide(const Level& level, uint32_t triangle, int side, bool smooth_normals, ReceiverSide& receiver);

// Upper bound in metres of how far the polygon's highest corner rises above the tangent plane of any point of the triangle. With
// interpolated normals: for n = Σ bᵢ nᵢ at x = Σ bⱼ pⱼ, n · (c − x) is a quadratic form of the weights b, at most the greatest of
// its Bernstein coefficients ½ (nᵢ·(c − pⱼ) + nⱼ·(c − pᵢ)), and n is at least as long as the least √(nᵢ·nⱼ). 1e300 if nothing is
// known.
double riseOf(std::span<const glm::dvec3> polygon, const ReceiverSide& receiver);

// Upper bound of g · form factor (AOV eqs. 4 and 5, with alpha) at any point of that triangle in the region, for a polygon of that
// area that rises by `rise_m`.
double greatestShare(const VolumeRegion& region, std::span<const glm::dvec3> polygon, double area_m2, double alpha,
					 const ReceiverSide& receiver, double rise_m);

} // namespace nook
