// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes as they were made, or as a file holds them → facts.
#pragma once

#include "core/facts.h"
#include "volume/build.h"
#include "volume/volume_glb.h"

#include <optional>

namespace nook
{

// Volumes that were made. `quantised`: the change by 16-bit corners, where it was measured.
void describeBuilt(const BuiltVolumes& built, const VolumeFile& file, const VolumeSettings& settings,
				   const std::optional<VerifyResult>& quantised, Facts& to);

// The volumes of a file.
void describeVolumes(const VolumeSet& volumes, const VolumeFileFacts& file, Facts& to);

} // namespace nook
