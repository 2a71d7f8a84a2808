// SPDX-License-Identifier: GPL-3.0-or-later
// A level → its ambient occlusion volumes: polygons (occluders.h), those that are needed (drop.h), as far as they are (trim.h), the
// curve (compensate.h), and what that changed (verify.h). Clusters are left to clusters.h: there are none yet.
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
	double distance_m = 1.0; // δ, > 0, finite
	double ray_distance_m =
		0.0; // radius of the reference with linear falloff that they stand for; 0: the paper's δ / 0.6, or fitted
	bool exact_bounds = false;
	OccluderSettings occluders;        // distance_m of it is ignored: it is the one above
	std::optional<double> detail_more; // chooses occluders.detail: this share of error more at most; none: as it is
	DropSettings drop;
	std::optional<TrimSettings> trim;             // none: not trimmed
	std::optional<CompensateSettings> compensate; // none: the paper's curve
	std::optional<ReceiverSettings> verify;       // none: not verified
	uint64_t memory_bytes = 0;    // cap of the estimate, before work starts and, of polygons, before they are cut; 0: none
	bool leave_out = true;        // steps, where the level's triangles alone are above the cap; false, or too few of them: refused
	uint64_t written_bytes = 200; // memory that making the file of it takes beside, a triangle: writtenBytes(layout)
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
	std::string left_out;              // steps that the cap on memory left no room for, "trim, verify"; empty: none
	std::vector<std::string> warnings; // one line each
};

// Bytes at the peak of buildVolumes(), the tracer's tree included; an upper estimate from the number of triangles alone, or of
// polygons where they are cut to more than that.
uint64_t volumeMemory(uint64_t triangles, const VolumeSettings& settings);

// Throws Error: invalid_input where nothing of the level blocks light; runtime where the estimate is above `memory_bytes` whatever
// is left out.
BuiltVolumes buildVolumes(const Level& level, const VolumeSettings& settings, const RunSettings& run);

} // namespace nook
