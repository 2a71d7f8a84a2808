// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes as they were made, or as a file holds them → lines for people, and the same facts as JSON.
#pragma once

#include "summary.h"

#include "volume/build.h"
#include "volume/volume_glb.h"

#include <string>
#include <vector>

namespace nook
{

// Of a run of `nook volumes`; `bytes`: of the file, `quantised`: what 16-bit corners change, where it was measured.
std::string describeBuilt(const BuiltVolumes& built, const VolumeFile& file, const VolumeSettings& settings,
						  const std::optional<VerifyResult>& quantised, Summary& summary);

std::string describeVolumes(const VolumeSet& volumes, const VolumeFileFacts& facts, Summary& summary);

} // namespace nook
