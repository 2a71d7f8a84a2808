// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/reference_estimate.h"

#include "scene/matter.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace nook
{
namespace
{

constexpr int kFirstBatch = 32; // with max_error; each later batch is as large as all previous ones together

Scratch& scratchOfThread()
{
	thread_local Scratch scratch;
	return scratch;
}

// Two vectors that form a right-handed frame with the unit vector n (T. Duff et al., "Building an Orthonormal Basis, Revisited",
// 2017).
void frameOf(glm::vec3 n, glm::vec3& tangent, glm::vec3& bitangent)
{
	const float sign = std::copysign(1.0F, n.z);
	const float a = -1.0F / (sign + n.z);
	const float b = n.x * n.y * a;
	tangent = {1.0F + sign * n.x * n.x * a, sign * b, -sign * n.x};
	bitangent = {b, sign + n.y * n.y * a, -n.y};
}

// Rotates from coordinates about +z to coordinates about n.
void turnTo(glm::vec3 n, Scratch& scratch)
{
	glm::vec3 t;
	glm::vec3 b;
	frameOf(n, t, b);
	for (std::size_t i = 0; i < scratch.x.size(); ++i)
	{
		const float x = scratch.x[i];
		const float y = scratch.y[i];
		const float z = scratch.z[i];
		scratch.x[i] = t.x * x + b.x * y + n.x * z;
		scratch.y[i] = t.y * x + b.y * y + n.y * z;
		scratch.z[i] = t.z * x + b.z * y + n.z * z;
	}
}

// VO §4.4: mirrors samples below the tangent plane.
void foldOver(glm::vec3 n, Scratch& scratch)
{
	for (std::size_t i = 0; i < scratch.x.size(); ++i)
	{
		const float below = std::min(0.0F, scratch.x[i] * n.x + scratch.y[i] * n.y + scratch.z[i] * n.z);
		scratch.x[i] -= 2.0F * below * n.x;
		scratch.y[i] -= 2.0F * below * n.y;
		scratch.z[i] -= 2.0F * below * n.z;
	}
}

SampleDomain domainOf(ReferenceMeasure measure)
{
	switch (measure)
	{
	case ReferenceMeasure::obscurance:
	case ReferenceMeasure::bent: return SampleDomain::hemisphere;
	case ReferenceMeasure::sphere:
	case ReferenceMeasure::hemisphere: return SampleDomain::ball;
	case ReferenceMeasure::box: break;
	}
	return SampleDomain::box;
}

// Sum of the directions, each times its open fraction.
glm::dvec3 openSum(const Scratch& scratch)
{
	glm::dvec3 sum(0.0);
	for (std::size_t i = 0; i < scratch.values.size(); ++i)
	{
		sum += static_cast<double>(1.0F - scratch.values[i]) * glm::dvec3(scratch.x[i], scratch.y[i], scratch.z[i]);
	}
	return sum;
}

float falloffAt(float distance_m, const ReferenceSettings& settings, float radius_m, float u_m)
{
	if (!(distance_m < radius_m))
	{
		return 0.0F;
	}
	if (settings.falloff == Falloff::linear)
	{
		return 1.0F - distance_m / radius_m;
	}
	return distance_m <= u_m ? distance_m / u_m : u_m / distance_m;
}

void fillObscurance(const Tracer& tracer, const ReferenceSettings& settings, glm::dvec3 origin, glm::vec3 normal,
					const SampleSet& set, Random& random, Scratch& scratch)
{
	const auto radius_m = static_cast<float>(settings.radius_m);
	set.place(random, scratch.x, scratch.y, scratch.z);
	turnTo(normal, scratch);
	if (settings.falloff == Falloff::hard)
	{
		tracer.blocked(origin, scratch.directions(), radius_m, scratch.blocked);
		std::transform(scratch.blocked.begin(), scratch.blocked.end(), scratch.values.begin(),
					   [](uint8_t blocked) { return static_cast<float>(blocked); });
		return;
	}
	const auto u_m = static_cast<float>(settings.falloff_u_m);
	tracer.distances(origin, scratch.directions(), radius_m, scratch.values);
	std::transform(scratch.values.begin(), scratch.values.end(), scratch.values.begin(),
				   [&](float distance_m) { return falloffAt(distance_m, settings, radius_m, u_m); });
}

} // namespace

Batches::Batches(const ReferenceSettings& settings)
{
	assert(settings.rays >= 1 && settings.rays <= kMaxSamples && settings.radius_m > 0.0);
	int spent = 0;
	while (spent < settings.rays)
	{
		const int wanted = settings.max_error > 0.0 ? std::max(kFirstBatch, spent) : settings.rays;
		const int size = std::min(wanted, settings.rays - spent);
		if (m_sets.empty() || m_sets.back().count() != size)
		{
			m_sets.emplace_back(domainOf(settings.measure), size);
		}
		m_order.push_back(m_sets.size() - 1);
		spent += size;
	}
}

glm::vec3 unitOf(glm::dvec3 v)
{
	return glm::clamp(glm::vec3(glm::normalize(v)), -1.0F, 1.0F);
}

ReferenceValue estimate(const Batches& batches, const ReferenceSettings& settings, Random& random, const Fill& fill)
{
	Scratch& scratch = scratchOfThread();
	double weights = 0.0;
	double occlusion = 0.0;
	double squared_error = 0.0;
	glm::dvec3 open(0.0);
	ReferenceValue value;
	for (std::size_t i = 0; i < batches.count(); ++i)
	{
		const SampleSet& set = batches[i];
		scratch.resize(static_cast<std::size_t>(set.count()));
		fill(set, random, scratch);
		double sum = 0.0;
		for (const float v : scratch.values)
		{
			sum += static_cast<double>(v);
		}
		const double weight = set.count() * std::sqrt(static_cast<double>(set.count()));
		weights += weight;
		occlusion += weight * sum / set.count();
		squared_error += weight * weight * set.squaredError(scratch.values);
		if (settings.measure == ReferenceMeasure::bent)
		{
			open += weight / set.count() * openSum(scratch);
		}
		value.rays += set.count();
		value.visibility = 1.0 - occlusion / weights;
		value.standard_error = std::sqrt(squared_error) / weights;
		if (value.standard_error <= settings.max_error)
		{
			break;
		}
	}
	const double length = glm::length(open);
	value.bent = length > 0.0 ? unitOf(open) : glm::vec3(0.0F);
	return value;
}

void placeVolume(const ReferenceSettings& settings, glm::vec3 normal, const glm::mat3& camera, const SampleSet& set, Random& random,
				 Scratch& scratch)
{
	set.place(random, scratch.x, scratch.y, scratch.z);
	if (settings.measure == ReferenceMeasure::hemisphere)
	{
		foldOver(normal, scratch);
	}
	const auto radius_m = static_cast<float>(settings.radius_m);
	for (std::size_t i = 0; i < scratch.x.size(); ++i)
	{
		glm::vec3 p(scratch.x[i], scratch.y[i], scratch.z[i]);
		p = radius_m * (settings.measure == ReferenceMeasure::box ? camera * p : p);
		scratch.x[i] = p.x;
		scratch.y[i] = p.y;
		scratch.z[i] = p.z;
	}
}

glm::dvec3 originOf(const ReferencePoint& point, const ReferenceSettings& settings, double tracer_error_m)
{
	return point.position + (point.lift_m + settings.lift_m + tracer_error_m) * point.normal;
}

ReferenceValue atPoint(const Tracer& tracer, const ReferencePoint& point, const glm::mat3& camera,
					   const ReferenceSettings& settings, const Batches& batches, Random& random)
{
	const glm::dvec3 origin = originOf(point, settings, tracer.error());
	const glm::vec3 normal(point.normal);
	const Fill fill = [&](const SampleSet& set, Random& r, Scratch& scratch)
	{
		if (isByRays(settings.measure))
		{
			fillObscurance(tracer, settings, origin, normal, set, r, scratch);
			return;
		}
		placeVolume(settings, normal, camera, set, r, scratch);
		matterOfGeometry(tracer, origin, scratch.directions(), scratch.values);
	};
	ReferenceValue value = estimate(batches, settings, random, fill);
	if (settings.measure == ReferenceMeasure::bent && value.bent == glm::vec3(0.0F))
	{
		value.bent = unitOf(point.normal);
	}
	return value;
}

} // namespace nook
