// SPDX-License-Identifier: GPL-3.0-or-later
// Occluder polygons → what their volumes take from a receiver, by the shared kernels (*.glsl); the volumes that hold it are found
// by Embree's point queries. Queries may come from any thread.
#pragma once

#include "core/progress.h"
#include "volume/volumes.h"

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace nook
{

struct VolumeShare
{
	uint32_t polygon = 0;
	float occlusion = 0.0F; // g · form factor, > 0
};

struct VolumeSum
{
	double occlusion = 0.0; // of all volumes, neither clamped nor compensated
	uint32_t volumes = 0;   // that hold the point
};

struct VolumeMask
{
	double visibility = 1.0;
	uint32_t volumes = 0; // that hold the point
};

// Nothing is darkened by a polygon whose plane is nearer than this share of δ.
inline constexpr double kVolumeBias = 1e-4;

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

	// The same, counted; no polygon counts whose plane is within `bias_m`, at least kVolumeBias · δ: for positions that are not
	// exact.
	VolumeSum sum(glm::dvec3 position, glm::dvec3 normal, double bias_m) const;

	// What it is the sum of, in the order of the polygons.
	void shares(glm::dvec3 position, glm::dvec3 normal, std::vector<VolumeShare>& shares) const;

	// Share of the directions of a frame about the normal (directions.h, mask.glsl) that no polygon within reach covers. δ is then
	// the radius of the reference with linear falloff that it stands for. Requires as maskDirections.
	double maskedVisibility(glm::dvec3 position, glm::dvec3 normal, int directions) const;
	VolumeMask mask(glm::dvec3 position, glm::dvec3 normal, std::span<const glm::vec4> directions, double bias_m) const;

private:
	struct Data;
	std::unique_ptr<Data> m_data;
};

} // namespace nook
