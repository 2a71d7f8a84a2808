// SPDX-License-Identifier: GPL-3.0-or-later
// Two sets of volumes of one level → how far they differ at sampled receivers.
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
	int views = 4;           // auto cameras
	int per_view = 1000;     // points of each, on a grid of its picture
	int by_area = 4000;      // points over the visible sides of the triangles, by area
	int near_creases = 2000; // of triangles' edges, a hundredth of δ away from them
	uint32_t seed = 1;
};

// Points of surfaces that can be seen from somewhere outside solids, with the normal of the triangle on that side. `materials`:
// what materialSides() says, where that is known already.
std::vector<ReferencePoint> sampleReceivers(const Tracer& tracer, double distance_m, const ReceiverSettings& settings,
											const RunSettings& run, const MaterialSides* materials = nullptr);

struct VerifyResult
{
	std::size_t receivers = 0;
	double greatest = 0.0;             // |sum of all volumes − sum of those kept|, before compensation
	double greatest_compensated = 0.0; // the same of what is drawn: after `kept`'s curve
	double mean = 0.0;
	double mean_compensated = 0.0;
	// Without what receivers had got from behind something opaque (hidden.h).
	double greatest_seen = 0.0;
	double greatest_seen_compensated = 0.0;
	double mean_seen = 0.0;
	std::size_t behind = 0; // receivers that had got more than kHiddenLeast from there
	double greatest_behind = 0.0;
	glm::dvec3 worst_position{0.0}; // of `greatest`
	glm::dvec3 worst_normal{0.0};
	double worst_all = 0.0; // both sums there
	double worst_kept = 0.0;
};

// Sums of VolumeEvaluator::occlusion() at points.
std::vector<double> sumsAt(const VolumeSet& volumes, std::span<const ReferencePoint> points, const RunSettings& run);

// `behind`: what each receiver gets of `all`, and should not, from behind something opaque; empty: nothing.
VerifyResult verifyVolumes(const VolumeSet& all, const VolumeSet& kept, std::span<const ReferencePoint> receivers,
						   const RunSettings& run, std::span<const double> behind = {});

} // namespace nook
