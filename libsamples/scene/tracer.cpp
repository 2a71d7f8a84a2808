// SPDX-License-Identifier: GPL-3.0-or-later
// Rays with Embree 3 or 4 (I. Wald, S. Woop, C. Benthin, G. Johnson, M. Ernst, "Embree: A Kernel Framework for Efficient CPU Ray
// Tracing", 2014).
//
// Rays are traced in 32 bits relative to the centre of the level's bounds; R is the largest coordinate there. The error of the
// distance between a ray's origin and a plane of the level, with u = 2⁻²⁴ and lengths of at most 2R: rounding the vertices u·R,
// rounding the origin u·R, the difference vertex − origin 2u·R, the scalar product with the normal and the normal's own rounding
// 12u·R to first order (three products and two sums, of factors that are off by 2u), rounding the direction 7u·R by the time the
// ray leaves the level. Together 23u·R for each of the three axes.
//
// The last of the 32 bits depend on the processor, because Embree selects instructions with or without fused multiply-add. So they
// must not decide anything. The tree holds slightly enlarged triangles, so that rounding loses no hit; hits near an edge, near the
// end of the reach or next to another surface are recomputed in double, which decides.
#include "scene/tracer.h"

#include "core/round.h"
#include "scene/ray_triangle.h"
#include "scene/tracer_tree.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

// Thread-local rays of one bundle.
template <class Ray> std::vector<Ray>& scratch()
{
	thread_local std::vector<Ray> rays;
	return rays;
}

tracing::Bundle bundleOf(glm::dvec3 origin, double reach, float surely)
{
	tracing::Bundle bundle{{}, origin, reach, surely, nullptr, {}, false, {}};
	rtcInitRayQueryContext(&bundle.embrees);
	return bundle;
}

RTCRay& withoutHit(RTCRay& ray)
{
	return ray;
}
RTCRay& withoutHit(RTCRayHit& ray)
{
	ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
	ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
	return ray.ray;
}

// Traces the rays of a bundle: RTCRayHit to the nearest hit, RTCRay to any. The rays of one hemisphere differ in direction: on
// Embree 3.13 the stream of single rays is 1.3 to 1.9 times as fast as packets or the coherent stream (nook_bench_rays measures all
// forms).
void trace(RTCScene scene, tracing::Bundle& bundle, std::span<RTCRayHit> rays)
{
#if RTC_VERSION_MAJOR >= 4 // without streams
	RTCIntersectArguments arguments;
	rtcInitIntersectArguments(&arguments);
	arguments.context = &bundle.embrees;
	for (RTCRayHit& ray : rays)
	{
		rtcIntersect1(scene, &ray, &arguments);
	}
#else
	rtcIntersect1M(scene, &bundle.embrees, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRayHit));
#endif
}
void trace(RTCScene scene, tracing::Bundle& bundle, std::span<RTCRay> rays)
{
#if RTC_VERSION_MAJOR >= 4 // without streams
	RTCOccludedArguments arguments;
	rtcInitOccludedArguments(&arguments);
	arguments.context = &bundle.embrees;
	for (RTCRay& ray : rays)
	{
		rtcOccluded1(scene, &ray, &arguments);
	}
#else
	rtcOccluded1M(scene, &bundle.embrees, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRay));
#endif
}

// Result of a point query around a hit.
struct Nearby
{
	const std::vector<uint32_t>* opaque;
	const std::vector<uint32_t>* masked;
	std::vector<uint32_t> triangles;
};

bool collect(RTCPointQueryFunctionArguments* arguments)
{
	Nearby& nearby = *static_cast<Nearby*>(arguments->userPtr);
	const std::vector<uint32_t>& of = arguments->geomID == tracing::kOpaqueId ? *nearby.opaque : *nearby.masked;
	nearby.triangles.push_back(of[arguments->primID]);
	return false;
}

constexpr double kCellsOfReach = 4.0; // smaller cells are tighter, but there are more of them
constexpr double kMostCells = 1 << 18;

} // namespace

RTCRay Tracer::Data::rayOf(glm::dvec3 origin, glm::dvec3 direction, double reach) const
{
	const glm::vec3 from = local(origin);
	const glm::vec3 way(direction);
	RTCRay ray{};
	ray.org_x = from.x;
	ray.org_y = from.y;
	ray.org_z = from.z;
	ray.dir_x = way.x;
	ray.dir_y = way.y;
	ray.dir_z = way.z;
	ray.tfar = static_cast<float>(reach);
	ray.mask = ~0U;
	return ray;
}

