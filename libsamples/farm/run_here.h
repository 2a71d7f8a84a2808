// SPDX-License-Identifier: GPL-3.0-or-later
// A plan's jobs, run on this machine without an engine.
#pragma once

#include "farm/plan.h"

#include "core/progress.h"

#include <string>

namespace nook
{

// run.sh of a plan's folder, so many jobs at a time, by the program that this is. What it says goes to log/run.log. Ends when all
// jobs have been tried; ends them where this program is ended. Throws Error (runtime) where it cannot be started.
void runHere(const Plan& plan, const std::string& folder, int jobs, const RunSettings& settings);

} // namespace nook
