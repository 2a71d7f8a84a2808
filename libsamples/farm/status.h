// SPDX-License-Identifier: GPL-3.0-or-later
// The files in a plan's folder → what has become of its jobs, at any moment.
#pragma once

#include "farm/plan.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

enum class JobState
{
	left,    // nobody has begun, or it has gone without a word: to be run
	running, // wrote in the last minute that it is alive
	done,
	failed, // ended with another code than 0
	killed, // was begun, and neither ended nor is alive: to be run again
};
inline constexpr std::array<std::string_view, 5> kJobStates{"left", "running", "done", "failed", "killed"};

struct JobStatus
{
	JobState state = JobState::left;
	int exit_code = 0;             // failed
	std::string error;             // failed: its one line
	std::string stage;             // running: the last one that it told of
	double share = 0.0;            // of that
	std::optional<double> seconds; // it took, or has taken so far
};

struct PlanStatus
{
	std::vector<JobStatus> jobs; // one of each of the plan's
	std::array<std::size_t, kJobStates.size()> counts{};
	std::optional<double> remaining_s; // with as many at once as are running; nothing is known while none is

	std::size_t count(JobState state) const
	{
		return counts[static_cast<std::size_t>(state)];
	}
};

// Reads alone. `folder` is the plan's. Clocks of the machines that write there may be some 30 s apart.
PlanStatus statusOf(const Plan& plan, const std::string& folder);

// Whether the outputs are there and were made from what the plan says now.
bool isDone(const Plan& plan, const PlanJob& job, const std::string& folder);

} // namespace nook
