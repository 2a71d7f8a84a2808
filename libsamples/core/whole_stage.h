// SPDX-License-Identifier: GPL-3.0-or-later
// Stages of one unit that parts cannot share out, since what follows needs all of it: kept, so that it is made once.
#pragma once

#include "core/work_units.h"

namespace nook
{

// Computes it in a run of its own. Parts and their merge take what one of them has kept, where a folder is named for that
// (core/kept_answers.h). A stage tells of itself, and has its own threads.
void runShared(const WorkStage& stage, const RunSettings& run);

// The same, and a run that keeps its units keeps this one with them.
void runWhole(const WorkStage& stage, const RunSettings& run);

} // namespace nook
