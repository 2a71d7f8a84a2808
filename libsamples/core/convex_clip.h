// SPDX-License-Identifier: GPL-3.0-or-later
// Clips a convex polygon (flat, or made of great circles) against a plane.
// This work is based on: I. Sutherland and G. Hodgman, "Reentrant Polygon Clipping", 1974.
#pragma once

#include <cstddef>
#include <vector>

namespace nook
{

// Position of the last edge's corner in the output. It affects the last bits of sums over corners.
enum class LastEdge
{
	first,
	last
};

// The point at fraction t of the edge from a to b.
struct OnEdge
{
	template <class Corner> Corner operator()(const Corner& a, const Corner& b, double t, bool /*leaves*/) const
	{
		return a + t * (b - a);
	}
};

// Calls keep(corner) in order for each corner of the part where side(corner) ≥ 0. meet(a, b, t, leaves) makes the corner at
// fraction t of the edge from a to b; `leaves` means a is kept and b is not.
template <class Corner, class Side, class Meet, class Keep>
void clipConvex(const Corner* corners, std::size_t count, LastEdge last_edge, const Side& side, const Meet& meet, const Keep& keep)
{
	if (count == 0)
	{
		return;
	}
	const auto cross = [&](const Corner& a, double at_a, const Corner& b, double at_b)
	{
		if ((at_a >= 0.0) != (at_b >= 0.0))
		{
			keep(meet(a, b, at_a / (at_a - at_b), at_a >= 0.0));
		}
	};
	const double at_first = side(corners[0]);
	if (last_edge == LastEdge::first)
	{
		cross(corners[count - 1], side(corners[count - 1]), corners[0], at_first);
	}
	double at_a = at_first;
	for (std::size_t k = 0; k < count; ++k)
	{
		if (at_a >= 0.0)
		{
			keep(corners[k]);
		}
		if (k + 1 < count)
		{
			const double at_b = side(corners[k + 1]);
			cross(corners[k], at_a, corners[k + 1], at_b);
			at_a = at_b;
		}
	}
	if (last_edge == LastEdge::last)
	{
		cross(corners[count - 1], at_a, corners[0], at_first);
	}
}

// Replaces the polygon with its clipped part; `scratch` only saves allocations.
template <class Corner, class Side, class Meet>
void clipConvex(std::vector<Corner>& polygon, std::vector<Corner>& scratch, const Side& side, const Meet& meet)
{
	scratch.clear();
	clipConvex(polygon.data(), polygon.size(), LastEdge::last, side, meet, [&](Corner corner) { scratch.push_back(corner); });
	polygon.swap(scratch);
}

} // namespace nook
