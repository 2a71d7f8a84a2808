// SPDX-License-Identifier: GPL-3.0-or-later
// Rays by Embree 3 (I. Wald, S. Woop, C. Benthin, G. Johnson, M. Ernst, "Embree: A Kernel Framework for Efficient CPU Ray
// Tracing", 2014).
//
// Rays run in 32 bits around the centre of the level's box; R is the largest coordinate there. The error of the distance between a
// ray's origin and a plane of the level, with u = 2⁻²⁴ and lengths of at most 2R: rounding the vertices u·R, rounding the origin
// u·R, the difference vertex − origin 2u·R, the scalar product with the normal and the normal's own rounding 12u·R to first order
// (three products and two sums, of factors that are off by 2u), rounding the direction 7u·R by the time the ray leaves the level.
// Together 23u·R for each of the three axes.
#include "scene/tracer.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/round.h"
#include "scene/embree_device.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace nook
{
namespace
{


// Triangles of one kind: either all opaque, or all with a mask that has to be asked.
struct Part
{
	std::vector<glm::uvec3> corners;
	std::vector<uint32_t> triangles; // of the level
};

bool isOpaque(const Material& material)
{
	return material.alpha_mode == AlphaMode::opaque || material.coverage >= 1.0;
}

// Where the line origin + t·direction meets a triangle's plane.
struct PlaneHit
{
	double t = 0.0;
	double b = 0.0; // barycentric weights of the second and third vertex
	double c = 0.0;
	double rise = 0.0; // metres along the normal for one of t; < 0: the front faces the origin
};

PlaneHit meet(const Level& level, uint32_t triangle, glm::dvec3 origin, glm::dvec3 direction)
{
	const glm::uvec3 corner = level.triangles[triangle];
	const glm::dvec3 a = level.positions[corner[0]] - origin;
	const glm::dvec3 ab = level.positions[corner[1]] - level.positions[corner[0]];
	const glm::dvec3 ac = level.positions[corner[2]] - level.positions[corner[0]];
	const glm::dvec3 normal = glm::cross(ab, ac);
	const double facing = glm::dot(direction, normal);
	const glm::dvec3 q = glm::cross(a, direction);
	return {glm::dot(a, normal) / facing, glm::dot(ac, q) / facing, -glm::dot(ab, q) / facing, facing / glm::length(normal)};
}

// Of every thread: the rays of one bundle.
template <class Ray> std::vector<Ray>& scratch()
{
	thread_local std::vector<Ray> rays;
	return rays;
}

RTCIntersectContext contextForBundles()
{
	RTCIntersectContext context;
	rtcInitIntersectContext(&context);
	// The rays of a hemisphere part at once: on Embree 3.13 the stream of single rays is 1.3 to 1.9 times as fast as packets or
	// the coherent stream (nook_bench_rays measures all forms).
	context.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
	return context;
}

} // namespace

struct Tracer::Data
{
	const Level& level;
	glm::dvec3 centre{0.0};
	double error = 0.0;
	Bounds bounds;               // of the level
	std::vector<float> vertices; // 3 a vertex around the centre, and one number that Embree may read beyond the end
	Part opaque;
	Part masked;
	RTCDevice device = nullptr;
	RTCScene scene = nullptr;

	explicit Data(const Level& of) : level(of) {}
	Data(const Data&) = delete;
	Data& operator=(const Data&) = delete;
	~Data()
	{
		rtcReleaseScene(scene);
		rtcReleaseDevice(device);
	}

	void fill();
	void attach(Part& part, unsigned id);
	void check(const std::string& what) const;
	glm::vec3 local(glm::dvec3 position) const
	{
		return glm::vec3(position - centre);
	}
	bool isSolid(uint32_t triangle, double b, double c) const;
	RayHit refine(glm::dvec3 origin, glm::dvec3 direction, const RTCRayHit& found) const;
	static void askMask(const RTCFilterFunctionNArguments* arguments);
	template <class Ray> void aim(std::vector<Ray>& rays, glm::dvec3 origin, const Directions& directions, float reach) const;
};

namespace
{

constexpr unsigned kOpaqueId = 0;
constexpr unsigned kMaskedId = 1;
constexpr unsigned kPassesMasks = 1; // a ray's own id: masked surfaces let it through wherever it meets them; else 0

RTCRay& rayOf(RTCRay& ray)
{
	return ray;
}
RTCRay& rayOf(RTCRayHit& ray)
{
	ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
	ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
	return ray.ray;
}

} // namespace

bool Tracer::Data::isSolid(uint32_t triangle, double b, double c) const
{
	const Material& material = level.material_list[level.materials[triangle]];
	if (isOpaque(material))
	{
		return true;
	}
	const glm::uvec3 corner = level.triangles[triangle];
	const glm::dvec2 uv = (1.0 - b - c) * glm::dvec2(level.uvs[corner[0]]) + b * glm::dvec2(level.uvs[corner[1]]) +
						  c * glm::dvec2(level.uvs[corner[2]]);
	return isSolidAt(level, material, uv);
}

// Embree's filter function: lets a ray through where the mask does.
void Tracer::Data::askMask(const RTCFilterFunctionNArguments* arguments)
{
	const Data& data = *static_cast<const Data*>(arguments->geometryUserPtr);
	for (unsigned i = 0; i < arguments->N; ++i)
	{
		if (RTCRayN_id(arguments->ray, arguments->N, i) == kPassesMasks)
		{
			arguments->valid[i] = 0;
		}
		if (arguments->valid[i] == -1)
		{
			const unsigned primitive = RTCHitN_primID(arguments->hit, arguments->N, i);
			const float b = RTCHitN_u(arguments->hit, arguments->N, i);
			const float c = RTCHitN_v(arguments->hit, arguments->N, i);
			if (!data.isSolid(data.masked.triangles[primitive], static_cast<double>(b), static_cast<double>(c)))
			{
				arguments->valid[i] = 0;
			}
		}
	}
}

void Tracer::Data::check(const std::string& what) const
{
	const RTCError code = rtcGetDeviceError(device);
	if (code != RTC_ERROR_NONE)
	{
		throw Error(ExitCode::runtime, level.name + ": " + what + ": Embree " +
										   (code == RTC_ERROR_OUT_OF_MEMORY ? std::string("found no memory left")
																			: "failed with code " + std::to_string(code)) +
										   ", expected a tree of " + std::to_string(level.triangles.size()) + " triangles");
	}
}

void Tracer::Data::fill()
{
	bounds = boundsOf(level);
	centre = 0.5 * (bounds.least + bounds.most);
	const glm::dvec3 half = 0.5 * (bounds.most - bounds.least);
	error = std::sqrt(3.0) * 23.0 * kUnitRoundoff * std::max({half.x, half.y, half.z});
	vertices.reserve(3 * level.positions.size() + 1);
	for (const glm::dvec3& position : level.positions)
	{
		const glm::vec3 p = local(position);
		vertices.insert(vertices.end(), {p.x, p.y, p.z});
	}
	vertices.push_back(0.0F);
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		const Material& material = level.material_list[level.materials[i]];
		if (material.coverage > 0.0) // else it is never there: clear glass
		{
			Part& part = isOpaque(material) ? opaque : masked;
			part.corners.push_back(level.triangles[i]);
			part.triangles.push_back(static_cast<uint32_t>(i));
		}
	}
}

