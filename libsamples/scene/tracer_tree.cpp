// SPDX-License-Identifier: GPL-3.0-or-later
// Builds Embree's tree from a level's triangles and filters its hits. See tracer.cpp for how rounding is kept from deciding.
#include "scene/tracer_tree.h"

#include "core/parallel.h"
#include "core/round.h"
#include "core/text.h"
#include "core/words.h"
#include "scene/camera_choice.h"
#include "scene/ray_triangle.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace nook
{
namespace
{

bool isOpaque(const Material& material)
{
	return material.alpha_mode == AlphaMode::opaque || material.coverage >= 1.0;
}

} // namespace

double errorOfRays(const Bounds& bounds)
{
	const glm::dvec3 half = 0.5 * (bounds.most - bounds.least);
	return std::sqrt(3.0) * 23.0 * kUnitRoundoff * std::max({half.x, half.y, half.z});
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

// Tests whether a ray hits a triangle of a part within its reach, and at which t.
bool Tracer::Data::meets(const tracing::Bundle& bundle, const tracing::Part& part, unsigned primitive, unsigned id, double& t) const
{
	const uint32_t triangle = part.triangles[primitive];
	const PlaneHit hit = meet(level, triangle, bundle.origin, bundle.directionOf(id));
	t = hit.t;
	return isInside(hit) && hit.t <= bundle.reach && (&part == &opaque || isSolid(triangle, hit.b, hit.c));
}

// True if another triangle is nearer than the current hit; in double if 32 bits are ambiguous.
bool Tracer::Data::isNearer(const tracing::Bundle& bundle, tracing::Met& met, const tracing::Met& other, unsigned id) const
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
template <bool is_masked> void Tracer::Data::filter(const RTCFilterFunctionNArguments* arguments)
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

template <bool is_masked> bool Tracer::Data::isMet(const RTCFilterFunctionNArguments* arguments, unsigned n, unsigned i)
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

void Tracer::Data::fill(int threads, const Vicinity* near, std::span<const uint8_t> occluders)
{
	bounds = boundsOf(level);
	centre = 0.5 * (bounds.least + bounds.most);
	error = errorOfRays(bounds);
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

void Tracer::Data::place(tracing::Part& part, int threads) const
{
	const std::size_t count = part.triangles.size();
	part.corners.resize(count);
	part.vertices.resize(9 * count + 1);
	part.margins.resize(count);
	parallelForAll(count, threads,
				   [&](std::size_t i)
				   {
					   // Along a surface rounding moves less than through it: at most 20u·R, from the vertices, the origin and two
					   // products. Enlarging by less than a ray's origin is lifted keeps the origin out of these boxes, which would
					   // take half of the time.
					   const LargerTriangle larger = enlarge(level, part.triangles[i], 0.5 * error);
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

void Tracer::Data::attach(tracing::Part& part, unsigned id)
{
	if (part.corners.empty())
	{
		return;
	}
	RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, part.vertices.data(), 0, 3 * sizeof(float),
							   3 * part.corners.size());
	rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, part.corners.data(), 0, sizeof(glm::uvec3),
							   part.corners.size());
	rtcSetGeometryUserData(geometry, this);
	rtcSetGeometryIntersectFilterFunction(geometry, id == tracing::kMaskedId ? filter<true> : filter<false>);
	rtcSetGeometryOccludedFilterFunction(geometry, id == tracing::kMaskedId ? filter<true> : filter<false>);
	rtcCommitGeometry(geometry);
	rtcAttachGeometryByID(scene, geometry, id);
	rtcReleaseGeometry(geometry);
}

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
	if (device == nullptr)
	{
		refuseInput(isa == nullptr ? "Embree" : "NOOK_TEST_ISA", "no device", "instructions that Embree and this processor have",
					ExitCode::runtime);
	}
	return device;
}

} // namespace nook
