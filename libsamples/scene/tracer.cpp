// SPDX-License-Identifier: GPL-3.0-or-later
// Rays by Embree 3 (I. Wald, S. Woop, C. Benthin, G. Johnson, M. Ernst, "Embree: A Kernel Framework for Efficient CPU Ray
// Tracing", 2014).
//
// Rays run in 32 bits around the centre of the level's box; R is the largest coordinate there. The error of the distance between a
// ray's origin and a plane of the level, with u = 2⁻²⁴ and lengths of at most 2R: rounding the vertices u·R, rounding the origin
// u·R, the difference vertex − origin 2u·R, the scalar product with the normal and the normal's own rounding 12u·R to first order
// (three products and two sums, of factors that are off by 2u), rounding the direction 7u·R by the time the ray leaves the level.
// Together 23u·R for each of the three axes.
//
// The last bits of 32 depend on the processor: Embree takes other instructions on each, with a fused multiply-add or without. So
// none of them decides. The tree holds triangles that are a little larger than the level's, so that no rounding loses a hit; what
// may lie near an edge, near the end of the reach or beside another surface is met again in double, and that counts.
#include "scene/tracer.h"

#include "core/error.h"
#include "core/parallel.h"
#include "core/round.h"
#include "scene/embree_device.h"
#include "scene/ray_triangle.h"

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
	std::vector<uint32_t> triangles; // of the level
	std::vector<glm::uvec3> corners; // of the larger ones: 0 1 2, 3 4 5, ...
	std::vector<float> vertices;     // of them, 3 each around the centre, and one number that Embree may read beyond the end
	std::vector<float> margins;      // barycentric weights above which a hit is one of the level's triangle, too
};

bool isOpaque(const Material& material)
{
	return material.alpha_mode == AlphaMode::opaque || material.coverage >= 1.0;
}

// What one ray of a bundle has met.
struct Met
{
	double t = std::numeric_limits<double>::infinity();
	uint32_t primitive = 0; // of its part
	bool hit = false;
	bool masked = false;
	bool exact = false; // else t is Embree's, and on the triangle for certain
	bool front = false; // the counter-clockwise side; known in the end
};

// What Embree hands to the filters: the rays in double.
struct Bundle
{
	RTCIntersectContext embrees; // first: Embree takes this for the whole
	glm::dvec3 origin{0.0};
	double reach = 0.0;
	float surely = 0.0F;                    // within reach, whatever the last bits say
	const Directions* directions = nullptr; // of several rays, whose ids are their places
	glm::dvec3 direction{0.0};              // of one
	bool passes_masks = false;              // masked surfaces let it through wherever it meets them
	std::span<Met> met;                     // by ray; empty where any hit ends a ray, or refine() follows

	glm::dvec3 directionOf(unsigned id) const
	{
		return directions == nullptr ? direction : glm::dvec3(glm::vec3(directions->x[id], directions->y[id], directions->z[id]));
	}
};

// Of every thread: the rays of one bundle.
template <class Ray> std::vector<Ray>& scratch()
{
	thread_local std::vector<Ray> rays;
	return rays;
}

Bundle bundleOf(glm::dvec3 origin, double reach, float surely)
{
	Bundle bundle{{}, origin, reach, surely, nullptr, {}, false, {}};
	rtcInitIntersectContext(&bundle.embrees);
	return bundle;
}

} // namespace

