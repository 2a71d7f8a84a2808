// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/engines.h"

#include "core/json_text.h"
#include "core/text.h"
#include "farm/scripts.h"

#include <nlohmann/json.hpp>

namespace nook
{
namespace
{

// One word of a shell, whatever it holds.
std::string quoted(const std::string& word)
{
	std::string text = "'";
	for (const char letter : word)
	{
		text += letter == '\'' ? "'\\''" : std::string(1, letter);
	}
	return text + "'";
}

std::string quotedWords(const std::vector<std::string>& words)
{
	std::string text;
	for (const std::string& word : words)
	{
		text += " " + quoted(word);
	}
	return text;
}

std::string factsText(const Plan& plan)
{
	return "count=" + std::to_string(plan.jobs.size()) + "\nwork=" + quoted(plan.work) + "\nprogram=" + quoted(plan.program) +
		   "\nversion=" + quoted(plan.version) + "\n";
}

// Assignments and functions of a shell, a line a job; job.sh takes its line alone.
std::string jobsText(const Plan& plan)
{
	std::string text;
	for (const PlanGroup& group : plan.groups)
	{
		std::string needs;
		for (const std::size_t other : group.after)
		{
			for (std::size_t i = 0; i < plan.groups[other].count; ++i)
			{
				needs += (needs.empty() ? "" : " ") + plan.jobs[plan.groups[other].first + i].name;
			}
		}
		for (std::size_t i = group.first; i < group.first + group.count; ++i)
		{
			const PlanJob& job = plan.jobs[i];
			text += "name=" + job.name + "; key=" + job.key + "; tells=" + (job.tells ? "1" : "0") + "; needs='" + needs +
					"'; outputs() { areThere" + quotedWords(job.outputs) + "; }; work() { \"$program\"" + quotedWords(job.words) +
					" \"$@\"; }\n";
		}
	}
	return text;
}

std::string groupsText(const Plan& plan)
{
	std::string text = "# group NUMBER DEPTH FIRST LAST MINUTES MIB THREADS NAME AFTER...\n";
	for (std::size_t i = 0; i < plan.groups.size(); ++i)
	{
		const PlanGroup& group = plan.groups[i];
		text += "group " + std::to_string(i + 1) + " " + std::to_string(group.depth) + " " + std::to_string(group.first + 1) + " " +
				std::to_string(group.first + group.count) + " " + std::to_string(minutesToAsk(group.needs)) + " " +
				std::to_string(mebibytesToAsk(group.needs)) + " " + std::to_string(group.needs.threads) + " " + group.name;
		for (const std::size_t other : group.after)
		{
			text += " " + std::to_string(other + 1);
		}
		text += "\n";
	}
	return text;
}

// Targets are names of ours alone: what Make cannot take stands in `jobs`.
std::string makefileText(const Plan& plan)
{
	std::string text = "# make -j N, in this folder: what is left of its plan. Written by nook plan.\n.PHONY: all\nall:";
	for (const PlanJob& job : plan.jobs)
	{
		text += " " + doneFile(job.name);
	}
	text += "\n";
	for (std::size_t g = 0; g < plan.groups.size(); ++g)
	{
		const PlanGroup& group = plan.groups[g];
		for (std::size_t i = group.first; i < group.first + group.count; ++i)
		{
			text += doneFile(plan.jobs[i].name) + ":";
			for (const std::size_t other : group.after)
			{
				text += " $(group" + std::to_string(other + 1) + ")";
			}
			text += "\n\tsh job.sh " + std::to_string(i + 1) + "\n";
		}
		text += "group" + std::to_string(g + 1) + " :=";
		for (std::size_t i = group.first; i < group.first + group.count; ++i)
		{
			text += " " + doneFile(plan.jobs[i].name);
		}
		text += "\n";
	}
	return text;
}

// Open Job Description, specification 2023-09: a step for each group, a task for each job.
std::string openJobText(const Plan& plan)
{
	using Json = nlohmann::ordered_json;
	Json root;
	root["specificationVersion"] = "jobtemplate-2023-09";
	root["name"] = "nook";
	constexpr std::size_t kMostDescription = 2048;
	root["description"] = oneLine(plan.title.substr(0, kMostDescription));
	root["parameterDefinitions"] = Json::array({{{"name", "Plan"},
												 {"type", "PATH"},
												 {"description", "The folder of this plan, as the farm sees it"},
												 {"objectType", "DIRECTORY"},
												 {"dataFlow", "INOUT"},
												 {"default", "."}}});
	for (const PlanGroup& group : plan.groups)
	{
		Json step;
		step["name"] = group.name;
		for (const std::size_t other : group.after)
		{
			step["dependencies"].push_back({{"dependsOn", plan.groups[other].name}});
		}
		step["hostRequirements"]["amounts"] =
			Json::array({{{"name", "amount.worker.vcpu"}, {"min", group.needs.threads}},
						 {{"name", "amount.worker.memory"}, {"min", mebibytesToAsk(group.needs)}}});
		const std::string range = std::to_string(group.first + 1) + "-" + std::to_string(group.first + group.count);
		step["parameterSpace"]["taskParameterDefinitions"] = Json::array({{{"name", "Job"}, {"type", "INT"}, {"range", range}}});
		Json run;
		run["command"] = "sh";
		run["args"] = {"{{Param.Plan}}/job.sh", "{{Task.Param.Job}}"};
		run["timeout"] = 60 * minutesToAsk(group.needs);
		step["script"]["actions"]["onRun"] = run;
		root["steps"].push_back(step);
	}
	return jsonFile(root);
}

} // namespace

std::vector<PlanFile> planFiles(const Plan& plan)
{
	std::vector<PlanFile> files{{kPlanFile, planJson(plan)},
								{"jobs", jobsText(plan)},
								{"groups", groupsText(plan)},
								{"plan.sh", factsText(plan)},
								{"job.sh", std::string(assets::job_sh)},
								{"run.sh", std::string(assets::run_sh)}};
	if (plan.engine == "make")
	{
		files.push_back({"Makefile", makefileText(plan)});
	}
	else if (plan.engine == "slurm")
	{
		files.push_back({"submit.sh", std::string(assets::submit_sh)});
		files.push_back({"job.sbatch", std::string(assets::job_sbatch)});
	}
	else if (plan.engine == "snakemake")
	{
		files.push_back({"Snakefile", std::string(assets::Snakefile)});
	}
	else if (plan.engine == "opencue")
	{
		files.push_back({"opencue_job.py", std::string(assets::opencue_job_py)});
	}
	else if (plan.engine == "openjd")
	{
		files.push_back({"job.template.json", openJobText(plan)});
	}
	return files;
}

} // namespace nook
