// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan_folder.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "core/text.h"
#include "farm/engines.h"
#include "farm/estimate.h"
#include "farm/status.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace nook
{
namespace
{

namespace fs = std::filesystem;

std::string at(const std::string& folder, const std::string& file)
{
	return (nativePath(folder) / nativePath(file)).string();
}

bool isThere(const std::string& path)
{
	std::error_code failed;
	return fs::exists(nativePath(path), failed);
}

const Engine& engineOf(const Plan& plan)
{
	return *std::find_if(kEngines.begin(), kEngines.end(), [&](const Engine& engine) { return engine.name == plan.engine; });
}

bool isInPath(std::string_view command)
{
	const char* const path = std::getenv("PATH");
	const std::string folders = path != nullptr ? path : "";
	for (std::size_t begin = 0; begin <= folders.size();)
	{
		const std::size_t end = std::min(folders.find(':', begin), folders.size());
		std::error_code failed;
		if (end > begin && fs::is_regular_file(fs::path(folders.substr(begin, end - begin)) / command, failed))
		{
			return true;
		}
		begin = end + 1;
	}
	return false;
}

void checkReplaceable(const Plan& plan, const std::string& folder)
{
	if (!isThere(at(folder, kPlanFile)))
	{
		return;
	}
	const Plan old = readPlanFolder(folder);
	if (old.title != plan.title)
	{
		throw Error(ExitCode::usage,
					folder + ": found the plan of '" + old.title + "', expected that of '" + plan.title + "', or a new folder");
	}
	const std::size_t running = statusOf(old, folder).count(JobState::running);
	const bool same = old.jobs.size() == plan.jobs.size() && std::equal(old.jobs.begin(), old.jobs.end(), plan.jobs.begin(),
																		[](const PlanJob& one, const PlanJob& other)
																		{ return one.name == other.name && one.key == other.key; });
	if (running > 0 && !same)
	{
		throw Error(ExitCode::runtime, folder + ": found " + std::to_string(running) +
										   " jobs of the plan there running, expected none while it is replaced by another");
	}
}

double total(const Plan& plan, const std::function<double(const JobNeeds&)>& of)
{
	double sum = 0.0;
	for (const PlanGroup& group : plan.groups)
	{
		sum += of(group.needs) * static_cast<double>(group.count);
	}
	return sum;
}

double coreSeconds(const Plan& plan)
{
	return total(plan, [](const JobNeeds& needs) { return needs.seconds * needs.threads; });
}

std::string jobsText(std::size_t count)
{
	return std::to_string(count) + (count == 1 ? " job" : " jobs");
}

// "2 h 5 min", "3.2 s".
std::string durationText(double seconds)
{
	if (seconds < 60.0)
	{
		return roundedText(seconds, 2) + " s";
	}
	const auto minutes = static_cast<uint64_t>(std::ceil(seconds / 60.0));
	return (minutes >= 60 ? std::to_string(minutes / 60) + " h " : "") + std::to_string(minutes % 60) + " min";
}

} // namespace

std::unique_ptr<FolderLock> openPlanFolder(const std::string& folder)
{
	for (const char* below : {"", "state", "log", "parts", "decoded"})
	{
		std::error_code failed;
		const fs::path path = nativePath(folder) / below;
		fs::create_directories(path, failed);
		if (failed)
		{
			throw Error(ExitCode::file, path.string() + ": cannot be made: " + failed.message());
		}
	}
	return std::make_unique<FolderLock>(folder);
}

void writePlan(const Plan& plan, const std::string& folder)
{
	checkReplaceable(plan, folder);
	for (const PlanJob& job : plan.jobs)
	{
		if (!isDone(plan, job, folder))
		{
			std::error_code none;
			fs::remove(nativePath(at(folder, doneFile(job.name))), none);
		}
	}
	OutputSet files;
	for (const PlanFile& file : planFiles(plan))
	{
		files.add(at(folder, file.name), file.text);
	}
	files.commit();
}

std::string wholeName(const std::string& path)
{
	const fs::path whole = fs::weakly_canonical(fs::absolute(nativePath(path)));
	return (whole.has_filename() ? whole : whole.parent_path()).string();
}

std::string rootFolder(const std::string& root, const std::vector<std::string>& folders)
{
	std::error_code failed;
	const fs::path whole = fs::canonical(nativePath(root), failed);
	if (failed || !fs::is_directory(whole, failed))
	{
		throw Error(ExitCode::file, "--root: " + root + ": found no such folder, expected one that the farm mounts");
	}
	for (const std::string& folder : folders)
	{
		const fs::path inside = nativePath(wholeName(folder)).lexically_relative(whole);
		if (inside.empty() || *inside.begin() == "..")
		{
			throw Error(ExitCode::usage, "--root: found that " + folder + " is not in " + whole.string() +
											 ", expected a root with every folder of the plan in it");
		}
	}
	return whole.string();
}

void tellPlan(const std::string& json, const Summary& summary, const std::string& text)
{
	OutputSet files;
	if (!json.empty())
	{
		files.add(json, summary.json());
	}
	if (json != "-")
	{
		files.add("-", text);
	}
	files.commit();
}

namespace
{

// Where a command has more parts than pay.
std::string overheadText(const PlanGroup& group)
{
	const double overhead = overheadOf(group.needs, group.count);
	return overhead <= kOverhead
			   ? ""
			   : "; together about " + fixedText(overhead, 1) + " times one run, expected " + fixedText(kOverhead, 2) +
					 " or less: --parts " + std::to_string(mostJobs(group.needs, group.count)) + " at most";
}

} // namespace

std::string planText(const Plan& plan, const std::string& folder, bool written)
{
	const Engine& engine = engineOf(plan);
	std::string text =
		plan.title + ": " + jobsText(plan.jobs.size()) + ", estimated " + durationText(coreSeconds(plan)) + " of one core\n";
	for (const PlanGroup& group : plan.groups)
	{
		text += "  " + group.name + ": " + jobsText(group.count) + " of " +
				(group.needs.known ? "about " : "unknown time, taken as ") + durationText(group.needs.seconds) + " with " +
				std::to_string(group.needs.threads) + (group.needs.threads == 1 ? " thread" : " threads") + "; asks for " +
				std::to_string(minutesToAsk(group.needs)) + " min and " + std::to_string(mebibytesToAsk(group.needs)) +
				" MiB each" + overheadText(group) + "\n";
	}
	if (!written)
	{
		return text;
	}
	text += folder + ": " + std::string(engine.start) + "\n";
	if (!engine.command.empty() && !isInPath(engine.command))
	{
		text += std::string(engine.command) + ": not found on this machine; the files are written for one that has it\n";
	}
	return text;
}

void addPlanFacts(Summary& summary, const Plan& plan)
{
	summary.text("title", plan.title);
	summary.text("engine", plan.engine);
	summary.text("command", engineOf(plan).command);
	summary.text("start", engineOf(plan).start);
	summary.whole("jobs", plan.jobs.size());
	summary.number("core_seconds", roundedNumber(coreSeconds(plan), 4));
	std::vector<Summary> groups;
	for (const PlanGroup& group : plan.groups)
	{
		Summary item;
		item.text("name", group.name);
		item.whole("jobs", group.count);
		item.text("estimated", group.needs.known ? "yes" : "no");
		item.number("seconds", roundedNumber(group.needs.seconds, 4));
		item.number("overhead", roundedNumber(overheadOf(group.needs, group.count), 4));
		item.whole("memory_bytes", static_cast<std::size_t>(group.needs.bytes));
		item.whole("threads", static_cast<std::size_t>(group.needs.threads));
		item.whole("ask_minutes", static_cast<std::size_t>(minutesToAsk(group.needs)));
		item.whole("ask_memory_mib", static_cast<std::size_t>(mebibytesToAsk(group.needs)));
		groups.push_back(item);
	}
	summary.items("groups", groups);
}

Plan readPlanFolder(const std::string& folder)
{
	const std::string path = at(folder, kPlanFile);
	return readPlan(readFile(path), path);
}

std::string statusText(const Plan& plan, const std::string& folder)
{
	const PlanStatus status = statusOf(plan, folder);
	std::string text = plan.title + ": " + jobsText(plan.jobs.size());
	for (std::size_t i = 0; i < kJobStates.size(); ++i)
	{
		text += ", " + std::to_string(status.counts[i]) + " " + std::string(kJobStates[i]);
	}
	text += "\n";
	for (std::size_t i = 0; i < plan.jobs.size(); ++i)
	{
		const JobStatus& job = status.jobs[i];
		if (job.state == JobState::failed)
		{
			text += "  " + plan.jobs[i].name + ": failed with " + std::to_string(job.exit_code) + ": " + oneLine(job.error) + "\n";
		}
		else if (job.state == JobState::killed)
		{
			text += "  " + plan.jobs[i].name + ": killed\n";
		}
		else if (job.state == JobState::running && !job.stage.empty())
		{
			text +=
				"  " + plan.jobs[i].name + ": " + job.stage + " " + std::to_string(static_cast<int>(100.0 * job.share)) + " %\n";
		}
	}
	if (status.remaining_s && *status.remaining_s > 0.0)
	{
		text += "about " + durationText(*status.remaining_s) + " left with " + std::to_string(status.count(JobState::running)) +
				" at once\n";
	}
	return text;
}

void addStatusFacts(Summary& summary, const Plan& plan, const std::string& folder)
{
	const PlanStatus status = statusOf(plan, folder);
	summary.text("title", plan.title);
	summary.whole("jobs", plan.jobs.size());
	for (std::size_t i = 0; i < kJobStates.size(); ++i)
	{
		summary.whole(kJobStates[i], status.counts[i]);
	}
	if (status.remaining_s)
	{
		summary.number("remaining_s", roundedNumber(*status.remaining_s, 4));
	}
	std::vector<Summary> items;
	for (std::size_t i = 0; i < plan.jobs.size(); ++i)
	{
		const JobStatus& job = status.jobs[i];
		Summary item;
		item.text("name", plan.jobs[i].name);
		item.text("state", kJobStates[static_cast<std::size_t>(job.state)]);
		if (job.state == JobState::failed)
		{
			item.whole("exit_code", static_cast<std::size_t>(job.exit_code));
			item.text("error", oneLine(job.error));
		}
		if (job.state == JobState::running && !job.stage.empty())
		{
			item.text("stage", job.stage);
			item.number("done", job.share);
		}
		if (job.seconds && job.state != JobState::left)
		{
			item.number("elapsed_s", *job.seconds);
		}
		items.push_back(item);
	}
	summary.items("job", items);
}

} // namespace nook