// Among surfaces at the same distance Embree returns whichever its tree visits first. So all triangles nearby are intersected in
// double.
RayHit Tracer::Data::refine(glm::dvec3 origin, glm::dvec3 direction, const RTCRayHit& found) const
{
	const uint32_t first = (found.hit.geomID == tracing::kOpaqueId ? opaque : masked).triangles[found.hit.primID];
	const PlaneHit of_first = meet(level, first, origin, direction);
	const double t = of_first.t;
	const double tolerance_m = 2.0 * error + 8.0 * kUnitRoundoff * t * glm::length(direction);
	Nearby nearby{&opaque.triangles, &masked.triangles, {}};
	RTCPointQueryContext context;
	rtcInitPointQueryContext(&context);
	const glm::vec3 at = local(origin + t * direction);
	RTCPointQuery query{at.x, at.y, at.z, 0.0F, static_cast<float>(tolerance_m)};
	rtcPointQuery(scene, &query, &context, collect, &nearby);

	RayHit best;
	RayHit next_best;
	double least_beyond = std::numeric_limits<double>::infinity();
	for (const uint32_t triangle : nearby.triangles)
	{
		const PlaneHit hit = meet(level, triangle, origin, direction);
		const bool inside = hit.b >= 0.0 && hit.c >= 0.0 && hit.b + hit.c <= 1.0 && hit.t >= 0.0; // false for NaN
		const bool here = std::fabs((hit.t - t) * hit.rise) <= 2.0 * tolerance_m;
		if (inside && here && (!best.hit || hit.t < best.distance || (hit.t == best.distance && triangle < best.triangle)) &&
			isSolid(triangle, hit.b, hit.c))
		{
			best = {true, hit.t, triangle, {hit.b, hit.c}, hit.rise < 0.0};
		}
		const double beyond = std::max({-hit.b, -hit.c, hit.b + hit.c - 1.0});
		if (here && (beyond < least_beyond || (beyond == least_beyond && triangle < next_best.triangle)))
		{
			least_beyond = beyond;
			const double b = std::clamp(hit.b, 0.0, 1.0);
			next_best = {true, hit.t, triangle, {b, std::clamp(hit.c, 0.0, 1.0 - b)}, hit.rise < 0.0};
		}
	}
	if (best.hit)
	{
		return best;
	}
	if (next_best.hit)
	{
		return next_best; // between two triangles, within double rounding: take the one missed by least
	}
	const double b = std::clamp(of_first.b, 0.0, 1.0);
	return {true, t, first, {b, std::clamp(of_first.c, 0.0, 1.0 - b)}, of_first.rise < 0.0};
}

RayHit Tracer::nearest(glm::dvec3 origin, glm::dvec3 direction, double reach) const
{
	const double slack = 1e-5 * reach + 8.0 * m_data->error / glm::length(direction);
	RTCRayHit ray{};
	withoutHit(ray) = m_data->rayOf(origin, direction, reach + slack);
	tracing::Bundle bundle = bundleOf(origin, reach, static_cast<float>(reach - slack));
	bundle.direction = direction;
	trace(m_data->scene, bundle, std::span(&ray, 1));
	return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? RayHit{} : m_data->refine(origin, direction, ray);
}

// Fills in the rays, extended by how far rounding may move a surface at the end of the reach.
template <class Ray>
tracing::Bundle Tracer::Data::aim(std::vector<Ray>& rays, glm::dvec3 origin, const Directions& directions, float reach) const
{
	if (rays.size() < directions.x.size())
	{
		rays.resize(directions.x.size());
	}
	const RTCRay ray = rayOf(origin, glm::dvec3(0.0), 0.0);
	const auto slack_m = static_cast<float>(16.0 * error);
	float most = 0.0F;
	for (std::size_t i = 0; i < directions.x.size(); ++i)
	{
		const float x = directions.x[i];
		const float y = directions.y[i];
		const float z = directions.z[i];
		const float no_shorter = std::fabs(x) + std::fabs(y) + std::fabs(z); // and at most 1.8 times as long
		const float slack = 1e-5F * reach + slack_m / no_shorter;
		most = std::max(most, slack);
		RTCRay& aimed = withoutHit(rays[i]);
		aimed = ray;
		aimed.dir_x = x;
		aimed.dir_y = y;
		aimed.dir_z = z;
		aimed.tfar = reach + slack;
		aimed.id = static_cast<unsigned>(i);
	}
	tracing::Bundle bundle = bundleOf(origin, static_cast<double>(reach), reach - most);
	bundle.directions = &directions;
	return bundle;
}

// The first hit of each ray, all in double.
std::span<const tracing::Met> Tracer::Data::nearestOf(glm::dvec3 origin, const Directions& directions, float reach) const
{
	std::vector<RTCRayHit>& rays = scratch<RTCRayHit>();
	std::vector<tracing::Met>& met = scratch<tracing::Met>();
	met.assign(directions.x.size(), {});
	tracing::Bundle bundle = aim(rays, origin, directions, reach);
	bundle.met = met;
	trace(scene, bundle, std::span(rays.data(), met.size()));
	for (std::size_t i = 0; i < met.size(); ++i)
	{
		if (met[i].hit)
		{
			const tracing::Part& part = met[i].masked ? masked : opaque;
			const PlaneHit hit =
				meet(level, part.triangles[met[i].primitive], origin, bundle.directionOf(static_cast<unsigned>(i)));
			met[i].t = hit.t > 0.0 ? hit.t : 0.0; // rounding may place the ray's origin just behind the surface that it hit
			met[i].front = hit.rise < 0.0;
		}
	}
	return met;
}

