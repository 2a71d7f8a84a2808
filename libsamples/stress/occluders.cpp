// SPDX-License-Identifier: GPL-3.0-or-later
// The builder of polygons: small levels of flat pieces in any number of triangles, far from the origin, with needles and
// duplicates.
#include "volume/occluders.h"

#include "core/error.h"
#include "stress/case.h"
#include "stress/form_factor_twin.h"
#include "stress/numbers.h"
#include "volume/prism.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nook::stress
{
namespace
{

uint32_t addVertex(Level& level, const glm::dvec3& position)
{
	level.positions.push_back(position);
	level.normals.emplace_back(0.0F);
	level.uvs.emplace_back(0.0F);
	return static_cast<uint32_t>(level.positions.size() - 1);
}

// A flat grid of m × n cells, some of them missing, lines at any distance of each other.
void addGrid(Case& one, Level& level, const glm::dvec3& at, const glm::dvec3& u, const glm::dvec3& v, double size)
{
	const auto columns = 1 + one.random.below(4);
	const auto rows = 1 + one.random.below(4);
	std::vector<double> xs{0.0};
	std::vector<double> ys{0.0};
	for (uint32_t i = 0; i < columns; ++i)
	{
		xs.push_back(xs.back() + size * octaves(one.random, one.random.below(4) == 0 ? -12.0 : -2.0, 0.0));
	}
	for (uint32_t i = 0; i < rows; ++i)
	{
		ys.push_back(ys.back() + size * octaves(one.random, one.random.below(4) == 0 ? -12.0 : -2.0, 0.0));
	}
	const auto first = static_cast<uint32_t>(level.positions.size());
	for (const double y : ys)
	{
		for (const double x : xs)
		{
			addVertex(level, at + x * u + y * v);
		}
	}
	const uint32_t wide = columns + 1;
	for (uint32_t cell = 0; cell < columns * rows; ++cell)
	{
		if (cell > 0 && one.random.below(5) == 0)
		{
			continue;
		}
		const uint32_t a = first + cell / columns * wide + cell % columns;
		const std::array<uint32_t, 4> corner{a, a + 1, a + 1 + wide, a + wide};
		const std::size_t turn = one.random.below(2); // either diagonal
		level.triangles.emplace_back(corner[turn], corner[turn + 1], corner[turn + 2]);
		level.triangles.emplace_back(corner[turn], corner[turn + 2], corner[(turn + 3) % 4]);
	}
}

Level hardLevel(Case& one, double size)
{
	Level level;
	level.name = "stress";
	level.material_list.push_back({});
	const glm::dvec3 origin = (one.random.below(2) == 0 ? 0.0 : size * octaves(one.random, 0.0, 16.0)) * hardDirection(one.random);
	const auto grids = 1 + one.random.below(3);
	for (uint32_t i = 0; i < grids; ++i)
	{
		const glm::dvec3 normal = hardDirection(one.random);
		const glm::dvec3 aside = std::fabs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
		const glm::dvec3 u = glm::normalize(glm::cross(normal, aside));
		addGrid(one, level, origin + 10.0 * size * static_cast<double>(i) * normal, u, glm::cross(normal, u), size);
	}
	level.materials.assign(level.triangles.size(), 0);
	level.meshes.push_back({"all", 0, level.triangles.size()});
	return level;
}

long double areaOf(const std::vector<glm::dvec3>& corners)
{
	Vector<long double> sum{};
	for (std::size_t i = 1; i + 1 < corners.size(); ++i)
	{
		const glm::dvec3 a = corners[i] - corners[0];
		const glm::dvec3 b = corners[i + 1] - corners[0];
		const Vector<long double> c = crossOf(wideOf(a), wideOf(b));
		for (std::size_t k = 0; k < 3; ++k)
		{
			sum[k] += c[k];
		}
	}
	return std::sqrt(dotOf(sum, sum)) / 2.0L;
}

// Convex, flat and of the area that the triangles have.
void runOccluders(Case& one)
{
	const double size = octaves(one.random, -10.0, 10.0);
	const Level level = hardLevel(one, size);
	OccluderSettings settings;
	settings.distance_m = size * octaves(one.random, -2.0, 4.0);
	settings.merge = one.random.below(8) != 0;
	settings.sides = one.random.below(2) == 0 ? Sides::automatic : Sides::oriented;
	one.note("size", size);
	one.note("distance", settings.distance_m);
	long double expected = 0.0L;
	double edges = 0.0;
	double far = 0.0;
	for (const glm::uvec3& t : level.triangles)
	{
		expected += areaOf({level.positions[t.x], level.positions[t.y], level.positions[t.z]});
		edges += glm::distance(level.positions[t.x], level.positions[t.y]) +
				 glm::distance(level.positions[t.y], level.positions[t.z]) +
				 glm::distance(level.positions[t.z], level.positions[t.x]);
		far = std::max(far, glm::length(level.positions[t.x]));
		if (one.shown())
		{
			one.note("triangle a", level.positions[t.x]);
			one.note("triangle b", level.positions[t.y]);
			one.note("triangle c", level.positions[t.z]);
		}
	}
	const Occluding found = occludersOf(level, settings, {1, {}});
	one.note("thin triangles", static_cast<int>(found.counts.thin));
	long double area = 0.0L;
	const double flat = 2.0 * std::max(settings.flat * settings.distance_m, 1e-6 * far);
	for (const Occluder& polygon : found.occluders.polygons)
	{
		const auto first = found.occluders.corners.begin() + polygon.first_corner;
		const std::vector<glm::dvec3> corners(first, first + polygon.corner_count);
		area += areaOf(corners);
		one.require("3 to 16 corners", corners.size() >= 3 && corners.size() <= kMaxOccluderCorners);
		const glm::dvec3 front = frontOf(corners);
		for (std::size_t i = 0; i < corners.size(); ++i)
		{
			const glm::dvec3 along = corners[(i + 1) % corners.size()] - corners[i];
			const glm::dvec3 inward = glm::normalize(glm::cross(front, along));
			for (const glm::dvec3& corner : corners)
			{
				one.require("flat", std::fabs(glm::dot(corner - corners[i], front)) <= flat);
				one.require("convex", glm::dot(corner - corners[i], inward) >= -flat);
			}
		}
	}
	one.result("area", static_cast<double>(area), 0.0, 1e30);
	// Outlines may lose corners that lie as near to the line between others as `flat` says: a strip along edges, as wide as that.
	one.compare("area", static_cast<double>(area), expected, flat * edges);
}

constexpr std::array kOccludersKernels{
	StressKernel{"occluders", "builders", "the triangles' area in 80 bits; flat and convex",
				 "share of the strips along edges that are as wide as `flat`", 0.2, 1, 1, runOccluders},
};

} // namespace

std::span<const StressKernel> occluderKernels()
{
	return kOccludersKernels;
}

} // namespace nook::stress
