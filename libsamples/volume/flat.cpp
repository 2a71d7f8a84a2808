// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/lists.h"
#include "volume/surface.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

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

// Constants of the region search.
struct Work
{
	const Soup& soup;
	const Surface& surface;
	const OccluderSettings& settings;
	std::span<uint32_t> labels;
	glm::dvec3 origin; // origin for heights, which preserves precision far from the world's origin

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

// All triangles reachable from `seed` that lie in its plane.
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

// This work is based on: David Douglas and Thomas Peucker, Algorithms for the Reduction of the Number of Points Required to
// Represent a Digitized Line or its Caricature, 1973.

struct Edge
{
	uint32_t from = 0;
	uint32_t to = 0;
	bool used = false;

	bool operator<(const Edge& other) const
	{
		return from != other.from ? from < other.from : to < other.to;
	}
};

// Edges without a neighbour in the region; edges with the region on both sides cancel.
std::vector<Edge> boundaryOf(const Region& region, const Surface& surface, std::span<const uint32_t> labels)
{
	std::vector<Edge> edges;
	for (const uint32_t t : region.triangles)
	{
		for (int corner = 0; corner < 3; ++corner)
		{
			const uint32_t across = surface.opposite[3 * std::size_t{t} + static_cast<std::size_t>(corner)];
			if (across == kNone || labels[across / 3] != labels[t])
			{
				edges.push_back({surface.triangles[t][corner], surface.triangles[t][(corner + 1) % 3], false});
			}
		}
	}
	std::sort(edges.begin(), edges.end());
	for (Edge& edge : edges)
	{
		const Edge reverse{edge.to, edge.from, false};
		const auto [begin, end] = std::equal_range(edges.begin(), edges.end(), reverse);
		const auto found = std::find_if(begin, end, [](const Edge& other) { return !other.used; });
		if (!edge.used && found != end)
		{
			edge.used = found->used = true;
		}
	}
	std::erase_if(edges, [](const Edge& edge) { return edge.used; });
	return edges;
}

// A measure of the clockwise angle from `from` to `to`, increasing with the angle: in (0, 4].
double clockwise(glm::dvec2 from, glm::dvec2 to)
{
	const double cosine = glm::dot(from, to) / (glm::length(from) * glm::length(to));
	const double sine = from.x * to.y - from.y * to.x;
	const double turn = sine < 0.0 ? 1.0 - cosine : 3.0 + cosine;
	return turn > 0.0 ? turn : 4.0;
}

// If several lines meet in a corner, each continues along the border of the same part of the region: clockwise from where it came.
Edge* nextEdge(std::vector<Edge>& edges, const Edge& last, const PlaneAxes& axes, std::span<const glm::dvec3> positions)
{
	const auto [begin, end] = std::equal_range(edges.begin(), edges.end(), Edge{last.to, 0, false},
											   [](const Edge& a, const Edge& b) { return a.from < b.from; });
	if (end - begin == 1)
	{
		return begin->used ? nullptr : &*begin;
	}
	const glm::dvec2 corner = axes.of(positions[last.to]);
	const glm::dvec2 back = axes.of(positions[last.from]) - corner;
	Edge* next = nullptr;
	double least = 5.0;
	for (auto edge = begin; edge != end; ++edge)
	{
		const double turn = clockwise(back, axes.of(positions[edge->to]) - corner);
		if (!edge->used && turn < least)
		{
			least = turn;
			next = &*edge;
		}
	}
	return next;
}

bool isBefore(glm::dvec3 a, glm::dvec3 b)
{
	return a.x != b.x ? a.x < b.x : (a.y != b.y ? a.y < b.y : a.z < b.z);
}

double squareFrom(glm::dvec3 point, glm::dvec3 begin, glm::dvec3 end)
{
	const glm::dvec3 along = end - begin;
	const double square = glm::dot(along, along);
	const double share = square > 0.0 ? std::clamp(glm::dot(point - begin, along) / square, 0.0, 1.0) : 0.0;
	const glm::dvec3 offset = point - begin - share * along;
	return glm::dot(offset, offset);
}

class Line
{
public:
	Line(const Loop& loop, double flat_m, std::span<const glm::dvec3> positions)
		: m_loop(loop), m_positions(positions), m_square(flat_m * flat_m), m_stays(loop.size(), 0)
	{
	}