struct Tracer::Data
{
	const Level& level;
	glm::dvec3 centre{0.0};
	double error = 0.0;
	Bounds bounds; // of the level
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
	RTCRay rayOf(glm::dvec3 origin, glm::dvec3 direction, double reach) const;
	bool isSolid(uint32_t triangle, double b, double c) const;
	RayHit refine(glm::dvec3 origin, glm::dvec3 direction, const RTCRayHit& found) const;
	void add(Part& part, uint32_t triangle) const;
	double slackAt(double t) const // by how much t may differ in 32 bits, on a surface that is not met at a grazing angle
	{
		return 1e-5 * t + 8.0 * error;
	}
	bool meets(const Bundle& bundle, const Part& part, unsigned primitive, unsigned id, double& t) const;
	bool isNearer(const Bundle& bundle, Met& met, const Met& other, unsigned id) const;
	template <bool is_masked> static void filter(const RTCFilterFunctionNArguments* arguments);
	template <bool is_masked> static bool isMet(const RTCFilterFunctionNArguments* arguments, unsigned n, unsigned i);
	std::span<const Met> nearestOf(glm::dvec3 origin, const Directions& directions, float reach) const;
	template <class Ray> Bundle aim(std::vector<Ray>& rays, glm::dvec3 origin, const Directions& directions, float reach) const;
};

namespace
{

constexpr unsigned kOpaqueId = 0;
constexpr unsigned kMaskedId = 1;

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

// Does a ray meet a triangle of a part, within its reach; and at which t.
bool Tracer::Data::meets(const Bundle& bundle, const Part& part, unsigned primitive, unsigned id, double& t) const
{
	const uint32_t triangle = part.triangles[primitive];
	const PlaneHit hit = meet(level, triangle, bundle.origin, bundle.directionOf(id));
	t = hit.t;
	return isInside(hit) && hit.t <= bundle.reach && (&part == &opaque || isSolid(triangle, hit.b, hit.c));
}

// Is another triangle nearer than the one that a ray has met; in double where 32 bits do not tell.
bool Tracer::Data::isNearer(const Bundle& bundle, Met& met, const Met& other, unsigned id) const
{
	if (!met.hit || other.t < met.t - slackAt(met.t))
	{
		return true;
	}
	if (other.t > met.t + slackAt(met.t))
	{
		return false;
	}
	const auto exactly = [&](Met& one)
	{
		if (!one.exact)
		{
			meets(bundle, one.masked ? masked : opaque, one.primitive, id, one.t);
			one.exact = true;
		}
	};
	Met exact = other;
	exactly(met);
	exactly(exact);
	const auto triangleOf = [&](const Met& one)
	{
		return (one.masked ? masked : opaque).triangles[one.primitive];
	};
	return exact.t < met.t || (exact.t == met.t && triangleOf(exact) < triangleOf(met));
}

// Embree's filter function: leaves of its hits those that are some of the level's triangles, and of their masks.
template <bool is_masked> void Tracer::Data::filter(const RTCFilterFunctionNArguments* arguments)
{
	const unsigned n = arguments->N;
	for (unsigned i = 0; i < n; ++i)
	{
		// One at a time is what streams of single rays ask; known to be 1, it saves what packets need.
		if (arguments->valid[i] == -1 && !(n == 1 ? isMet<is_masked>(arguments, 1, 0) : isMet<is_masked>(arguments, n, i)))
		{
			arguments->valid[i] = 0;
		}
	}
}

template <bool is_masked> bool Tracer::Data::isMet(const RTCFilterFunctionNArguments* arguments, unsigned n, unsigned i)
{
	const Data& data = *static_cast<const Data*>(arguments->geometryUserPtr);
	const Bundle& bundle = *reinterpret_cast<const Bundle*>(arguments->context);
	const Part& part = is_masked ? data.masked : data.opaque;
	if (is_masked && bundle.passes_masks)
	{
		return false;
	}
	const unsigned primitive = RTCHitN_primID(arguments->hit, n, i);
	const float b = RTCHitN_u(arguments->hit, n, i);
	const float c = RTCHitN_v(arguments->hit, n, i);
	float& tfar = RTCRayN_tfar(arguments->ray, n, i);
	const bool is_sure = !is_masked && std::min({b, c, 1.0F - b - c}) > part.margins[primitive] && tfar < bundle.surely;
	if (is_sure && bundle.met.empty())
	{
		return true;
	}
	const unsigned id = RTCRayN_id(arguments->ray, n, i);
	Met found{static_cast<double>(tfar), primitive, true, is_masked, !is_sure};
	if (!is_sure && !data.meets(bundle, part, primitive, id, found.t))
	{
		return false;
	}
	if (bundle.met.empty())
	{
		return true;
	}
	Met& met = bundle.met[id];
	if (!data.isNearer(bundle, met, found, id))
	{
		return false;
	}
	met = found;
	tfar += static_cast<float>(data.slackAt(met.t)); // what lies just behind it, by 32 bits, is asked for, too
	return true;
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
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		const Material& material = level.material_list[level.materials[i]];
		if (material.coverage > 0.0) // else it is never there: clear glass
		{
			Part& part = isOpaque(material) ? opaque : masked;
			add(part, static_cast<uint32_t>(i));
		}
	}
}