void Tracer::Data::attach(Part& part, unsigned id)
{
	if (part.corners.empty())
	{
		return;
	}
	RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, vertices.data(), 0, 3 * sizeof(float),
							   level.positions.size());
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, part.corners.data(), 0, sizeof(glm::uvec3),
							   part.corners.size());
	if (id == kMaskedId)
	{
		rtcSetGeometryUserData(geometry, this);
		rtcSetGeometryIntersectFilterFunction(geometry, askMask);
		rtcSetGeometryOccludedFilterFunction(geometry, askMask);
	}
	rtcCommitGeometry(geometry);
	rtcAttachGeometryByID(scene, geometry, id);
	rtcReleaseGeometry(geometry);
}

Tracer::Tracer(const Level& level, const RunSettings& run) : m_data(std::make_unique<Data>(level))
{
	assert(!level.triangles.empty() && run.threads >= 1);
	Data& data = *m_data;
	data.fill();
	data.device = newEmbreeDevice();
	data.scene = rtcNewScene(data.device);
	rtcSetSceneFlags(data.scene, RTC_SCENE_FLAG_ROBUST); // watertight along shared edges
	rtcSetSceneBuildQuality(data.scene, RTC_BUILD_QUALITY_MEDIUM);
	data.attach(data.opaque, kOpaqueId);
	data.attach(data.masked, kMaskedId);
	// Embree's own number of threads would hold for the whole process.
	onThreads(run.threads, [&data] { rtcCommitScene(data.scene); });
	data.check("tree for rays");
}

