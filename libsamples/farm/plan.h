// SPDX-License-Identifier: GPL-3.0-or-later
// Command lines of nook, each a job for one machine, in an order → a plan: jobs with names, keys and what they wait for.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace nook
{

inline constexpr int kMostPlanParts = 10000;     // of one command: a merge names all of them
inline constexpr std::size_t kMostJobs = 200000; // of one plan

// What a job may take. A guess (farm/estimate.h), or what somebody said.
struct JobNeeds
{
	double seconds = 3600.0;   // with `threads`
	double load_seconds = 0.0; // of these: what each part takes again, since the level is read and its tree built
	double bytes = 2e9;        // of memory
	int threads = 1;
	bool known = false; // else nothing is known of such a command
	int minutes = 0;    // to ask for, where somebody said so; else a few times the guess
	int mebibytes = 0;
};

inline constexpr int kMostMinutes = 60 * 24 * 365;
inline constexpr int kMostMebibytes = 1 << 24;

// What to ask an engine for.
int minutesToAsk(const JobNeeds& needs);
int mebibytesToAsk(const JobNeeds& needs);

struct PlanJob
{
	std::string name;                 // letters, digits, '.', '_' and '-'; unlike any other's
	std::vector<std::string> words;   // behind `nook`, as they are in the working folder
	std::vector<std::string> outputs; // from there
	std::string key;                  // of all that its outputs depend on
	bool tells = true;                // the verb has --progress
};

// Jobs that wait for the same and take the same: the parts of a command, or one job.
struct PlanGroup
{
	std::string name;
	std::size_t first = 0; // of the plan's jobs
	std::size_t count = 1;
	std::vector<std::size_t> after; // groups, each before this one
	std::size_t depth = 0;          // of the longest chain of groups before it
	JobNeeds needs;
};

struct Plan
{
	std::string title;   // for people
	std::string version; // of nook
	std::string program; // how the farm calls nook
	std::string work;    // the folder where jobs run, as seen from the plan's
	std::string engine;  // a name of kEngines (farm/engines.h)
	std::vector<PlanJob> jobs;
	std::vector<PlanGroup> groups; // by depth, their jobs one behind the other
};

// A command as it was given, before it is split.
struct PlanCommand
{
	std::string name; // of its jobs: letters, digits, '.', '_' and '-'
	std::string verb;
	std::vector<std::string> words;     // without those that say what is written
	std::vector<std::string> out_words; // those: -o FILE …, --json FILE
	std::vector<std::string> outputs;   // the files of them
	std::vector<std::string> inputs;    // files that are read, as far as that can be seen
	int parts = 1;
	bool tells = true;
	JobNeeds needs; // of all of it
};

struct PlanSettings
{
	std::string title;
	std::string version;
	std::string program;
	std::string work;
	std::string engine;
	std::string folder;      // the plan's, as seen from the working folder
	std::string work_folder; // the working folder, as seen from here: where inputs are read for their hashes
};

// Commands that read what others write wait for these; a command of several parts becomes its parts and a merge. Reads every input.
// Throws Error: usage (two commands of one name or one output, commands that wait for each other), file (an input).
Plan planOf(const std::vector<PlanCommand>& commands, const PlanSettings& settings);

// The plan as "nook.plan/1", and back. Throws Error (invalid_input).
std::string planJson(const Plan& plan);
Plan readPlan(const std::string& text, const std::string& path);

// The folder's files, by name.
inline constexpr const char* kPlanFile = "plan.json";
std::string doneFile(const std::string& job);     // there: the job is done
std::string exitFile(const std::string& job);     // the exit code of the last try
std::string aliveFile(const std::string& job);    // written four times a minute while the job runs
std::string progressFile(const std::string& job); // of --progress
std::string errorFile(const std::string& job);    // what the last try said on stderr

} // namespace nook
