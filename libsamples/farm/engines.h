// SPDX-License-Identifier: GPL-3.0-or-later
// A plan → the files from which an engine runs it.
#pragma once

#include "farm/plan.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct Engine
{
	std::string_view name;
	std::string_view command; // that must be there to start it; empty: nothing but a shell
	std::string_view start;   // in the plan's folder
};

inline constexpr std::array<Engine, 6> kEngines{{
	{"shell", "", "sh run.sh"},
	{"make", "make", "make -j 8"},
	{"slurm", "sbatch", "sh submit.sh"},
	{"snakemake", "snakemake", "snakemake --cores 8"},
	{"opencue", "pycuerun", "python3 opencue_job.py"},
	{"openjd", "openjd", "openjd run job.template.json --step ..."},
}};

inline constexpr std::array<std::string_view, kEngines.size()> kEngineNames = []
{
	std::array<std::string_view, kEngines.size()> names{};
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		names[i] = kEngines[i].name;
	}
	return names;
}();

struct PlanFile
{
	std::string name; // in the plan's folder
	std::string text;
};

// Those that every engine uses (plan.json, jobs, groups, plan.sh, job.sh, run.sh) and the engine's own.
std::vector<PlanFile> planFiles(const Plan& plan);

} // namespace nook
