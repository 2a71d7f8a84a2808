// SPDX-License-Identifier: GPL-3.0-or-later
// nook plan: a command of nook → the files from which a farm's engine runs it in parts; and how far such a plan is.
#include "options.h"
#include "plan_folder.h"
#include "plan_words.h"
#include "summary.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "farm/engines.h"
#include "version.h"

#include <algorithm>
#include <filesystem>

namespace nook
{
namespace
{

namespace fs = std::filesystem;

struct PlanOptions
{
	std::string engine = "shell";
	int parts = 1;
	std::string folder;
	std::string root = ".";
	std::string program = "nook";
	int minutes = 0;
	int mebibytes = 0;
	bool dry_run = false;
	std::string status;
	std::string json;
	std::vector<std::string> words;
};

void checkForm(const CLI::App& app, const PlanOptions& options)
{
	if (!options.status.empty())
	{
		for (const CLI::Option* option : app.get_options())
		{
			if (option->count() > 0 && option->get_name() != "--status" && option->get_name() != "--json")
			{
				throw Error(ExitCode::usage, "--status: found with " + option->get_name() + ", expected --json alone beside it");
			}
		}
		return;
	}
	if (options.words.empty())
	{
		throw Error(ExitCode::usage, "the command: found none, expected nook plan OPTIONS -- VERB ARGUMENTS, or --status FOLDER");
	}
	if (options.folder.empty())
	{
		throw Error(ExitCode::usage, "-o: found none, expected a folder for the plan");
	}
}

std::string titleOf(const std::vector<std::string>& words)
{
	std::string title = "nook";
	for (const std::string& word : words)
	{
		title += " " + word;
	}
	return title;
}

Plan planned(const PlanOptions& options)
{
	const CommandPlace place{rootFolder(options.root, {".", options.folder}), fs::current_path().string()};
	const fs::path work = nativePath(place.folder);
	const fs::path folder = nativePath(wholeName(options.folder));
	PixelsOf pixels;
	const CommandChoice choice{"job", options.parts, options.minutes, options.mebibytes};
	PlanCommand command = planCommandOf(options.words, place, choice, pixels);
	command.name = command.verb;
	std::replace(command.name.begin(), command.name.end(), ' ', '-');
	for (const std::string& output : command.outputs)
	{
		checkWritable(output);
	}
	const std::string up = work.lexically_relative(folder).generic_string();
	const std::string down = folder.lexically_relative(work).generic_string();
	return planOf({command}, {titleOf(options.words), NOOK_VERSION, options.program, up, options.engine, down, "."});
}

void run(const CLI::App& app, const PlanOptions& options)
{
	checkForm(app, options);
	if (!options.json.empty())
	{
		checkWritable(options.json);
	}
	Summary summary("plan");
	if (!options.status.empty())
	{
		const Plan plan = readPlanFolder(options.status);
		addStatusFacts(summary, plan, options.status);
		tellPlan(options.json, summary, statusText(plan, options.status));
		return;
	}
	const Plan plan = planned(options);
	addPlanFacts(summary, plan);
	if (!options.dry_run)
	{
		const auto lock = openPlanFolder(options.folder);
		writePlan(plan, options.folder);
	}
	tellPlan(options.json, summary, planText(plan, options.folder, !options.dry_run));
}

} // namespace

Verb addPlanVerb(CLI::App& nook)
{
	const auto options = std::make_shared<PlanOptions>();
	CLI::App* const app = nook.add_subcommand("plan", "The files from which a farm runs a command in parts; and how far they are");
	addChoiceText(
		*app, "--for", kEngineNames, [options](std::size_t i) { options->engine = kEngines[i].name; },
		"The engine that is to run it (default shell: GNU parallel or xargs)");
	addWhole(*app, "--parts", options->parts, 1, kMostPlanParts,
			 "Parts of the command, each a job; a merge follows them (default 1)");
	addText(*app, "-o,--output", options->folder, "FOLDER", "The plan's folder; made where it is not there");
	addText(*app, "--root", options->root, "FOLDER",
			"The folder that the farm mounts, wherever that is; all files of the command are in it (default: this one)");
	addText(*app, "--program", options->program, "FILE", "How the farm calls nook (default nook)");
	addWhole(*app, "--minutes", options->minutes, 1, kMostMinutes, "Time to ask for, for each job, in place of an estimate");
	addWhole(*app, "--memory", options->mebibytes, 1, kMostMebibytes, "MiB to ask for, for each job, in place of an estimate");
	app->add_flag("--dry-run", options->dry_run, "Writes no plan; says what it would be, and what it would ask for");
	addText(*app, "--status", options->status, "FOLDER", "How far the jobs of the plan in a folder are; nothing else");
	addJson(*app, options->json);
	app->add_option("COMMAND", options->words, "Behind --: a verb and its options, with -o or --json")->type_name("");
	return {app, [app, options](VerbProgress&)
			{
				run(*app, *options);
			}};
}

} // namespace nook