Tracer::~Tracer() = default;

const Level& Tracer::level() const
{
	return m_data->level;
}

double Tracer::error() const
{
	return m_data->error;
}

const Bounds& Tracer::bounds() const
{
	return m_data->bounds;
}

namespace
{

// What a point query finds around a hit.
struct Nearby
{
	const std::vector<uint32_t>* opaque;
	const std::vector<uint32_t>* masked;
	std::vector<uint32_t> triangles;
};

bool collect(RTCPointQueryFunctionArguments* arguments)
{
	Nearby& nearby = *static_cast<Nearby*>(arguments->userPtr);
	const std::vector<uint32_t>& of = arguments->geomID == kOpaqueId ? *nearby.opaque : *nearby.masked;
	nearby.triangles.push_back(of[arguments->primID]);
	return false;
}

} // namespace

// Embree's hit is right to 32 bits, and of several surfaces at one distance it is whichever its tree holds first. So all triangles
// around it are met again in double.
RayHit Tracer::Data::refine(glm::dvec3 origin, glm::dvec3 direction, const RTCRayHit& found) const
{
	const auto t = static_cast<double>(found.ray.tfar);
	const uint32_t first = (found.hit.geomID == kOpaqueId ? opaque : masked).triangles[found.hit.primID];
	const double tolerance_m = 2.0 * error + 8.0 * kUnitRoundoff * t * glm::length(direction);
	Nearby nearby{&opaque.triangles, &masked.triangles, {}};
	RTCPointQueryContext context;
	rtcInitPointQueryContext(&context);
	const glm::vec3 at = local(origin + t * direction);
	RTCPointQuery query{at.x, at.y, at.z, 0.0F, static_cast<float>(tolerance_m)};
	rtcPointQuery(scene, &query, &context, collect, &nearby);

	RayHit best;
	RayHit beside;
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
		if (here && (beyond < least_beyond || (beyond == least_beyond && triangle < beside.triangle)))
		{
			least_beyond = beyond;
			const double b = std::clamp(hit.b, 0.0, 1.0);
			beside = {true, hit.t, triangle, {b, std::clamp(hit.c, 0.0, 1.0 - b)}, hit.rise < 0.0};
		}
	}
	// Between two triangles, by less than 32 bits tell: the one that it misses by least, and nothing of what Embree computed, which
	// differs with the processor's instructions.
	if (!best.hit && beside.hit)
	{
		return beside;
	}
	if (!best.hit)
	{
		const PlaneHit hit = meet(level, first, origin, direction);
		best = {true, t, first, {static_cast<double>(found.hit.u), static_cast<double>(found.hit.v)}, hit.rise < 0.0};
	}
	return best;
}

RayHit Tracer::nearest(glm::dvec3 origin, glm::dvec3 direction, double reach) const
{
	const glm::vec3 from = m_data->local(origin);
	RTCRayHit ray{};
	ray.ray.org_x = from.x;
	ray.ray.org_y = from.y;
	ray.ray.org_z = from.z;
	ray.ray.dir_x = static_cast<float>(direction.x);
	ray.ray.dir_y = static_cast<float>(direction.y);
	ray.ray.dir_z = static_cast<float>(direction.z);
	ray.ray.tfar = static_cast<float>(reach);
	ray.ray.mask = ~0U;
	ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
	ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
	RTCIntersectContext context;
	rtcInitIntersectContext(&context);
	rtcIntersect1(m_data->scene, &context, &ray);
	return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? RayHit{} : m_data->refine(origin, direction, ray);
}

