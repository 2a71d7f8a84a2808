// SPDX-License-Identifier: GPL-3.0-or-later
// What a tracer holds, between its tree with the filters (tracer_tree.cpp) and its rays (tracer.cpp).
#pragma once

#include "scene/embree_device.h"
#include "scene/tracer.h"

#include <limits>
#include <span>
#include <string>
#include <vector>

namespace nook
{
namespace tracing
{

// Triangles of one kind: either all opaque, or all with a mask that has to be asked.
struct Part
{
	std::vector<uint32_t> triangles; // of the level
	std::vector<glm::uvec3> corners; // of the larger ones: 0 1 2, 3 4 5, ...
	std::vector<float> vertices;     // of them, 3 each around the centre, and one number that Embree may read beyond the end
	std::vector<float> margins;      // barycentric weights above which a hit is one of the level's triangle, too
};

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

	void fill(int threads, const Vicinity* near);
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
	double slackAt(double t) const // by how much t may differ in 32 bits, on a surface that is not met at a grazing angle
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

} // namespace nook