void Tracer::Data::add(Part& part, uint32_t triangle) const
{
	// Along a surface rounding moves less than through it: no more than 20u·R, of the vertices, the origin and two products. And
	// what is larger by less than a ray's origin is lifted keeps that out of its boxes, which half of the time goes by.
	const LargerTriangle larger = enlarge(level, triangle, 0.5 * error);
	const auto first = static_cast<uint32_t>(part.vertices.size() / 3);
	for (const glm::dvec3& corner : larger.corners)
	{
		const glm::vec3 p = local(corner);
		part.vertices.insert(part.vertices.end(), {p.x, p.y, p.z});
	}
	part.corners.emplace_back(first, first + 1, first + 2);
	part.triangles.push_back(triangle);
	part.margins.push_back(static_cast<float>(larger.margin));
}

void Tracer::Data::attach(Part& part, unsigned id)
{
	if (part.corners.empty())
	{
		return;
	}
	part.vertices.push_back(0.0F);
	RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, part.vertices.data(), 0, 3 * sizeof(float),
							   3 * part.corners.size());
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, part.corners.data(), 0, sizeof(glm::uvec3),
							   part.corners.size());
	rtcSetGeometryUserData(geometry, this);
	rtcSetGeometryIntersectFilterFunction(geometry, id == kMaskedId ? filter<true> : filter<false>);
	rtcSetGeometryOccludedFilterFunction(geometry, id == kMaskedId ? filter<true> : filter<false>);
	rtcCommitGeometry(geometry);
	rtcAttachGeometryByID(scene, geometry, id);
	rtcReleaseGeometry(geometry);
}

Tracer::Tracer(const Level& level, const RunSettings& run) : m_data(std::make_unique<Data>(level))
{
	assert(!level.triangles.empty() && run.threads >= 1);
	const ProgressCounter stage(run.progress, "tree");
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

// Of several surfaces at one distance Embree's hit is whichever its tree holds first. So all triangles around it are met in double.
RayHit Tracer::Data::refine(glm::dvec3 origin, glm::dvec3 direction, const RTCRayHit& found) const
{
	const uint32_t first = (found.hit.geomID == kOpaqueId ? opaque : masked).triangles[found.hit.primID];
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
	if (best.hit)
	{
		return best;
	}
	if (beside.hit)
	{
		return beside; // between two triangles, by less than 64 bits tell: the one that it misses by least
	}
	const double b = std::clamp(of_first.b, 0.0, 1.0);
	return {true, t, first, {b, std::clamp(of_first.c, 0.0, 1.0 - b)}, of_first.rise < 0.0};
}

RayHit Tracer::nearest(glm::dvec3 origin, glm::dvec3 direction, double reach) const
{
	const double slack = 1e-5 * reach + 8.0 * m_data->error / glm::length(direction);
	RTCRayHit ray{m_data->rayOf(origin, direction, reach + slack), {}};
	ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
	ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
	Bundle bundle = bundleOf(origin, reach, static_cast<float>(reach - slack));
	bundle.direction = direction;
	rtcIntersect1(m_data->scene, &bundle.embrees, &ray);
	return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? RayHit{} : m_data->refine(origin, direction, ray);
}

// Fills in the rays, each as far as rounding may move a surface at the end of its reach.
template <class Ray>
Bundle Tracer::Data::aim(std::vector<Ray>& rays, glm::dvec3 origin, const Directions& directions, float reach) const
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
	Bundle bundle = bundleOf(origin, static_cast<double>(reach), reach - most);
	bundle.directions = &directions;
	// The rays of a hemisphere part at once: on Embree 3.13 the stream of single rays is 1.3 to 1.9 times as fast as packets or
	// the coherent stream (nook_bench_rays measures all forms).
	bundle.embrees.flags = RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
	return bundle;
}

