// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/plan.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "farm/inputs.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>

namespace nook
{
namespace
{

[[noreturn]] void refuse(const std::string& message)
{
	throw Error(ExitCode::usage, message);
}

// Which command writes a file.
std::map<std::string, std::size_t> writersOf(const std::vector<PlanCommand>& commands)
{
	std::map<std::string, std::size_t> writers;
	std::set<std::string> names;
	for (std::size_t i = 0; i < commands.size(); ++i)
	{
		if (!names.insert(commands[i].name).second)
		{
			refuse(commands[i].name + ": found two jobs of that name, expected a name for each");
		}
		for (const std::string& output : commands[i].outputs)
		{
			const auto [other, is_new] = writers.try_emplace(plainPath(output), i);
			if (!is_new)
			{
				refuse(output + ": found that " + commands[other->second].name + " and " + commands[i].name +
					   " write it, expected another file for each");
			}
		}
	}
	return writers;
}

// Commands that a command waits for, by what it reads.
std::vector<std::vector<std::size_t>> beforeEach(const std::vector<PlanCommand>& commands)
{
	const std::map<std::string, std::size_t> writers = writersOf(commands);
	std::vector<std::vector<std::size_t>> before(commands.size());
	for (std::size_t i = 0; i < commands.size(); ++i)
	{
		std::set<std::size_t> found;
		for (const std::string& word : commands[i].words)
		{
			const auto writer = writers.find(plainPath(word));
			if (writer != writers.end() && writer->second != i)
			{
				found.insert(writer->second);
			}
		}
		before[i].assign(found.begin(), found.end());
	}
	return before;
}

// The length of the longest chain before each.
std::vector<std::size_t> depthsOf(const std::vector<PlanCommand>& commands, const std::vector<std::vector<std::size_t>>& before)
{
	std::vector<std::size_t> depths(commands.size(), 0);
	bool changed = true;
	for (std::size_t round = 0; changed; ++round)
	{
		changed = false;
		for (std::size_t i = 0; i < commands.size(); ++i)
		{
			for (const std::size_t other : before[i])
			{
				const std::size_t least = depths[other] + (commands[other].parts > 1 ? 2 : 1); // a merge is a step, too
				if (depths[i] < least)
				{
					depths[i] = least;
					changed = true;
				}
				if (changed && round > commands.size())
				{
					refuse(commands[i].name + ": found that it waits for itself by way of " + commands[other].name +
						   ", expected commands in an order");
				}
			}
		}
	}
	return depths;
}

std::string twoKeys(const std::string& key, const std::string& more)
{
	ContentHash hash;
	hash.add(key);
	hash.add(more);
	return hash.text();
}

class Builder
{
public:
	Builder(const std::vector<PlanCommand>& commands, const PlanSettings& settings)
		: m_commands(commands), m_settings(settings), m_before(beforeEach(commands)), m_depths(depthsOf(commands, m_before)),
		  m_keys(commands.size()), m_last_group(commands.size())
	{
	}

	Plan plan()
	{
		Plan plan{m_settings.title, m_settings.version, m_settings.program, m_settings.work, m_settings.engine, {}, {}};
		std::size_t deepest = 0;
		for (const std::size_t depth : m_depths)
		{
			deepest = std::max(deepest, depth);
		}
		for (std::size_t depth = 0; depth <= deepest + 1; ++depth)
		{
			addDepth(plan, depth);
		}
		return plan;
	}

private:
	void addDepth(Plan& plan, std::size_t depth)
	{
		for (std::size_t i = 0; i < m_commands.size(); ++i)
		{
			if (m_depths[i] == depth)
			{
				addCommand(plan, i);
			}
			else if (m_commands[i].parts > 1 && m_depths[i] + 1 == depth)
			{
				addMerge(plan, i);
			}
		}
	}

	std::string keyOf(std::size_t index)
	{
		const PlanCommand& command = m_commands[index];
		ContentHash hash;
		hash.add("nook.plan/1");
		hash.add(m_settings.version);
		hash.add(static_cast<double>(command.parts));
		for (const std::vector<std::string>* words : {&command.words, &command.out_words})
		{
			hash.add(static_cast<double>(words->size()));
			for (const std::string& word : *words)
			{
				hash.add(word);
			}
		}
		for (const std::size_t other : m_before[index])
		{
			hash.add(m_keys[other]);
		}
		for (const std::string& input : command.inputs)
		{
			hash.add(m_hashes.of(m_settings.work_folder, input));
		}
		return hash.text();
	}

