// SPDX-License-Identifier: GPL-3.0-or-later
// Occluder polygons → what their volumes take from a receiver, by the shared kernels (*.glsl); the volumes that hold it are found
// by Embree's point queries. Queries may come from any thread.
#pragma once

#include "core/progress.h"
#include "volume/volumes.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace nook
{

struct VolumeShare
{
	uint32_t polygon = 0;
	float occlusion = 0.0F; // g · form factor, > 0
};

class VolumeEvaluator
{
public:
	// Keeps a reference to the set, which must outlive it.
	VolumeEvaluator(const VolumeSet& volumes, const RunSettings& run);
	~VolumeEvaluator();
	VolumeEvaluator(const VolumeEvaluator&) = delete;
	VolumeEvaluator& operator=(const VolumeEvaluator&) = delete;

	// Sum over all volumes of g · form factor (AOV eqs. 4 and 5) at a point with a unit normal, world space; neither clamped nor
	// compensated. Added in the order of the polygons.
	double occlusion(glm::dvec3 position, glm::dvec3 normal) const;

	// What it is the sum of, in the order of the polygons.
	void shares(glm::dvec3 position, glm::dvec3 normal, std::vector<VolumeShare>& shares) const;

	// Of the directions of a frame about the normal (aov_directions.h) those that no polygon within reach covers, by weight.
	double maskedVisibility(glm::dvec3 position, glm::dvec3 normal, int directions) const;

private:
	struct Data;
	std::unique_ptr<Data> m_data;
};

} // namespace nook
