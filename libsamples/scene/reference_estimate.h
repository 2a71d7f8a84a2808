// SPDX-License-Identifier: GPL-3.0-or-later
// Estimates the visibility of one point from samples around it. For reference.cpp.
#pragma once

#include "core/random.h"
#include "scene/reference.h"
#include "scene/sample_set.h"

#include <glm/mat3x3.hpp>

#include <functional>
#include <vector>

namespace nook
{

// Coordinates of many samples, and their values; one per thread.
struct Scratch
{
	std::vector<float> x, y, z, values;
	std::vector<uint8_t> blocked;

	void resize(std::size_t count)
	{
		for (std::vector<float>* v : {&x, &y, &z, &values})
		{
			v->resize(count);
		}
		blocked.resize(count);
	}
	Directions directions() const
	{
		return {x, y, z};
	}
};

// Sample sets for one run, and the order in which a point uses them.
class Batches
{
public:
	explicit Batches(const ReferenceSettings& settings);

	std::size_t count() const
	{
		return m_order.size();
	}
	const SampleSet& operator[](std::size_t i) const
	{
		return m_sets[m_order[i]];
	}

private:
	std::vector<SampleSet> m_sets;
	std::vector<std::size_t> m_order;
};

// Fills scratch.values with the occlusion in [0, 1] of one placement of the set.
using Fill = std::function<void(const SampleSet& set, Random& random, Scratch& scratch)>;

// Normalises and rounds, so that no component exceeds 1.
glm::vec3 unitOf(glm::dvec3 v);

// Offsets of the volume's samples in metres; `camera` holds the axes of the box.
void placeVolume(const ReferenceSettings& settings, glm::vec3 normal, const glm::mat3& camera, const SampleSet& set, Random& random,
				 Scratch& scratch);

// The mean over batches; a batch of n samples has weight n^1.5, since the variance of a spiral's mean decreases about as n^−1.5.
ReferenceValue estimate(const Batches& batches, const ReferenceSettings& settings, Random& random, const Fill& fill);

// Start of a point's rays. `tracer_error_m`: Tracer::error().
glm::dvec3 originOf(const ReferencePoint& point, const ReferenceSettings& settings, double tracer_error_m);

// By rays, or by samples of the volume inside the geometry; `camera` holds the axes of the box.
ReferenceValue atPoint(const Tracer& tracer, const ReferencePoint& point, const glm::mat3& camera,
					   const ReferenceSettings& settings, const Batches& batches, Random& random);

} // namespace nook
