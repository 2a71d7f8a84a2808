// SPDX-License-Identifier: GPL-3.0-or-later
// Builds a level's ambient occlusion volumes: polygons (occluders.h), dropping unneeded ones (drop.h), trimming their reach
// (trim.h), the compensation curve (compensate.h), and verification (verify.h). Clusters are added by clusters.h.
#pragma once

#include "core/progress.h"
#include "scene/tracer.h"
#include "volume/compensate.h"
#include "volume/detail_choice.h"
#include "volume/drop.h"
#include "volume/occluders.h"
#include "volume/trim.h"
#include "volume/verify.h"
#include "volume/volumes.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

struct VolumeSettings
{
	double distance_m = 1.0;     // δ, > 0, finite
	double ray_distance_m = 0.0; // radius of the equivalent reference with linear falloff; 0: the paper's δ / 0.6, or fitted
	bool exact_bounds = false;
	OccluderSettings occluders;        // its distance_m is ignored in favour of the one above
	std::optional<double> detail_more; // if set, chooses occluders.detail for at most this fraction more error
	DropSettings drop;
	std::optional<TrimSettings> trim;             // none: do not trim
	std::optional<CompensateSettings> compensate; // none: the paper's curve
	std::optional<ReceiverSettings> verify;       // none: do not verify
	uint64_t memory_bytes = 0;    // limit of the estimate, checked before work starts and again before polygons are cut; 0: none
	bool degrade = false;         // drop optional steps if the level's triangles alone exceed the limit; else throw
	uint64_t written_bytes = 200; // additional memory per triangle for making the file: writtenBytes(layout)
};

struct BuiltVolumes
{
	VolumeSet set;
	DropCounts dropped;
	OccluderCounts merged;
	std::optional<DetailChoice> detail;
	std::optional<TrimCounts> trimmed;
	std::optional<CompensateResult> compensated;
	std::optional<VerifyResult> verified;
	uint64_t memory_estimate_bytes = 0;
	std::string left_out;              // steps dropped because of the memory limit, "trim, verify"; empty: none
	std::vector<std::string> warnings; // one line each
};

// Upper estimate of the peak memory of buildVolumes() in bytes, including the tracer's tree, from the number of triangles, or of
// polygons if they are cut to more.
uint64_t volumeMemory(uint64_t triangles, const VolumeSettings& settings);

// Throws Error: invalid_input where nothing of the level blocks light; runtime where the estimate exceeds `memory_bytes`, with
// `degrade` even after every step that may be left out.
BuiltVolumes buildVolumes(const Level& level, const VolumeSettings& settings, const RunSettings& run);

} // namespace nook
