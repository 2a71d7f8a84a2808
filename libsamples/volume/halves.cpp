// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/halves.h"

#include "volume/prism.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <utility>

namespace nook::detail
{
namespace
{

using Corners = std::vector<glm::dvec3>;

// The part of a convex polygon where along · x ≤ limit, or ≥ with negative arguments. Corners within `near_m` of the cut are on it.
Corners partBelow(const Corners& corners, glm::dvec3 along, double limit, double near_m)
{
	Corners part;
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const glm::dvec3 a = corners[i];
		const glm::dvec3 b = corners[(i + 1) % corners.size()];
		const double from = glm::dot(along, a) - limit;
		const double to = glm::dot(along, b) - limit;
		if (from <= near_m)
		{
			part.push_back(a);
		}
		if ((from < -near_m && to > near_m) || (from > near_m && to < -near_m))
		{
			// From the same end in both parts: the same corner.
			part.push_back(from < 0.0 ? a + (b - a) * (from / (from - to)) : b + (a - b) * (to / (to - from)));
		}
	}
	return part;
}

// Along the longest edge, and across it.
std::pair<glm::dvec3, glm::dvec3> axesOf(std::span<const glm::dvec3> corners)
{
	glm::dvec3 edge(0.0);
	for (std::size_t i = 0; i < corners.size(); ++i)
	{
		const glm::dvec3 side = corners[(i + 1) % corners.size()] - corners[i];
		edge = glm::dot(side, side) > glm::dot(edge, edge) ? side : edge;
	}
	const glm::dvec3 x = glm::normalize(edge);
	return {x, glm::cross(frontOf(corners), x)};
}

} // namespace

double halvesOf(std::span<const glm::dvec3> corners, double longest_m)
{
	const auto is_near = [&](glm::dvec3 corner)
	{
		return 4.0 * glm::dot(corner - corners[0], corner - corners[0]) <= longest_m * longest_m;
	};
	if (std::all_of(corners.begin(), corners.end(), is_near))
	{
		return 1.0;
	}
	const auto [x, y] = axesOf(corners);
	double count = 1.0;
	for (const glm::dvec3 axis : {x, y})
	{
		double least = 0.0;
		double most = 0.0;
		for (const glm::dvec3 corner : corners)
		{
			least = std::min(least, glm::dot(axis, corner - corners[0]));
			most = std::max(most, glm::dot(axis, corner - corners[0]));
		}
		for (double length = most - least; length > longest_m && count < 1e15; length *= 0.5)
		{
			count *= 2.0;
		}
	}
	return count;
}

std::vector<std::vector<glm::dvec3>> halvedPolygon(std::span<const glm::dvec3> corners, double longest_m, std::size_t most_corners)
{
	const auto [x, y] = axesOf(corners);
	const glm::dvec3 origin = corners[0]; // far from the world's, positions have few digits left
	Corners whole;
	for (const glm::dvec3 corner : corners)
	{
		whole.push_back(corner - origin);
	}
	const double near_m = 1e-9 * longest_m;
	std::vector<Corners> open{whole};
	std::vector<Corners> done;
	while (!open.empty())
	{
		Corners piece = std::move(open.back());
		open.pop_back();
		glm::dvec3 along(0.0);
		double middle = 0.0;
		double longest = 0.0;
		for (const glm::dvec3 axis : {x, y})
		{
			double least = 1e300;
			double most = -1e300;
			for (const glm::dvec3 corner : piece)
			{
				least = std::min(least, glm::dot(axis, corner));
				most = std::max(most, glm::dot(axis, corner));
			}
			if (most - least > longest)
			{
				longest = most - least;
				along = axis;
				middle = 0.5 * (least + most);
			}
		}
		if (longest > longest_m || piece.size() > most_corners)
		{
			open.push_back(partBelow(piece, -along, -middle, near_m));
			open.push_back(partBelow(piece, along, middle, near_m));
		}
		else if (piece.size() >= 3)
		{
			for (glm::dvec3& corner : piece)
			{
				corner += origin;
			}
			done.push_back(std::move(piece));
		}
	}
	return done;
}

} // namespace nook::detail
