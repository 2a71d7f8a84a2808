// SPDX-License-Identifier: GPL-3.0-or-later
// How volumes are made: the options of `nook volumes` beside its level and its files.
#pragma once

#include "options.h"

#include "volume/build.h"

#include <optional>

namespace nook
{

struct VolumeOptions
{
	VolumeSettings settings;
	bool flat_given = false;
	bool hidden_loss_given = false;
	std::optional<CurveMeasure> measure; // that --compensate fits to, where it was given
	bool no_drop = false;                // none of the polygons that nothing needs
};

void addVolumeOptions(CLI::App& app, VolumeOptions& options);

// Refuses options that contradict each other and settles those that stand for others. Throws Error (usage).
void settleVolumeOptions(VolumeOptions& options);

} // namespace nook
