// SPDX-License-Identifier: GPL-3.0-or-later
// Command lines of nook, each one or several jobs of a farm → the files from which Make, Slurm or Snakemake runs them.
#pragma once

#include "core/work_units.h"

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr int kMaxPlanShares = 10000;     // of one command
inline constexpr std::size_t kMaxJobs = 100'000; // of one plan
inline constexpr int kMaxMinutes = 60 * 24 * 365;
inline constexpr int kMaxMebibytes = 1 << 24;

// Time and memory of a job: an estimate, or what the user asks for.
struct JobNeeds
{
	double seconds = 3600.0;   // with `threads`
	double load_seconds = 0.0; // of these: what every share does again, such as reading the level
	double bytes = 2e9;        // of memory
	int threads = 1;
	bool known = false; // false: there is no estimate for such a command
	int minutes = 0;    // to ask for; 0: a few times the estimate
	int mebibytes = 0;
};

// Limits to ask Slurm or Snakemake for.
int minutesToAsk(const JobNeeds& needs);
int mebibytesToAsk(const JobNeeds& needs);

struct PlanJob
{
	std::string name;                  // letters, digits, '.', '_' and '-'
	std::vector<std::string> words;    // after `nook`
	std::vector<std::string> outputs;  // files that it writes
	std::vector<std::string> inputs;   // files that it reads and that exist now
	std::vector<std::string> identity; // of its results in the store; empty: the verb has no --cache
	std::optional<WorkShare> share;
};

// A command line as it runs in the working folder, in so many shares.
struct PlanCommand : PlanJob
{
	int shares = 1;
	JobNeeds needs; // of the whole command
};

// Jobs that wait for the same jobs and take the same time: the shares of a command, or one job.
struct PlanGroup
{
	std::string name;
	std::size_t first = 0; // in the plan's jobs
	std::size_t count = 1;
	std::vector<std::size_t> after; // groups, each before this one
	JobNeeds needs;
};

struct Plan
{
	std::string title;
	std::string version; // of nook
	std::string program; // how the farm calls nook
	std::string work;    // the folder where jobs run, as seen from the plan's folder
	std::string engine;  // one of kEngines
	std::vector<PlanJob> jobs;
	std::vector<PlanGroup> groups; // each after those it waits for
};

struct Engine
{
	std::string_view name;
	std::string_view start; // the command, in the plan's folder
};
inline constexpr std::array<Engine, 3> kEngines{
	{{"make", "make -j 8"}, {"slurm", "sh submit.sh"}, {"snakemake", "snakemake --cores 8"}}};

// Commands that read what others write wait for these. A command of several shares becomes a job for each and one that writes the
// outputs. `folder`: the plan's, as seen from the working folder; the rest of `plan` is copied. Throws Error (usage): two commands
// of one name or one output, commands that wait for each other, too many jobs.
Plan planOf(std::vector<PlanCommand> commands, const Plan& plan, const std::string& folder);

struct PlanFile
{
	std::string name; // in the plan's folder
	std::string text;
};
std::vector<PlanFile> planFiles(const Plan& plan);

// plan.json, "nook.plan/2". Throws Error (invalid_input).
inline constexpr const char* kPlanFile = "plan.json";
Plan readPlan(const std::string& text, const std::string& path);

// Whether each job is done: its outputs exist, and the store in the plan's `folder` holds its results of the present inputs.
std::vector<char> doneJobs(const Plan& plan, const std::string& folder);

// The existing files that a level's file names: buffers and pictures of a .gltf; .mtl files of an .obj and their pictures.
std::vector<std::string> filesNextTo(const std::string& path);

// Without "./", "a/../" and doubled slashes: one text for one name.
std::string plainPath(const std::string& path);

// A list of levels and the steps that each goes through (nook.levels/1) → command lines of nook.

struct ListedCommand
{
	std::string name;               // LEVEL.STEP
	std::vector<std::string> words; // names of files as seen from the output folder
	int shares = 1;
	int minutes = 0; // to ask for; 0: by an estimate
	int mebibytes = 0;
};

// `here`: the folder of the list, as seen from the output folder. Level by level, steps in their order. Throws Error
// (invalid_input) with the element that is wrong.
std::vector<ListedCommand> readLevelList(const std::string& text, const std::string& path, const std::string& here);

// The facts of a command before it runs → time and memory that it may take: an estimate to plan with, not a bound.

struct WorkFacts
{
	std::string verb;
	double triangles = 0.0;
	double pixels = 0.0;   // or points
	double rays = 0.0;     // of a pixel
	bool looks_on = false; // volumes that are trimmed, compensated or simplified
	bool open_end = false; // nobody knows how much
};

JobNeeds guessWork(const WorkFacts& facts, int threads);

// Processor time of so many jobs that share a command and each take `needs`, over that of one job; 1 where that is unknown.
double overheadOf(const JobNeeds& needs, std::size_t jobs);

// The most jobs that stay below this overhead; more do more of what each does by itself than they save.
inline constexpr double kOverhead = 1.15;
std::size_t mostJobs(const JobNeeds& needs, std::size_t jobs);

// Triangles of a level's file, by its format and size.
double trianglesOfFile(const std::string& ending, double bytes);

} // namespace nook
