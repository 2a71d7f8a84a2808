// SPDX-License-Identifier: GPL-3.0-or-later
// Compares two sets of volumes of one level at sampled receivers.
#pragma once

#include "core/progress.h"
#include "scene/reference.h"
#include "scene/tracer.h"
#include "volume/receivers.h"
#include "volume/volumes.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace nook
{

struct ReceiverSettings
{
	int views = 4;           // automatic cameras
	int per_view = 1000;     // points per view, on a grid
	int by_area = 4000;      // points on the visible sides of the triangles, uniform by area
	int near_creases = 2000; // points next to triangles' edges, a hundredth of δ away
	uint32_t seed = 1;
};

// Surface points that can be seen from outside solids, with the triangle's normal on that side. `materials`: the result of
// materialSides(), if already known.
std::vector<ReferencePoint> sampleReceivers(const Tracer& tracer, double distance_m, const ReceiverSettings& settings,
											const RunSettings& run, const MaterialSides* materials = nullptr);

struct VerifyResult
{
	std::size_t receivers = 0;
	double greatest = 0.0;             // |sum of all volumes − sum of the kept ones|, before compensation
	double greatest_compensated = 0.0; // likewise for the drawn values, after `kept`'s curve
	double mean = 0.0;
	double mean_compensated = 0.0;
	// Excluding contributions from behind opaque surfaces (hidden.h).
	double greatest_seen = 0.0;
	double greatest_seen_compensated = 0.0;
	double mean_seen = 0.0;
	std::size_t behind = 0; // receivers with more than kHiddenLeast from behind
	double greatest_behind = 0.0;
	glm::dvec3 worst_position{0.0}; // where `greatest` occurs
	glm::dvec3 worst_normal{0.0};
	double worst_all = 0.0; // both sums there
	double worst_kept = 0.0;
};

// VolumeEvaluator::occlusion() at points.
std::vector<double> sumsAt(const VolumeSet& volumes, std::span<const ReferencePoint> points, const RunSettings& run);

// `behind`: for each receiver the part of `all` that comes from behind opaque surfaces, wrongly; empty: none.
VerifyResult verifyVolumes(const VolumeSet& all, const VolumeSet& kept, std::span<const ReferencePoint> receivers,
						   const RunSettings& run, std::span<const double> behind = {});

} // namespace nook
