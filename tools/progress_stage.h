// SPDX-License-Identifier: GPL-3.0-or-later
// A stage that goes on, as line and log tell of it.
#pragma once

#include "core/remaining_time.h"

#include <optional>
#include <string>

namespace nook
{

inline constexpr double kProgressEvery_s = 0.1; // at most so often something is shown or written of a stage that goes on

struct ProgressStage
{
	std::string name;
	double begun_s = 0.0; // since the program began
	double share = 0.0;   // 0 to 1, never falls
	RemainingTime remaining;
	double logged_s = 0.0; // when the log last had a line of it

	std::optional<double> remainingAt(double now_s) const
	{
		return remaining.at(now_s - begun_s);
	}
};

} // namespace nook
