// SPDX-License-Identifier: GPL-3.0-or-later
// Evaluates the occlusion of polygons' volumes at receivers with the shared kernels (*.glsl); Embree's point queries find the
// volumes that contain a point. Thread-safe.
#pragma once

#include "core/progress.h"
#include "scene/reference.h"
#include "volume/volumes.h"

#include <glm/vec3.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace nook
{

struct VolumeReceiver
{
	glm::dvec3 position; // world, metres
	glm::dvec3 normal;   // unit
	double bias_m = 0.0; // polygons whose plane is within this, at least kVolumeBias · δ, are ignored, for inexact positions
};

struct VolumeShare
{
	uint32_t polygon = 0;
	float occlusion = 0.0F; // g · form factor, > 0
	float height_m = 0.0F;  // distance of the point from the polygon's plane
	float outside_m = 0.0F; // beyond its edges, ≥ 0
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
	// Keeps a reference to the set, which must outlive this object. `masks`: mask() will be called.
	VolumeEvaluator(const VolumeSet& volumes, const RunSettings& run, bool masks = false);
	~VolumeEvaluator();
	VolumeEvaluator(const VolumeEvaluator&) = delete;
	VolumeEvaluator& operator=(const VolumeEvaluator&) = delete;

	// Sums over all volumes of g · form factor (AOV eqs. 4 and 5), neither clamped nor compensated. `roughly` takes polygons that
	// are seven radii away as points. Sums that have reached `enough` may be left there. Receivers in a row are best close to one
	// another.
	void sums(std::span<const VolumeReceiver> receivers, std::span<VolumeSum> sums, bool roughly = false,
			  double enough = std::numeric_limits<double>::infinity()) const;

	// Likewise at one point with a unit normal.
	double occlusion(glm::dvec3 position, glm::dvec3 normal) const;

	// The terms of these sums, roughly.
	void shares(std::span<const VolumeReceiver> receivers, std::span<std::vector<VolumeShare>> shares) const;

	// Fraction of the directions of a frame about the normal (directions.h, mask.glsl) that no polygon within reach covers. δ then
	// equals the radius of the equivalent reference with linear falloff. Same requirements as maskDirections.
	VolumeMask mask(glm::dvec3 position, glm::dvec3 normal, int directions, double bias_m = 0.0) const;

private:
	struct Data;
	std::unique_ptr<Data> m_data;
};

// Visibility at points by the volumes of a file: by a mask of directions, 32 to 256, or, with 0, by their sum and curve.
using VisibilityAtPoints = std::function<std::vector<double>(std::span<const ReferencePoint> points)>;
VisibilityAtPoints visibilityByVolumes(const std::string& path, int directions, const RunSettings& run);

} // namespace nook
