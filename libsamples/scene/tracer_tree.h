// SPDX-License-Identifier: GPL-3.0-or-later
// A tracer's data, shared by its tree and filters (tracer_tree.cpp) and its rays (tracer.cpp).
#pragma once

#include "scene/tracer.h"

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
using RTCRayQueryContext = RTCIntersectContext; // Embree 4's names
#define rtcInitRayQueryContext rtcInitIntersectContext
#endif

#include <limits>
#include <span>
#include <string>
#include <vector>

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
	Data(const Data&) = delete;
	Data& operator=(const Data&) = delete;
	~Data()
	{
		rtcReleaseScene(scene);
		rtcReleaseDevice(device);
	}

	void fill(int threads, const Vicinity* near, std::span<const uint8_t> occluders);
	void attach(tracing::Part& part, unsigned id);
	void check(const std::string& what) const;
	glm::vec3 local(glm::dvec3 position) const
	{
		return glm::vec3(position - centre);
	}
	RTCRay rayOf(glm::dvec3 origin, glm::dvec3 direction, double reach) const;
	bool isSolid(uint32_t triangle, double b, double c) const;
	RayHit refine(glm::dvec3 origin, glm::dvec3 direction, const RTCRayHit& found) const;
	void place(tracing::Part& part, int threads) const;
	double slackAt(double t) const // possible error of t in 32 bits, on a surface that is not at a grazing angle
	{
		return 1e-5 * t + 8.0 * error;
	}
	bool meets(const tracing::Bundle& bundle, const tracing::Part& part, unsigned primitive, unsigned id, double& t) const;
	bool isNearer(const tracing::Bundle& bundle, tracing::Met& met, const tracing::Met& other, unsigned id) const;
	template <bool is_masked> static void filter(const RTCFilterFunctionNArguments* arguments);
	template <bool is_masked> static bool isMet(const RTCFilterFunctionNArguments* arguments, unsigned n, unsigned i);
	std::span<const tracing::Met> nearestOf(glm::dvec3 origin, const Directions& directions, float reach) const;
	template <class Ray>
	tracing::Bundle aim(std::vector<Ray>& rays, glm::dvec3 origin, const Directions& directions, float reach) const;
};

// An Embree device. It selects code by the processor; nook's output does not depend on the choice.

// Release with rtcReleaseDevice(). The environment variable NOOK_TEST_ISA (sse2, sse4.2, avx, avx2, avx512) forces an instruction
// set, so that a test can check that all give the same result. Throws Error: usage for another name, runtime if the processor lacks
// it.
RTCDevice newEmbreeDevice();

} // namespace nook
