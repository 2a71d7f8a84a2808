// SPDX-License-Identifier: GPL-3.0-or-later
// Rays with Embree 3 or 4 (I. Wald, S. Woop, C. Benthin, G. Johnson, M. Ernst, "Embree: A Kernel Framework for Efficient CPU Ray
// Tracing", 2014).
//
// Rays are traced in 32 bits relative to the centre of the level's bounds; R is the largest coordinate there. (Strays more than a
// thousand times as far away do not count, so rays from them are less precise.) The error of the distance between a ray's origin
// and a plane of the level, with u = 2⁻²⁴ and lengths of at most 2R: rounding the vertices u·R, rounding the origin u·R, the
// difference vertex − origin 2u·R, the scalar product with the normal and the normal's own rounding 12u·R to first order (three
// products and two sums, of factors that are off by 2u), rounding the direction 7u·R by the time the ray leaves the level. Together
// 23u·R for each of the three axes.
//
// The last of the 32 bits depend on the processor, because Embree selects instructions with or without fused multiply-add. So they
// must not decide anything. The tree holds slightly enlarged triangles, so that rounding loses no hit; hits near an edge, near the
// end of the reach or next to another surface are recomputed in double, which decides.
#include "scene/tracer.h"

#include "core/parallel.h"
#include "core/round.h"
#include "core/text.h"
#include "core/words.h"
#include "scene/camera_choice.h"
#include "scene/ray_triangle.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string_view>

// Embree 4, or 3 with the names of 4.
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
using RTCRayQueryContext = RTCIntersectContext;
#define rtcInitRayQueryContext rtcInitIntersectContext
#endif

namespace nook
{
namespace tracing
{

// Triangles of one kind: all opaque, or all with a mask to evaluate.
struct Part
{
	std::vector<uint32_t> triangles; // in the level
	std::vector<glm::uvec3> corners; // of the enlarged triangles: 0 1 2, 3 4 5, ...
	std::vector<float> vertices;     // their vertices, 3 each relative to the centre, and one extra number that Embree may read
	std::vector<float> margins;      // barycentric weights above which a hit also lies on the level's triangle
};

// Hit of one ray of a bundle.
struct Met
{
	double t = std::numeric_limits<double>::infinity();
	uint32_t primitive = 0; // index in its part
	bool hit = false;
	bool masked = false;
	bool exact = false; // otherwise t is Embree's, and the hit is certainly on the triangle
	bool front = false; // counter-clockwise side; set at the end
};

// Passed to Embree's filters: the rays in double.
struct Bundle
{
	RTCRayQueryContext embrees; // must be first: Embree only knows this member
	glm::dvec3 origin{0.0};
	double reach = 0.0;
	float surely = 0.0F;                    // within reach for any rounding
	const Directions* directions = nullptr; // for several rays, indexed by their ids
	glm::dvec3 direction{0.0};              // for a single ray
	bool passes_masks = false;              // ignore masked surfaces
	std::span<Met> met;                     // by ray; empty if any hit ends a ray, or if refine() follows

	glm::dvec3 directionOf(unsigned id) const
	{
		return directions == nullptr ? direction : glm::dvec3(glm::vec3(directions->x[id], directions->y[id], directions->z[id]));
	}
};

inline constexpr unsigned kOpaqueId = 0;
inline constexpr unsigned kMaskedId = 1;

} // namespace tracing

namespace
{

bool isOpaque(const Material& material)
{
	return material.alpha_mode == AlphaMode::opaque || material.coverage >= 1.0;
}

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

// It selects code by the processor; nook's output does not depend on the choice. The environment variable NOOK_TEST_ISA (sse2,
// sse4.2, avx, avx2, avx512) forces an instruction set, so that a test can check that all give the same result. Throws Error: usage
// for another name, runtime if the processor lacks it.
RTCDevice newEmbreeDevice()
{
	const char* const isa = std::getenv("NOOK_TEST_ISA");
	// Embree itself ignores unknown names.
	constexpr std::array<std::string_view, 5> kSets{"sse2", "sse4.2", "avx", "avx2", "avx512"};
	if (isa != nullptr && std::find(kSets.begin(), kSets.end(), isa) == kSets.end())
	{
		refuseInput("NOOK_TEST_ISA", "'" + oneLine(isa) + "'", "sse2, sse4.2, avx, avx2 or avx512", ExitCode::usage);
	}
	RTCDevice device = rtcNewDevice(isa == nullptr ? "" : ("isa=" + std::string(isa)).c_str());
	refuseInputIf(device == nullptr, isa == nullptr ? "Embree" : "NOOK_TEST_ISA", "no device",
				  "instructions that Embree and this processor have", ExitCode::runtime);
	return device;
}

constexpr double kCellsOfReach = 4.0; // smaller cells are tighter, but there are more of them
constexpr double kMostCells = 1 << 18;

// `from_centre`: the largest coordinates.
double errorAt(glm::dvec3 from_centre)
{
	return std::sqrt(3.0) * 23.0 * kUnitRoundoff * std::max({from_centre.x, from_centre.y, from_centre.z});
}

} // namespace

// The tree, and the filters of its hits.

double errorOfRays(const Bounds& bounds)
{
	return errorAt(0.5 * (bounds.most - bounds.least));
}

struct Tracer::Data
{
	const Level& level;
	glm::dvec3 centre{0.0};
	double error = 0.0;
	Bounds bounds; // of the level
	tracing::Part opaque;
	tracing::Part masked;
	RTCDevice device = nullptr;
	RTCScene scene = nullptr;

