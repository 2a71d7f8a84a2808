// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates the occlusion of polygons' volumes at receivers with the shared kernels (*.glsl); Embree's point queries find the
// volumes that contain a point. Thread-safe.
#pragma once

#include "core/progress.h"
#include "volume/volumes.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
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
	double occlusion = 0.0; // sum over all volumes, neither clamped nor compensated
	uint32_t volumes = 0;   // number that contain the point
};

struct VolumeMask
{
	double visibility = 1.0;
	uint32_t volumes = 0; // number that contain the point
};

// A polygon whose plane is closer than this fraction of δ does not occlude.
inline constexpr double kVolumeBias = 1e-4;

class VolumeEvaluator
{
public:
	// Keeps a reference to the set, which must outlive this object.
	VolumeEvaluator(const VolumeSet& volumes, const RunSettings& run);
	~VolumeEvaluator();
	VolumeEvaluator(const VolumeEvaluator&) = delete;
	VolumeEvaluator& operator=(const VolumeEvaluator&) = delete;

	// Sum over all volumes of g · form factor (AOV eqs. 4 and 5) at a point with a unit normal, world space; neither clamped nor
	// compensated. Added in polygon order.
	double occlusion(glm::dvec3 position, glm::dvec3 normal) const;

	// Likewise with counts; ignores polygons whose plane is within `bias_m`, at least kVolumeBias · δ, for inexact positions.
	VolumeSum sum(glm::dvec3 position, glm::dvec3 normal, double bias_m) const;

	// The terms of that sum, in polygon order.
	void shares(glm::dvec3 position, glm::dvec3 normal, std::vector<VolumeShare>& shares) const;

	// Fraction of the directions of a frame about the normal (directions.h, mask.glsl) that no polygon within reach covers. δ then
	// equals the radius of the equivalent reference with linear falloff. Same requirements as maskDirections.
	VolumeMask mask(glm::dvec3 position, glm::dvec3 normal, int directions, double bias_m = 0.0) const;

private:
	struct Data;
	std::unique_ptr<Data> m_data;
};

// Visibility at a point with a unit normal by the volumes of a file: by a mask of directions, 32 to 256, or, with 0, by their sum
// and curve.
std::function<double(glm::dvec3 position, glm::dvec3 normal)> visibilityByVolumes(const std::string& path, int directions,
																				  const RunSettings& run);

} // namespace nook