	Loop simplified()
	{
		std::vector<std::size_t> anchors = sharpCorners();
		if (anchors.size() < 2)
		{
			anchors = farCorners();
		}
		for (std::size_t i = 0; i < anchors.size(); ++i)
		{
			m_stays[anchors[i]] = 1;
			const std::size_t end = i + 1 < anchors.size() ? anchors[i + 1] : anchors[0] + m_loop.size();
			split(anchors[i], end);
		}
		return mapped(indicesWhere(m_loop.size(), [this](std::size_t i) { return m_stays[i] != 0; }),
					  [this](std::size_t i) { return m_loop[i]; });
	}

private:
	glm::dvec3 at(std::size_t i) const
	{
		return m_positions[m_loop[i % m_loop.size()]];
	}

	std::vector<std::size_t> sharpCorners() const
	{
		return indicesWhere(m_loop.size(),
							[&](std::size_t i) { return squareFrom(at(i), at(i + m_loop.size() - 1), at(i + 1)) > m_square; });
	}

	// The least corner and the one farthest from it.
	std::vector<std::size_t> farCorners() const
	{
		std::size_t least = 0;
		for (std::size_t i = 1; i < m_loop.size(); ++i)
		{
			least = isBefore(at(i), at(least)) ? i : least;
		}
		std::size_t far = least;
		for (std::size_t i = 0; i < m_loop.size(); ++i)
		{
			far = glm::distance(at(i), at(least)) > glm::distance(at(far), at(least)) ? i : far;
		}
		return least < far ? std::vector{least, far} : std::vector{far, least};
	}

	void split(std::size_t begin, std::size_t end)
	{
		std::vector<std::pair<std::size_t, std::size_t>> open{{begin, end}};
		while (!open.empty())
		{
			const auto [from, to] = open.back();
			open.pop_back();
			double most = m_square;
			std::size_t farthest = 0;
			for (std::size_t i = from + 1; i < to; ++i)
			{
				const double square = squareFrom(at(i), at(from), at(to));
				if (square > most)
				{
					most = square;
					farthest = i;
				}
			}
			if (farthest != 0)
			{
				m_stays[farthest % m_loop.size()] = 1;
				open.emplace_back(from, farthest);
				open.emplace_back(farthest, to);
			}
		}
	}

	const Loop& m_loop;
	std::span<const glm::dvec3> m_positions;
	double m_square;
	std::vector<uint8_t> m_stays;
};

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

std::vector<Loop> outlineOf(const Region& region, const Surface& surface, std::span<const uint32_t> labels,
							std::span<const glm::dvec3> positions)
{
	std::vector<Edge> edges = boundaryOf(region, surface, labels);
	const PlaneAxes axes(positions[surface.triangles[region.triangles[0]].x], region.normal);
	std::vector<Loop> loops;
	for (Edge& start : edges)
	{
		if (start.used)
		{
			continue;
		}
		Loop loop;
		for (Edge* edge = &start; edge != nullptr && !edge->used;
			 edge = edge->to == start.from ? nullptr : nextEdge(edges, *edge, axes, positions))
		{
			edge->used = true;
			loop.push_back(edge->from);
			if (edge->to != start.from && nextEdge(edges, *edge, axes, positions) == nullptr)
			{
				return {}; // a dead end
			}
		}
		loops.push_back(std::move(loop));
	}
	return loops;
}

void simplifyOutline(std::vector<Loop>& loops, glm::dvec3 normal, double flat_m, std::span<const glm::dvec3> positions)
{
	for (Loop& loop : loops)
	{
		loop = Line(loop, flat_m, positions).simplified();
		if (loop.size() < 3)
		{
			loop.clear();
			continue;
		}
		glm::dvec3 area(0.0);
		for (std::size_t i = 1; i + 1 < loop.size(); ++i)
		{
			area += areaOf(positions, {loop[0], loop[i], loop[i + 1]});
		}
		if (glm::dot(area, normal) == 0.0)
		{
			loop.clear();
			continue;
		}
		const auto least = std::min_element(loop.begin(), loop.end(),
											[&](uint32_t a, uint32_t b) { return isBefore(positions[a], positions[b]); });
		std::rotate(loop.begin(), least, loop.end());
	}
	std::erase_if(loops, [](const Loop& loop) { return loop.empty(); });
	std::sort(loops.begin(), loops.end(),
			  [&](const Loop& a, const Loop& b)
			  {
				  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
													  [&](uint32_t i, uint32_t j) { return isBefore(positions[i], positions[j]); });
			  });
}

} // namespace nook::detail