void Tracer::distances(glm::dvec3 origin, const Directions& directions, float reach, std::span<float> distances) const
{
	const std::span<const tracing::Met> met = m_data->nearestOf(origin, directions, reach);
	std::transform(met.begin(), met.end(), distances.begin(), [](const tracing::Met& one) { return static_cast<float>(one.t); });
}

void Tracer::sides(glm::dvec3 origin, const Directions& directions, std::span<int8_t> sides) const
{
	const std::span<const tracing::Met> met = m_data->nearestOf(origin, directions, std::numeric_limits<float>::max());
	std::transform(met.begin(), met.end(), sides.begin(),
				   [](const tracing::Met& one) { return !one.hit || one.masked ? int8_t{0}
														: one.front            ? int8_t{1}
																			   : int8_t{-1}; });
}

void Tracer::blocked(glm::dvec3 origin, const Directions& directions, float reach, std::span<uint8_t> blocked) const
{
	std::vector<RTCRay>& rays = scratch<RTCRay>();
	tracing::Bundle bundle = m_data->aim(rays, origin, directions, reach);
	trace(m_data->scene, bundle, std::span(rays.data(), blocked.size()));
	std::transform(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(blocked.size()), blocked.begin(),
				   [](const RTCRay& ray) { return ray.tfar < 0.0F ? uint8_t{1} : uint8_t{0}; });
}

bool Tracer::blocked(glm::dvec3 from, glm::dvec3 to) const
{
	const glm::dvec3 way = to - from;
	const double slack = 1e-5 + 8.0 * m_data->error / glm::length(way);
	RTCRay ray = m_data->rayOf(from, way, 1.0 + slack);
	tracing::Bundle bundle = bundleOf(from, 1.0, static_cast<float>(1.0 - slack));
	bundle.direction = way;
	bundle.passes_masks = true;
	trace(m_data->scene, bundle, std::span(&ray, 1));
	return ray.tfar < 0.0F;
}

Vicinity::Vicinity(const Bounds& bounds, double reach_m) : m_bounds(bounds), m_cell_m(reach_m / kCellsOfReach)
{
	assert(reach_m > 0.0 && bounds.least.x <= bounds.most.x);
	const glm::dvec3 size = bounds.most - bounds.least;
	const auto cellsAt = [&size](double cell_m)
	{
		return glm::floor(size / cell_m) + 1.0;
	};
	glm::dvec3 cells = cellsAt(m_cell_m);
	while (!(cells.x * cells.y * cells.z <= kMostCells))
	{
		m_cell_m *= 1.25;
		cells = cellsAt(m_cell_m);
	}
	m_cells = glm::ivec3(cells);
	// The distance between a point and what it reaches on each axis, including rounding of the last bits.
	m_reach_cells = static_cast<int>(reach_m / m_cell_m + 1e-6) + 1;
	m_size = {static_cast<std::size_t>(m_cells.x) + 1, static_cast<std::size_t>(m_cells.y) + 1,
			  static_cast<std::size_t>(m_cells.z) + 1};
	m_sums.assign(m_size[0] * m_size[1] * m_size[2], 0);
}

glm::ivec3 Vicinity::cellOf(glm::dvec3 point) const
{
	return glm::ivec3(glm::clamp((point - m_bounds.least) / m_cell_m, glm::dvec3(0.0), glm::dvec3(m_cells - 1)));
}

std::size_t Vicinity::placeOf(glm::ivec3 cell) const
{
	const auto along = [&cell](int axis)
	{
		return static_cast<std::size_t>(cell[axis] + 1);
	};
	return (along(2) * m_size[1] + along(1)) * m_size[0] + along(0);
}

void Vicinity::add(glm::dvec3 point)
{
	m_sums[placeOf(cellOf(point))] = 1;
}

void Vicinity::count()
{
	std::size_t stride = 1;
	for (const std::size_t size : m_size)
	{
		// The plane of zeros restarts the sum for each row.
		for (std::size_t i = stride; i < m_sums.size(); ++i)
		{
			m_sums[i] += i / stride % size == 0 ? 0 : m_sums[i - stride];
		}
		stride *= size;
	}
}

bool Vicinity::touches(const Bounds& box) const
{
	const glm::ivec3 least = glm::max(cellOf(box.least) - m_reach_cells, glm::ivec3(0)) - 1;
	const glm::ivec3 most = glm::min(cellOf(box.most) + m_reach_cells, m_cells - 1);
	const auto sum = [this](int x, int y, int z)
	{
		return m_sums[placeOf({x, y, z})];
	};
	// Modulo 2^32 throughout, which does not affect differences.
	return sum(most.x, most.y, most.z) - sum(least.x, most.y, most.z) - sum(most.x, least.y, most.z) -
			   sum(most.x, most.y, least.z) + sum(least.x, least.y, most.z) + sum(least.x, most.y, least.z) +
			   sum(most.x, least.y, least.z) - sum(least.x, least.y, least.z) !=
		   0;
}

} // namespace nook