// What each ray meets first, all in double.
std::span<const Met> Tracer::Data::nearestOf(glm::dvec3 origin, const Directions& directions, float reach) const
{
	std::vector<RTCRayHit>& rays = scratch<RTCRayHit>();
	std::vector<Met>& met = scratch<Met>();
	met.assign(directions.x.size(), {});
	Bundle bundle = aim(rays, origin, directions, reach);
	bundle.met = met;
	rtcIntersect1M(scene, &bundle.embrees, rays.data(), static_cast<unsigned>(met.size()), sizeof(RTCRayHit));
	for (std::size_t i = 0; i < met.size(); ++i)
	{
		if (met[i].hit)
		{
			const Part& part = met[i].masked ? masked : opaque;
			const PlaneHit hit =
				meet(level, part.triangles[met[i].primitive], origin, bundle.directionOf(static_cast<unsigned>(i)));
			met[i].t = hit.t;
			met[i].front = hit.rise < 0.0;
		}
	}
	return met;
}

void Tracer::distances(glm::dvec3 origin, const Directions& directions, float reach, std::span<float> distances) const
{
	const std::span<const Met> met = m_data->nearestOf(origin, directions, reach);
	std::transform(met.begin(), met.end(), distances.begin(), [](const Met& one) { return static_cast<float>(one.t); });
}

void Tracer::sides(glm::dvec3 origin, const Directions& directions, std::span<int8_t> sides) const
{
	const std::span<const Met> met = m_data->nearestOf(origin, directions, std::numeric_limits<float>::max());
	std::transform(met.begin(), met.end(), sides.begin(),
				   [](const Met& one) { return !one.hit || one.masked ? int8_t{0}
											   : one.front            ? int8_t{1}
																	  : int8_t{-1}; });
}

void Tracer::blocked(glm::dvec3 origin, const Directions& directions, float reach, std::span<uint8_t> blocked) const
{
	std::vector<RTCRay>& rays = scratch<RTCRay>();
	Bundle bundle = m_data->aim(rays, origin, directions, reach);
	rtcOccluded1M(m_data->scene, &bundle.embrees, rays.data(), static_cast<unsigned>(blocked.size()), sizeof(RTCRay));
	std::transform(rays.begin(), rays.begin() + static_cast<std::ptrdiff_t>(blocked.size()), blocked.begin(),
				   [](const RTCRay& ray) { return ray.tfar < 0.0F ? uint8_t{1} : uint8_t{0}; });
}

bool Tracer::blocked(glm::dvec3 from, glm::dvec3 to) const
{
	const glm::dvec3 way = to - from;
	const double slack = 1e-5 + 8.0 * m_data->error / glm::length(way);
	RTCRay ray = m_data->rayOf(from, way, 1.0 + slack);
	Bundle bundle = bundleOf(from, 1.0, static_cast<float>(1.0 - slack));
	bundle.direction = way;
	bundle.passes_masks = true;
	rtcOccluded1(m_data->scene, &bundle.embrees, &ray);
	return ray.tfar < 0.0F;
}

} // namespace nook