	std::vector<std::size_t> afterOf(std::size_t index) const
	{
		std::vector<std::size_t> after;
		for (const std::size_t other : m_before[index])
		{
			after.push_back(m_last_group[other]);
		}
		std::sort(after.begin(), after.end());
		return after;
	}

	static std::string partName(const PlanCommand& command, int part)
	{
		const std::size_t digits = std::to_string(command.parts).size();
		const std::string number = std::to_string(part);
		return command.name + ".part" + std::string(digits - number.size(), '0') + number;
	}

	std::string partFile(const PlanCommand& command, int part) const
	{
		return m_settings.folder + "/parts/" + partName(command, part) + ".part";
	}

	void addCommand(Plan& plan, std::size_t index)
	{
		const PlanCommand& command = m_commands[index];
		m_keys[index] = keyOf(index);
		m_last_group[index] = plan.groups.size();
		PlanGroup group{command.name,   plan.jobs.size(), static_cast<std::size_t>(command.parts),
						afterOf(index), m_depths[index],  command.needs};
		group.needs.seconds = command.needs.load_seconds + (command.needs.seconds - command.needs.load_seconds) / command.parts;
		plan.groups.push_back(group);
		for (int part = 1; part <= command.parts; ++part)
		{
			PlanJob job{command.name, command.words, command.outputs, m_keys[index], command.tells};
			if (command.parts > 1)
			{
				const std::string of = std::to_string(part) + "/" + std::to_string(command.parts);
				job.name = partName(command, part);
				job.outputs = {partFile(command, part)};
				job.words.insert(job.words.end(), {"--part", of, "-o", job.outputs.front()});
				job.key = twoKeys(m_keys[index], of);
			}
			else
			{
				job.words.insert(job.words.end(), command.out_words.begin(), command.out_words.end());
			}
			plan.jobs.push_back(job);
		}
	}

	void addMerge(Plan& plan, std::size_t index)
	{
		const PlanCommand& command = m_commands[index];
		PlanJob job{command.name + ".merge", {"merge"}, command.outputs, twoKeys(m_keys[index], "merge"), true};
		for (int part = 1; part <= command.parts; ++part)
		{
			job.words.push_back(partFile(command, part));
		}
		job.words.insert(job.words.end(), command.out_words.begin(), command.out_words.end());
		job.words.insert(job.words.end(), {"--threads", std::to_string(command.needs.threads)});
		JobNeeds needs = command.needs;
		needs.seconds = std::max(command.needs.load_seconds, 10.0);
		const std::size_t parts = m_last_group[index];
		m_last_group[index] = plan.groups.size();
		plan.groups.push_back({job.name, plan.jobs.size(), 1, {parts}, m_depths[index] + 1, needs});
		plan.jobs.push_back(job);
	}

	const std::vector<PlanCommand>& m_commands;
	const PlanSettings& m_settings;
	std::vector<std::vector<std::size_t>> m_before;
	std::vector<std::size_t> m_depths;
	std::vector<std::string> m_keys;
	std::vector<std::size_t> m_last_group; // of each command, as soon as it is there
	InputHashes m_hashes;
};

} // namespace

Plan planOf(const std::vector<PlanCommand>& commands, const PlanSettings& settings)
{
	std::size_t jobs = 0;
	for (const PlanCommand& command : commands)
	{
		jobs += static_cast<std::size_t>(command.parts) + 1;
	}
	if (jobs > kMostJobs)
	{
		refuse("jobs: found about " + std::to_string(jobs) + ", expected at most " + std::to_string(kMostJobs) + " in a plan");
	}
	return Builder(commands, settings).plan();
}

std::string doneFile(const std::string& job)
{
	return "state/" + job + ".done";
}

std::string exitFile(const std::string& job)
{
	return "state/" + job + ".exit";
}

std::string aliveFile(const std::string& job)
{
	return "state/" + job + ".alive";
}

std::string progressFile(const std::string& job)
{
	return "log/" + job + ".progress";
}

std::string errorFile(const std::string& job)
{
	return "log/" + job + ".err";
}

} // namespace nook