	explicit Data(const Level& of) : level(of) {}
	Data& operator=(Data&&) = delete;
	~Data()
	{
		rtcReleaseScene(scene);
		rtcReleaseDevice(device);
	}

	glm::vec3 local(glm::dvec3 position) const
	{
		return glm::vec3(position - centre);
	}
	double slackAt(double t) const // possible error of t in 32 bits, on a surface that is not at a grazing angle
	{
		return 1e-5 * t + 8.0 * error;
	}

	bool isSolid(uint32_t triangle, double b, double c) const
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

	// Tests whether a ray hits a triangle of a part within its reach, and at which t.
	bool meets(const tracing::Bundle& bundle, const tracing::Part& part, unsigned primitive, unsigned id, double& t) const
	{
		const uint32_t triangle = part.triangles[primitive];
		const PlaneHit hit = meet(level, triangle, bundle.origin, bundle.directionOf(id));
		t = hit.t;
		return isInside(hit) && hit.t <= bundle.reach && (&part == &opaque || isSolid(triangle, hit.b, hit.c));
	}

	// True if another triangle is nearer than the current hit; in double if 32 bits are ambiguous.
	bool isNearer(const tracing::Bundle& bundle, tracing::Met& met, const tracing::Met& other, unsigned id) const
	{
		if (!met.hit || other.t < met.t - slackAt(met.t))
		{
			return true;
		}
		if (other.t > met.t + slackAt(met.t))
		{
			return false;
		}
		const auto exactly = [&](tracing::Met& one)
		{
			if (!one.exact)
			{
				meets(bundle, one.masked ? masked : opaque, one.primitive, id, one.t);
				one.exact = true;
			}
		};
		tracing::Met exact = other;
		exactly(met);
		exactly(exact);
		const auto triangleOf = [&](const tracing::Met& one)
		{
			return (one.masked ? masked : opaque).triangles[one.primitive];
		};
		return exact.t < met.t || (exact.t == met.t && triangleOf(exact) < triangleOf(met));
	}

	// Embree's filter function: accepts only hits that lie on the level's triangles and are solid in their masks.
	template <bool is_masked> static void filter(const RTCFilterFunctionNArguments* arguments)
	{
		const unsigned n = arguments->N;
		for (unsigned i = 0; i < n; ++i)
		{
			// Streams of single rays always have n = 1; knowing that avoids the packet code.
			if (arguments->valid[i] == -1 && !(n == 1 ? isMet<is_masked>(arguments, 1, 0) : isMet<is_masked>(arguments, n, i)))
			{
				arguments->valid[i] = 0;
			}
		}
	}

	template <bool is_masked> static bool isMet(const RTCFilterFunctionNArguments* arguments, unsigned n, unsigned i)
	{
		const Data& data = *static_cast<const Data*>(arguments->geometryUserPtr);
		const tracing::Bundle& bundle = *reinterpret_cast<const tracing::Bundle*>(arguments->context);
		const tracing::Part& part = is_masked ? data.masked : data.opaque;
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
		tracing::Met found{static_cast<double>(tfar), primitive, true, is_masked, !is_sure};
		if (!is_sure && !data.meets(bundle, part, primitive, id, found.t))
		{
			return false;
		}
		if (bundle.met.empty())
		{
			return true;
		}
		tracing::Met& met = bundle.met[id];
		if (!data.isNearer(bundle, met, found, id))
		{
			return false;
		}
		met = found;
		tfar += static_cast<float>(data.slackAt(met.t)); // also accepts what is just behind by 32 bits
		return true;
	}

	void check(const std::string& what) const
	{
		const RTCError code = rtcGetDeviceError(device);
		refuseIf(code != RTC_ERROR_NONE,
				 level.name + ": " + what + ": Embree " +
					 (code == RTC_ERROR_OUT_OF_MEMORY ? std::string("found no memory left")
													  : "failed with code " + std::to_string(code)) +
					 ", expected a tree of " + std::to_string(level.triangles.size()) + " triangles",
				 ExitCode::runtime);
	}

