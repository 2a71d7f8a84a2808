// SPDX-License-Identifier: GPL-3.0-or-later
// nook batch: many levels, each through the same steps → what is not up to date is made, here or by a farm's engine.
#include "options.h"
#include "plan_folder.h"
#include "plan_words.h"
#include "summary.h"

#include "core/error.h"
#include "core/file.h"
#include "core/parallel.h"
#include "core/system.h"
#include "core/text.h"
#include "farm/batch.h"
#include "farm/engines.h"
#include "farm/run_here.h"
#include "farm/status.h"
#include "version.h"

#include <filesystem>

namespace nook
{
namespace
{

namespace fs = std::filesystem;

struct BatchOptions
{
	std::string list;
	std::string folder;
	std::string engine; // empty: none
	std::string root;
	std::string program = "nook";
	int jobs = 0;
	bool dry_run = false;
	std::string json;
	std::string progress;
};

std::string planFolder(const BatchOptions& options)
{
	return options.folder + "/plan";
}

Plan planned(const BatchOptions& options)
{
	const std::string parent = nativePath(wholeName(options.list)).parent_path().string();
	const std::string root = options.root.empty() ? "/" : rootFolder(options.root, {options.folder, parent});
	const std::string folder = wholeName(options.folder);
	const std::string here = nativePath(parent).lexically_relative(nativePath(folder)).generic_string();
	std::vector<PlanCommand> commands;
	PixelsOf pixels;
	for (const BatchCommand& item : readBatch(readFile(options.list), options.list, here))
	{
		try
		{
			if (!isCommandName(item.name))
			{
				throw Error(ExitCode::invalid_input, "found that name of a job, expected " + std::string(kCommandName));
			}
			commands.push_back(
				planCommandOf(item.words, {root, folder}, {item.name, item.parts, item.minutes, item.mebibytes}, pixels));
		}
		catch (const Error& error) // the list is a file: what is wrong in it is no usage
		{
			throw Error(error.code() == ExitCode::usage ? ExitCode::invalid_input : error.code(),
						options.list + ": " + item.name + ": " + error.what());
		}
	}
	const std::string name = nativePath(options.list).filename().string();
	return planOf(commands, {"nook batch " + name, NOOK_VERSION, options.program, "..",
							 options.engine.empty() ? "shell" : options.engine, "plan", folder});
}

void addCounts(Summary& summary, const PlanStatus& status)
{
	summary.whole("done", status.count(JobState::done));
	summary.whole("not_done", status.jobs.size() - status.count(JobState::done));
}

// The first job that failed, with its line.
[[noreturn]] void throwFailed(const Plan& plan, const PlanStatus& status)
{
	const std::size_t left = status.jobs.size() - status.count(JobState::done);
	std::string first = "see " + std::string("log/run.log of the plan");
	for (std::size_t i = 0; i < plan.jobs.size(); ++i)
	{
		if (status.jobs[i].state == JobState::failed)
		{
			first = plan.jobs[i].name + ": " + status.jobs[i].error;
			break;
		}
	}
	throw Error(ExitCode::runtime, "batch: found " + std::to_string(left) + " of " + std::to_string(plan.jobs.size()) +
									   " jobs not done, expected none: " + first);
}

void runJobs(const Plan& plan, const BatchOptions& options, const RunSettings& settings, Summary& summary)
{
	const std::string folder = planFolder(options);
	const std::size_t before = statusOf(plan, folder).count(JobState::done);
	int threads = 1;
	for (const PlanGroup& group : plan.groups)
	{
		threads = std::max(threads, group.needs.threads);
	}
	if (before < plan.jobs.size())
	{
		runHere(plan, folder, options.jobs > 0 ? options.jobs : std::max(1, availableThreads() / threads), settings);
	}
	const PlanStatus status = statusOf(plan, folder);
	summary.whole("up_to_date", before);
	addCounts(summary, status);
	tellPlan(options.json, summary,
			 options.progress == "-"
				 ? ""
				 : std::to_string(plan.jobs.size()) + " jobs: " + std::to_string(before) + " were up to date, " +
					   std::to_string(status.count(JobState::done) - before) + " are done now, " +
					   std::to_string(plan.jobs.size() - status.count(JobState::done)) + " are not\n");
	if (status.count(JobState::done) < plan.jobs.size())
	{
		throwFailed(plan, status);
	}
}

void run(const BatchOptions& options, VerbProgress& progress)
{
	if (!options.progress.empty() && (!options.engine.empty() || options.dry_run))
	{
		throw Error(ExitCode::usage, "--progress: found without work to be done here, expected neither --for nor --dry-run");
	}
	if (!options.engine.empty() && options.jobs > 0)
	{
		throw Error(ExitCode::usage, "--jobs: found with --for, expected one of them: the engine says how many run at once");
	}
	if (!options.json.empty())
	{
		checkWritable(options.json);
	}
	if (!options.progress.empty() && options.progress == options.json)
	{
		throw Error(ExitCode::usage, options.progress + ": named twice, expected another file for every output");
	}
	const Plan plan = planned(options);
	Summary summary("batch");
	addPlanFacts(summary, plan);
	if (options.dry_run)
	{
		tellPlan(options.json, summary, planText(plan, planFolder(options), false));
		return;
	}
	const auto lock = openPlanFolder(planFolder(options));
	writePlan(plan, planFolder(options));
	const PlanStatus status = statusOf(plan, planFolder(options));
	if (!options.engine.empty())
	{
		addCounts(summary, status);
		tellPlan(options.json, summary,
				 planText(plan, planFolder(options), true) + std::to_string(status.count(JobState::done)) +
					 " jobs are up to date\n");
		return;
	}
	runJobs(plan, options, progress.start("batch", 0, options.progress), summary);
}

} // namespace

Verb addBatchVerb(CLI::App& nook)
{
	const auto options = std::make_shared<BatchOptions>();
	CLI::App* const app = nook.add_subcommand("batch", "Many levels, each through the same steps: makes what is not up to date");
	addText(*app, "LIST", options->list, "LEVELS.json", "Levels and steps, nook.batch/1")->required();
	addText(*app, "-o,--output", options->folder, "FOLDER", "Where the steps run and write; made where it is not there")
		->required();
	addChoiceText(
		*app, "--for", kEngineNames, [options](std::size_t i) { options->engine = kEngines[i].name; },
		"Writes the files from which this engine runs it, and runs nothing");
	addText(*app, "--root", options->root, "FOLDER", "The folder that the farm mounts, with all files in it (default: /)");
	addText(*app, "--program", options->program, "FILE", "How the farm calls nook (default nook)");
	addWhole(*app, "--jobs", options->jobs, 1, 1024, "Jobs at a time, run here (default: processors over the jobs' threads)");
	app->add_flag("--dry-run", options->dry_run, "Writes nothing; says what the jobs would be, and what they would ask for");
	addJson(*app, options->json);
	addProgress(*app, options->progress);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
