// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/status.h"

#include "core/file.h"
#include "core/json_text.h"
#include "core/system.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>

namespace nook
{
namespace
{

namespace fs = std::filesystem;

constexpr double kAlive_s = 60.0; // job.sh writes every 15 s

// What changes while it is looked at, and may be gone: empty.
std::string textOf(const std::string& path)
{
	std::error_code failed;
	if (!fs::is_regular_file(nativePath(path), failed))
	{
		return {};
	}
	try
	{
		return readFile(path);
	}
	catch (const std::exception&)
	{
		return {};
	}
}

bool isThere(const std::string& path)
{
	std::error_code failed;
	return fs::exists(nativePath(path), failed);
}

bool isAlive(const std::string& path)
{
	std::error_code failed;
	const fs::file_time_type written = fs::last_write_time(nativePath(path), failed);
	return !failed && std::chrono::duration<double>(fs::file_time_type::clock::now() - written).count() < kAlive_s;
}

std::string lastLine(const std::string& text)
{
	const std::size_t end = text.find_last_not_of('\n');
	if (end == std::string::npos)
	{
		return {};
	}
	const std::size_t begin = text.rfind('\n', end);
	return text.substr(begin == std::string::npos ? 0 : begin + 1, end - (begin == std::string::npos ? 0 : begin + 1) + 1);
}

// The last line of a log of progress that is whole.
void readProgress(const std::string& path, JobStatus& status)
{
	const std::string text = textOf(path);
	const nlohmann::json line = looseJson(lastLine(text.substr(0, text.rfind('\n') + 1)));
	if (!line.is_object())
	{
		return;
	}
	if (line.contains("elapsed_s") && line["elapsed_s"].is_number())
	{
		status.seconds = line["elapsed_s"].get<double>();
	}
	if (line.contains("stage") && line["stage"].is_string() && line.contains("done") && line["done"].is_number())
	{
		status.stage = line["stage"].get<std::string>();
		status.share = line["done"].get<double>();
	}
}

JobStatus statusOfJob(const Plan& plan, const PlanJob& job, const std::string& folder)
{
	JobStatus status;
	readProgress(folder + "/" + progressFile(job.name), status);
	const std::string exit = lastLine(textOf(folder + "/" + exitFile(job.name)));
	if (isDone(plan, job, folder))
	{
		status.state = JobState::done;
	}
	else if (isAlive(folder + "/" + aliveFile(job.name)))
	{
		status.state = JobState::running;
	}
	else if (!exit.empty() && exit != "0" && exit.size() < 4 && exit.find_first_not_of("0123456789") == std::string::npos)
	{
		status.exit_code = std::stoi(exit);
		status.state = status.exit_code >= 128 ? JobState::killed : JobState::failed; // a shell's word for signals
		status.error = status.state == JobState::failed ? lastLine(textOf(folder + "/" + errorFile(job.name))) : "";
		status.error = status.error.starts_with("nook: ") ? status.error.substr(6) : status.error;
	}
	else if (isThere(folder + "/" + aliveFile(job.name)))
	{
		status.state = JobState::killed;
	}
	return status;
}

// Jobs of a group take what those of it took that are done; where none is, as much longer than estimated as the others.
std::optional<double> remainingOf(const Plan& plan, const PlanStatus& status)
{
	double took_s = 0.0;
	double estimated_s = 0.0;
	std::vector<double> means(plan.groups.size(), 0.0);
	for (std::size_t g = 0; g < plan.groups.size(); ++g)
	{
		const PlanGroup& group = plan.groups[g];
		std::size_t known = 0;
		for (std::size_t i = group.first; i < group.first + group.count; ++i)
		{
			const JobStatus& job = status.jobs[i];
			if (job.state == JobState::done && job.seconds)
			{
				known += 1;
				means[g] += *job.seconds;
				estimated_s += group.needs.seconds;
			}
		}
		took_s += means[g];
		means[g] /= static_cast<double>(std::max<std::size_t>(known, 1));
	}
	const double longer = estimated_s > 0.0 ? took_s / estimated_s : 1.0;
	double left_s = 0.0;
	for (std::size_t g = 0; g < plan.groups.size(); ++g)
	{
		const PlanGroup& group = plan.groups[g];
		const double mean_s = means[g] > 0.0 ? means[g] : group.needs.seconds * longer;
		for (std::size_t i = group.first; i < group.first + group.count; ++i)
		{
			const JobStatus& job = status.jobs[i];
			left_s += job.state == JobState::done
						  ? 0.0
						  : std::max(0.0, mean_s - (job.state == JobState::running ? job.seconds.value_or(0.0) : 0.0));
		}
	}
	const std::size_t running = status.count(JobState::running);
	if (running == 0)
	{
		return left_s > 0.0 ? std::nullopt : std::optional(0.0);
	}
	return left_s / static_cast<double>(running);
}

} // namespace

bool isDone(const Plan& plan, const PlanJob& job, const std::string& folder)
{
	const std::string stamp = textOf(folder + "/" + doneFile(job.name));
	return stamp.find("\"key\": \"" + job.key + "\"") != std::string::npos &&
		   std::all_of(job.outputs.begin(), job.outputs.end(),
					   [&](const std::string& output) { return isThere(folder + "/" + plan.work + "/" + output); });
}

PlanStatus statusOf(const Plan& plan, const std::string& folder)
{
	PlanStatus status;
	for (const PlanJob& job : plan.jobs)
	{
		status.jobs.push_back(statusOfJob(plan, job, folder));
		status.counts[static_cast<std::size_t>(status.jobs.back().state)] += 1;
	}
	status.remaining_s = remainingOf(plan, status);
	return status;
}

} // namespace nook
