// SPDX-License-Identifier: GPL-3.0-or-later
// Builds a level's ambient occlusion volumes: polygons (occluders.h), dropping unneeded ones (drop.h), trimming their reach
// (trim.h), the compensation curve (compensate.h), and verification (receivers.h). Clusters are added by clusterVolumes().
#pragma once

#include "core/facts.h"
#include "core/progress.h"
#include "scene/level.h"
#include "scene/tracer.h"
#include "volume/compensate.h"
#include "volume/drop.h"
#include "volume/occluders.h"
#include "volume/receivers.h"
#include "volume/trim.h"
#include "volume/volume_glb.h"
#include "volume/volumes.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

struct AssetEstimate;
struct LevelFacts;

// Chooses how far a level's surfaces may be simplified before volumes are made (OccluderSettings::detail), for a given increase of
// the error.

struct DetailSettings
{
	double more = 0.05;          // allowed increase of the error, relative to the error without simplification; > 0
	double ray_distance_m = 0.0; // radius of the reference with linear falloff; 0: the paper's δ / 0.6
	bool exact_bounds = false;   // as for the final volumes
	bool fitted = false;         // the volumes will get a fitted curve, whose error counts; else the paper's counts
	bool masks = false;          // masks of directions count, which have no curve
	int rays = 256;              // per point
	ReceiverSettings receivers{4, 600, 2400, 0, 5}; // points where errors are measured
};

struct DetailTrial
{
	double detail = 0.0;      // relative to δ
	uint64_t polygons = 0;    // convex polygons before dropping any
	double paper_rmse = 0.0;  // visibility error against rays with the paper's curve, or of masks
	double fitted_rmse = 0.0; // with a curve fitted to these points; of masks, with errors above 0.2 counted as 0.2
};

struct DetailChoice
{
	double detail = 0.0; // 0: no step is acceptable, or none saves a tenth of the polygons
	std::size_t points = 0;
	std::vector<DetailTrial> trials; // the first is without simplification, then in order of evaluation
};

// Finds, by bisection, the coarsest of a ladder of steps (0.08 and down by fourth roots of two) whose error with the volumes' curve
// is at most `more` above that without simplification. With the paper's curve, the error with a fitted one may grow by at most
// three times that. With masks, the error may be kMaskError in any case. Deterministic for any thread count. `settings.detail` is
// ignored.
DetailChoice chooseDetail(const Level& level, const Tracer& tracer, const OccluderSettings& settings, const DetailSettings& detail,
						  const RunSettings& run);

struct VolumeSettings
{
	double distance_m = 1.0;     // δ, > 0, finite
	double ray_distance_m = 0.0; // radius of the equivalent reference with linear falloff; 0: the paper's δ / 0.6, or fitted
	bool exact_bounds = false;
	bool masks = false;                // drawn as masks of directions: no curve, rays of the distance itself
	OccluderSettings occluders;        // its distance_m is ignored in favour of the one above
	const Level* occluding = nullptr;  // the part of the level that gets volumes; null: all of it
	std::optional<double> detail_more; // if set, chooses occluders.detail for at most this fraction more error; 0: 0.05, masks 0.25
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

// Volumes that were made. `quantised`: the change by 16-bit corners, where it was measured.
void describeBuilt(const BuiltVolumes& built, const VolumeFile& file, const VolumeSettings& settings,
				   const std::optional<VerifyResult>& quantised, Facts& to);

// The volumes of a file.
void describeVolumes(const VolumeSet& volumes, const VolumeFileFacts& file, Facts& to);

// Estimates the result of `nook volumes --masks` for a level at the suggested distance, from the polygons of a sample of its flat
// pieces. Deterministic for any number of threads.
AssetEstimate masksEstimate(const Level& level, const LevelFacts& facts, const RunSettings& run);

} // namespace nook