template <class Ray>
void Tracer::Data::aim(std::vector<Ray>& rays, glm::dvec3 origin, const Directions& directions, float reach) const
{
	const glm::vec3 from = local(origin);
	if (rays.size() < directions.x.size())
	{
		rays.resize(directions.x.size());
	}
	RTCRay ray{};
	ray.org_x = from.x;
	ray.org_y = from.y;
	ray.org_z = from.z;
	ray.tfar = reach;
	ray.mask = ~0U;
	for (std::size_t i = 0; i < directions.x.size(); ++i)
	{
		ray.dir_x = directions.x[i];
		ray.dir_y = directions.y[i];
		ray.dir_z = directions.z[i];
		rayOf(rays[i]) = ray;
	}
}

void Tracer::distances(glm::dvec3 origin, const Directions& directions, float reach, std::span<float> distances) const
{
	std::vector<RTCRayHit>& rays = scratch<RTCRayHit>();
	m_data->aim(rays, origin, directions, reach);
	RTCIntersectContext context = contextForBundles();
	rtcIntersect1M(m_data->scene, &context, rays.data(), static_cast<unsigned>(distances.size()), sizeof(RTCRayHit));
	for (std::size_t i = 0; i < distances.size(); ++i)
	{
		const RTCHit& found = rays[i].hit;
		if (found.geomID == RTC_INVALID_GEOMETRY_ID)
		{
			distances[i] = std::numeric_limits<float>::infinity();
			continue;
		}
		// Met again in double: the last bits of Embree's differ with the processor's instructions.
		const uint32_t triangle = (found.geomID == kOpaqueId ? m_data->opaque : m_data->masked).triangles[found.primID];
		const glm::dvec3 direction(glm::vec3(directions.x[i], directions.y[i], directions.z[i]));
		const double t = meet(m_data->level, triangle, origin, direction).t;
		const double embrees = static_cast<double>(rays[i].ray.tfar);
		distances[i] = std::fabs(t - embrees) <= 1e-3 * embrees ? static_cast<float>(t) : rays[i].ray.tfar; // else it lies within the plane
	}
}

void Tracer::sides(glm::dvec3 origin, const Directions& directions, std::span<int8_t> sides) const
{
	std::vector<RTCRayHit>& rays = scratch<RTCRayHit>();
	m_data->aim(rays, origin, directions, std::numeric_limits<float>::infinity());
	RTCIntersectContext context = contextForBundles();
	rtcIntersect1M(m_data->scene, &context, rays.data(), static_cast<unsigned>(sides.size()), sizeof(RTCRayHit));
	for (std::size_t i = 0; i < sides.size(); ++i)
	{
		const RTCHit& hit = rays[i].hit;
		const RTCRay& ray = rays[i].ray;
		// Embree's normal points to the counter-clockwise side.
		const float along = hit.Ng_x * ray.dir_x + hit.Ng_y * ray.dir_y + hit.Ng_z * ray.dir_z;
		sides[i] = hit.geomID != kOpaqueId ? int8_t{0} : along < 0.0F ? int8_t{1} : int8_t{-1};
	}
}

void Tracer::blocked(glm::dvec3 origin, const Directions& directions, float reach, std::span<uint8_t> blocked) const
{
	std::vector<RTCRay>& rays = scratch<RTCRay>();
	m_data->aim(rays, origin, directions, reach);
	RTCIntersectContext context = contextForBundles();
	rtcOccluded1M(m_data->scene, &context, rays.data(), static_cast<unsigned>(blocked.size()), sizeof(RTCRay));
	for (std::size_t i = 0; i < blocked.size(); ++i)
	{
		blocked[i] = rays[i].tfar < 0.0F ? 1 : 0;
	}
}

bool Tracer::blocked(glm::dvec3 from, glm::dvec3 to) const
{
	const glm::vec3 origin = m_data->local(from);
	const glm::vec3 way(to - from);
	RTCRay ray{};
	ray.org_x = origin.x;
	ray.org_y = origin.y;
	ray.org_z = origin.z;
	ray.dir_x = way.x;
	ray.dir_y = way.y;
	ray.dir_z = way.z;
	ray.tfar = 1.0F;
	ray.mask = ~0U;
	ray.id = kPassesMasks;
	RTCIntersectContext context;
	rtcInitIntersectContext(&context);
	rtcOccluded1(m_data->scene, &context, &ray);
	return ray.tfar < 0.0F;
}

} // namespace nook