	void fill(int threads, const Vicinity* near, std::span<const uint8_t> occluders)
	{
		bounds = boundsOf(level);
		const Bounds precise = preciseBounds(level);
		centre = 0.5 * (precise.least + precise.most);
		error = errorOfRays(precise);
		opaque.triangles.reserve(level.triangles.size());
		for (std::size_t i = 0; i < level.triangles.size(); ++i)
		{
			const Material& material = level.material_list[level.materials[i]];
			// Otherwise it is entirely transparent, such as clear glass, or out of reach of all rays.
			if (material.coverage > 0.0 && (near == nullptr || near->touches(boundsOf(level, i))) &&
				(occluders.empty() || occluders[i] != 0))
			{
				(isOpaque(material) ? opaque : masked).triangles.push_back(static_cast<uint32_t>(i));
			}
		}
		place(opaque, threads);
		place(masked, threads);
	}

	void place(tracing::Part& part, int threads) const
	{
		const std::size_t count = part.triangles.size();
		part.corners.resize(count);
		part.vertices.resize(9 * count + 1);
		part.margins.resize(count);
		parallelForAll(count, threads,
					   [&](std::size_t i)
					   {
						   // Along a surface rounding moves less than through it: at most 20u·R, from the vertices, the origin and
						   // two products. Enlarging by less than a ray's origin is lifted keeps the origin out of these boxes,
						   // which would take half of the time.
						   const Bounds box = boundsOf(level, part.triangles[i]);
						   const glm::dvec3 away = glm::max(glm::abs(box.least - centre), glm::abs(box.most - centre));
						   const LargerTriangle larger = enlarge(level, part.triangles[i], 0.5 * std::max(error, errorAt(away)));
						   float* to = part.vertices.data() + 9 * i;
						   for (const glm::dvec3& corner : larger.corners)
						   {
							   const glm::vec3 p = local(corner);
							   to = std::copy_n(std::array{p.x, p.y, p.z}.data(), 3, to);
						   }
						   const auto first = static_cast<uint32_t>(3 * i);
						   part.corners[i] = {first, first + 1, first + 2};
						   part.margins[i] = static_cast<float>(larger.margin);
					   });
	}

	void attach(tracing::Part& part, unsigned id)
	{
		if (part.corners.empty())
		{
			return;
		}
		RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
		rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, part.vertices.data(), 0,
								   3 * sizeof(float), 3 * part.corners.size());
		rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, part.corners.data(), 0, sizeof(glm::uvec3),
								   part.corners.size());
		rtcSetGeometryUserData(geometry, this);
		rtcSetGeometryIntersectFilterFunction(geometry, id == tracing::kMaskedId ? filter<true> : filter<false>);
		rtcSetGeometryOccludedFilterFunction(geometry, id == tracing::kMaskedId ? filter<true> : filter<false>);
		rtcCommitGeometry(geometry);
		rtcAttachGeometryByID(scene, geometry, id);
		rtcReleaseGeometry(geometry);
	}

	RTCRay rayOf(glm::dvec3 origin, glm::dvec3 direction, double reach) const
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

	// Among surfaces at the same distance Embree returns whichever its tree visits first. So all triangles nearby are intersected
	// in double.
	RayHit refine(glm::dvec3 origin, glm::dvec3 direction, const RTCRayHit& found) const
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

	// Fills in the rays, extended by how far rounding may move a surface at the end of the reach.
	template <class Ray>
	tracing::Bundle aim(std::vector<Ray>& rays, glm::dvec3 origin, const Directions& directions, float reach) const
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
	std::span<const tracing::Met> nearestOf(glm::dvec3 origin, const Directions& directions, float reach) const
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
};

Tracer::Tracer(const Level& level, const RunSettings& run, const Vicinity* near, std::span<const uint8_t> occluders)
	: m_data(std::make_unique<Data>(level)), m_cameras(std::make_shared<CameraMemo>())
{
	assert(!level.triangles.empty() && run.threads >= 1 && (occluders.empty() || occluders.size() == level.triangles.size()));
	const ProgressCounter stage(run.progress, "tree");
	Data& data = *m_data;
	data.fill(run.threads, near, occluders);
	data.device = newEmbreeDevice();
	data.scene = rtcNewScene(data.device);
	rtcSetSceneFlags(data.scene, RTC_SCENE_FLAG_ROBUST); // watertight along shared edges
	rtcSetSceneBuildQuality(data.scene, RTC_BUILD_QUALITY_MEDIUM);
	data.attach(data.opaque, tracing::kOpaqueId);
	data.attach(data.masked, tracing::kMaskedId);
	// Embree's own thread count would apply to the whole process.
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

// The rays.

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
