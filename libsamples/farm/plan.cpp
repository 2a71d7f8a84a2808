// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/plan.h"

#include "core/costs.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_reader.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/text.h"
#include "farm/assets.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

namespace nook
{
namespace
{

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// The command that writes each file.
std::map<std::string, std::size_t> writersOf(const std::vector<PlanCommand>& commands)
{
	std::map<std::string, std::size_t> writers;
	std::set<std::string> names;
	for (std::size_t i = 0; i < commands.size(); ++i)
	{
		refuseIf(!names.insert(commands[i].name).second,
				 commands[i].name + ": found two jobs of that name, expected a name for each");
		for (const std::string& output : commands[i].outputs)
		{
			const auto [other, is_new] = writers.try_emplace(plainPath(output), i);
			refuseIf(!is_new, output + ": found that " + commands[other->second].name + " and " + commands[i].name +
								  " write it, expected another file for each");
		}
	}
	return writers;
}

// The commands that each command waits for, by what it reads.
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

std::string doneStamp(const std::string& job)
{
	return "done/" + job;
}

class Builder
{
public:
	Builder(const std::vector<PlanCommand>& commands, Plan plan, std::string folder)
		: m_commands(commands), m_plan(std::move(plan)), m_folder(std::move(folder)), m_before(beforeEach(commands)),
		  m_group(commands.size())
	{
	}

	// Commands in an order in which each comes after those that it waits for.
	Plan plan()
	{
		std::vector<char> added(m_commands.size(), 0);
		for (std::size_t rest = m_commands.size(); rest > 0;)
		{
			const std::size_t before = rest;
			for (std::size_t i = 0; i < m_commands.size(); ++i)
			{
				if (added[i] == 0 &&
					std::all_of(m_before[i].begin(), m_before[i].end(), [&](std::size_t k) { return added[k] != 0; }))
				{
					add(i);
					added[i] = 1;
					rest -= 1;
				}
			}
			if (rest == before)
			{
				const auto first = static_cast<std::size_t>(std::find(added.begin(), added.end(), 0) - added.begin());
				throw Error(ExitCode::usage,
							m_commands[first].name +
								": found that it waits for itself by way of others, expected commands in an order");
			}
		}
		return std::move(m_plan);
	}

private:
	// The files that a job reads: the command's, what others write for it, and the marks of jobs before it.
	std::vector<std::string> inputsOf(const PlanCommand& command, const std::vector<std::size_t>& after) const
	{
		std::vector<std::string> inputs = command.inputs;
		for (const std::size_t group : after)
		{
			for (std::size_t i = 0; i < m_plan.groups[group].count; ++i)
			{
				inputs.push_back(m_folder + "/" + doneStamp(m_plan.jobs[m_plan.groups[group].first + i].name));
			}
		}
		return inputs;
	}

	void add(std::size_t index)
	{
		const PlanCommand& command = m_commands[index];
		std::vector<std::size_t> after = mapped(m_before[index], [this](std::size_t other) { return m_group[other]; });
		std::sort(after.begin(), after.end());
		std::vector<std::string> words = command.words;
		if (!command.identity.empty())
		{
			words.insert(words.end(), {"--cache", m_folder + "/cache"});
		}
		JobNeeds needs = command.needs;
		if (command.shares > 1)
		{
			const double shared_s = needs.seconds - needs.load_seconds;
			needs.seconds = needs.load_seconds + shared_s / command.shares;
			const std::vector<std::string> inputs = inputsOf(command, after);
			m_plan.groups.push_back(
				{command.name + ".share", m_plan.jobs.size(), static_cast<std::size_t>(command.shares), after, needs});
			after = {m_plan.groups.size() - 1};
			const std::string of = std::to_string(command.shares);
			for (int share = 1; share <= command.shares; ++share)
			{
				const std::string number = std::to_string(share);
				std::vector<std::string> part = words;
				part.insert(part.end(), {"--share", number + "/" + of});
				m_plan.jobs.push_back({command.name + ".share" + std::string(of.size() - number.size(), '0') + number,
									   part,
									   {},
									   inputs,
									   command.identity,
									   WorkShare{share, command.shares}});
			}
			needs.seconds = std::max(command.needs.load_seconds, 10.0);
		}
		m_group[index] = m_plan.groups.size();
		const std::vector<std::string> inputs = inputsOf(command, after);
		m_plan.groups.push_back({command.name, m_plan.jobs.size(), 1, after, needs});
		m_plan.jobs.push_back({command.name, words, command.outputs, inputs, command.identity, std::nullopt});
	}

	const std::vector<PlanCommand>& m_commands;
	Plan m_plan;
	std::string m_folder;
	std::vector<std::vector<std::size_t>> m_before;
	std::vector<std::size_t> m_group; // that writes each command's outputs
};

std::string quotedWords(const std::vector<std::string>& words)
{
	return joinedText(words, "", [](const std::string& word) { return " " + shellQuoted(word); });
}

// One line per job, the arguments of run() in job.sh.
std::string jobsText(const Plan& plan)
{
	const auto lineOf = [](const PlanJob& job)
	{
		return job.name + quotedWords(job.outputs) + " --" + quotedWords(job.inputs) + " --" + quotedWords(job.words) + "\n";
	};
	return joinedText(plan.jobs, "", lineOf);
}

// One line per group, a call of group() in submit.sh.
std::string groupsText(const Plan& plan)
{
	std::string text = "# group NUMBER FIRST LAST MINUTES MIB THREADS NAME AFTER...\n";
	for (std::size_t i = 0; i < plan.groups.size(); ++i)
	{
		const PlanGroup& group = plan.groups[i];
		text += "group " + std::to_string(i + 1) + " " + std::to_string(group.first + 1) + " " +
				std::to_string(group.first + group.count) + " " + std::to_string(minutesToAsk(group.needs)) + " " +
				std::to_string(mebibytesToAsk(group.needs)) + " " + std::to_string(group.needs.threads) + " " + group.name;
		text += joinedText(group.after, "", [](const std::size_t other) { return " " + std::to_string(other + 1); });
		text += "\n";
	}
	return text;
}

// job.sh decides whether a job is up to date, so every target is phony.
std::string makefileText(const Plan& plan)
{
	std::string text = "# make -j N, in this folder: runs the jobs that are not up to date. Written by nook plan.\nall:";
	std::string rules;
	std::string phony = ".PHONY: all";
	for (std::size_t g = 0; g < plan.groups.size(); ++g)
	{
		const PlanGroup& group = plan.groups[g];
		text += " group" + std::to_string(g + 1);
		rules += "group" + std::to_string(g + 1) + ":";
		phony += " group" + std::to_string(g + 1);
		std::string jobs;
		for (std::size_t i = group.first; i < group.first + group.count; ++i)
		{
			rules += " job" + std::to_string(i + 1);
			phony += " job" + std::to_string(i + 1);
			jobs += "job" + std::to_string(i + 1) + ":";
			jobs += joinedText(group.after, "", [](const std::size_t other) { return " group" + std::to_string(other + 1); });
			jobs += "\n\t@sh job.sh " + std::to_string(i + 1) + "\n";
		}
		rules += "\n" + jobs;
	}
	return text + "\n" + rules + phony + "\n";
}

std::string jobScript(const Plan& plan)
{
	std::string text(assets::job_sh);
	const auto fill = [&text](const std::string& name, const std::string& value)
	{
		text.replace(text.find(name), name.size(), value);
	};
	fill("@WORK@", shellQuoted(plan.work));
	fill("@PROGRAM@", shellQuoted(plan.program));
	fill("@VERSION@", shellQuoted(plan.version));
	return text;
}

std::string planJson(const Plan& plan)
{
	Json root{{"schema", "nook.plan/2"}, {"version", plan.version}, {"title", plan.title},
			  {"engine", plan.engine},   {"program", plan.program}, {"work", plan.work}};
	const auto groupJson = [&](const PlanGroup& group)
	{
		return Json{{"name", group.name},
					{"first", group.first + 1},
					{"jobs", group.count},
					{"after", mapped(group.after, [&](const std::size_t other) { return plan.groups[other].name; })},
					{"threads", group.needs.threads},
					{"ask_minutes", minutesToAsk(group.needs)},
					{"ask_memory_mib", mebibytesToAsk(group.needs)}};
	};
	const auto jobJson = [](const PlanJob& job)
	{
		return Json{{"name", job.name},
					{"command", job.words},
					{"outputs", job.outputs},
					{"identity", job.identity},
					{"share", job.share ? Json{job.share->number, job.share->of} : Json()}};
	};
	root["groups"] = mapped(plan.groups, groupJson);
	root["jobs"] = mapped(plan.jobs, jobJson);
	return jsonFile(root);
}

constexpr double kTimeMargin = 3.0; // machines of a farm differ, and so do levels
constexpr double kMemoryMargin = 1.5;

// The work that the jobs share, without what each does by itself.
double sharedSeconds(const JobNeeds& needs, std::size_t jobs)
{
	return (needs.seconds - needs.load_seconds) * static_cast<double>(jobs);
}

using Values = std::map<std::string, std::string>;

void addValues(Values& values, const JsonValue& holder)
{
	if (!holder.has("values"))
	{
		return;
	}
	const JsonValue object = holder.at("values");
	object.requireObject();
	for (const auto& item : object.value->items())
	{
		failIf(item.key() == "level" || item.key() == "name" || item.key() == "here", object.at(item.key()), "a value of that name",
			   "another: {" + item.key() + "} has a meaning of its own");
		values[item.key()] = object.at(item.key()).string();
	}
}

// A word with {name}s in it.
std::string filled(const JsonValue& word, const Values& values)
{
	const std::string text = word.string();
	std::string result;
	for (std::size_t at = 0; at < text.size();)
	{
		if (text[at] != '{')
		{
			result += text[at++];
			continue;
		}
		const std::size_t end = std::min(text.find('}', at), text.size());
		const auto value = values.find(text.substr(at + 1, end - at - 1));
		failIf(end == text.size() || value == values.end(), word, "'" + text.substr(at, end + 1 - at) + "'",
			   "{level}, {name}, {here} or a name of \"values\" in braces");
		result += value->second;
		at = end + 1;
	}
	return result;
}

int optional(const JsonValue& step, const char* field, int otherwise, int most)
{
	return step.has(field) ? static_cast<int>(step.at(field).integer(1, most)) : otherwise;
}

ListedCommand commandFromStep(const JsonValue& step, const Values& values)
{
	step.allowOnly({"name", "command", "shares", "minutes", "memory_mib"});
	ListedCommand command;
	command.name = values.at("name") + "." + step.at("name").string();
	command.words = step.at("command").elements([&](const JsonValue& word) { return filled(word, values); });
	command.shares = optional(step, "shares", 1, kMaxPlanShares);
	command.minutes = optional(step, "minutes", 0, kMaxMinutes);
	command.mebibytes = optional(step, "memory_mib", 0, kMaxMebibytes);
	return command;
}

// The steps that a level names, or all.
std::vector<std::string> stepsOf(const JsonValue& level, const std::vector<std::string>& all)
{
	if (!level.has("steps"))
	{
		return all;
	}
	const std::vector<std::string> names = level.texts("steps");
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		failIf(std::find(all.begin(), all.end(), names[i]) == all.end(), level.at("steps").at(i), "'" + names[i] + "'",
			   "the name of a step");
	}
	return names;
}

void addThere(std::vector<std::string>& files, const std::string& of, const std::string& name)
{
	const std::filesystem::path path = nativePath(of).parent_path() / nativePath(name);
	std::error_code none;
	if (std::filesystem::is_regular_file(path, none))
	{
		files.push_back(path.string());
	}
}

std::vector<std::string> besideGltf(const std::string& path)
{
	std::vector<std::string> files;
	const nlohmann::json root = looseJson(readFile(path));
	for (const char* list : {"buffers", "images"})
	{
		if (!root.is_object() || !root.contains(list) || !root[list].is_array())
		{
			continue;
		}
		for (const nlohmann::json& item : root[list])
		{
			if (item.is_object() && item.contains("uri") && item["uri"].is_string())
			{
				const std::string uri = item["uri"].get<std::string>();
				if (!uri.starts_with("data:"))
				{
					addThere(files, path, unescaped(uri));
				}
			}
		}
	}
	return files;
}

// Names that follow some word at the beginning of a line: the whole rest, since names may have blanks, and each word, since options
// may stand before a name and several names in one line.
std::vector<std::string> namedIn(const std::string& path, const char* beginning)
{
	constexpr const char* kBlanks = " \t\r";
	std::vector<std::string> names;
	std::istringstream text(readFile(path));
	for (std::string line; std::getline(text, line);)
	{
		line.erase(0, line.find_first_not_of(kBlanks));
		line.erase(line.find_last_not_of(kBlanks) + 1);
		const std::size_t blank = line.find_first_of(kBlanks);
		if (!line.starts_with(beginning) || blank == std::string::npos)
		{
			continue;
		}
		names.push_back(line.substr(line.find_first_not_of(kBlanks, blank)));
		std::istringstream words(line.substr(blank));
		for (std::string word; words >> word;)
		{
			names.push_back(word);
		}
	}
	return names;
}

std::vector<std::string> besideObj(const std::string& path)
{
	std::vector<std::string> files;
	for (const std::string& name : namedIn(path, "mtllib"))
	{
		addThere(files, path, name);
	}
	const std::size_t materials = files.size();
	for (std::size_t i = 0; i < materials; ++i)
	{
		const std::string material = files[i];
		for (const std::string& name : namedIn(material, "map_"))
		{
			addThere(files, material, name);
		}
	}
	return files;
}

} // namespace

Plan planOf(std::vector<PlanCommand> commands, const Plan& plan, const std::string& folder)
{
	const std::size_t jobs =
		sumOver(commands, [](const PlanCommand& command) { return static_cast<std::size_t>(command.shares) + 1; });
	refuseIf(jobs > kMaxJobs,
			 "jobs: found about " + std::to_string(jobs) + ", expected at most " + std::to_string(kMaxJobs) + " in a plan");
	return Builder(commands, plan, folder).plan();
}

std::vector<PlanFile> planFiles(const Plan& plan)
{
	std::vector<PlanFile> files{{kPlanFile, planJson(plan)}, {"jobs", jobsText(plan)}, {"job.sh", jobScript(plan)}};
	if (plan.engine == "make")
	{
		files.push_back({"Makefile", makefileText(plan)});
	}
	else if (plan.engine == "slurm")
	{
		files.push_back({"groups", groupsText(plan)});
		files.push_back({"submit.sh", std::string(assets::submit_sh)});
	}
	else
	{
		files.push_back({"Snakefile", std::string(assets::Snakefile)});
	}
	return files;
}

Plan readPlan(const std::string& text, const std::string& path)
{
	const nlohmann::json json = parseJson(text, path);
	const JsonValue root{&json, &path, ""};
	root.at("schema").require(root.at("schema").string() == "nook.plan/2", "nook.plan/2");
	Plan plan;
	plan.version = root.at("version").string();
	plan.title = root.at("title").string();
	plan.work = root.at("work").string();
	const auto jobFrom = [](const JsonValue& item)
	{
		PlanJob job{item.at("name").string(), {}, item.texts("outputs"), {}, item.texts("identity"), std::nullopt};
		if (const JsonValue share = item.at("share"); !share.value->is_null())
		{
			share.require(share.arraySize() == 2, "[K, N]");
			job.share = WorkShare{static_cast<int>(share.at(0).integer(1, kMaxPlanShares)),
								  static_cast<int>(share.at(1).integer(1, kMaxPlanShares))};
		}
		return job;
	};
	plan.jobs = root.at("jobs").elements(jobFrom);
	return plan;
}

std::vector<char> doneJobs(const Plan& plan, const std::string& folder)
{
	const fs::path work = nativePath(folder) / nativePath(plan.work);
	std::optional<Store> store;
	std::error_code none;
	if (const fs::path cache = nativePath(folder) / "cache"; fs::is_directory(cache, none))
	{
		store.emplace(cache.string(), plan.version);
	}
	std::vector<char> done;
	for (const PlanJob& job : plan.jobs)
	{
		const bool there = std::all_of(job.outputs.begin(), job.outputs.end(),
									   [&](const std::string& output) { return fs::exists(work / nativePath(output), none); });
		const bool kept = job.identity.empty() ? fs::exists(nativePath(folder) / doneStamp(job.name), none)
											   : store && finishedUnits(*store, job.identity, job.share, work.string()).has_value();
		done.push_back(there && kept ? 1 : 0);
	}
	return done;
}

std::string plainPath(const std::string& path)
{
	return nativePath(path).lexically_normal().generic_string();
}

int minutesToAsk(const JobNeeds& needs)
{
	return needs.minutes > 0
			   ? needs.minutes
			   : static_cast<int>(std::clamp(std::ceil(kTimeMargin * needs.seconds / 60.0) + 5.0, 1.0, double{kMaxMinutes}));
}

int mebibytesToAsk(const JobNeeds& needs)
{
	return needs.mebibytes > 0
			   ? needs.mebibytes
			   : static_cast<int>(std::clamp(std::ceil(kMemoryMargin * needs.bytes / 1048576.0), 64.0, double{kMaxMebibytes}));
}

double trianglesOfFile(const std::string& ending, double bytes)
{
	// A triangle has half a vertex: 12 to 16 bytes of indices and as many of position, normal and texture in binary; a line of text
	// for a face and half of three.
	const bool text = ending == ".obj" || ending == ".gltf";
	return bytes / (text ? 80.0 : 30.0);
}

double overheadOf(const JobNeeds& needs, std::size_t jobs)
{
	return needs.known ? needs.seconds * static_cast<double>(jobs) / (needs.load_seconds + sharedSeconds(needs, jobs)) : 1.0;
}

std::size_t mostJobs(const JobNeeds& needs, std::size_t jobs)
{
	const double single = needs.load_seconds + sharedSeconds(needs, jobs);
	return 1 + static_cast<std::size_t>((kOverhead - 1.0) * single / needs.load_seconds);
}

JobNeeds guessWork(const WorkFacts& facts, int threads)
{
	JobNeeds needs;
	needs.threads = threads;
	needs.known = true;
	needs.load_seconds = cost::kStart_s + cost::kLoad_s * facts.triangles;
	needs.bytes = cost::kProgram_bytes + cost::kTriangle_bytes * facts.triangles + cost::kPixel_bytes * facts.pixels;
	double work_s = 0.0;
	if (facts.verb == "reference")
	{
		// A tree of four times the triangles is one level deeper, of ten or so.
		const double deeper = 1.0 + 0.1 * std::log2(std::max(facts.triangles, 1e5) / 1e5);
		work_s = facts.pixels * facts.rays * cost::kRay_s * deeper;
	}
	else if (facts.verb == "bake" && !facts.open_end)
	{
		work_s = facts.pixels * facts.rays * cost::kRay_s;
	}
	else if (facts.verb == "volumes")
	{
		work_s = facts.triangles * (facts.looks_on ? cost::kBuiltVolume_s : cost::kVolume_s);
		needs.bytes += facts.triangles * (facts.looks_on ? cost::kBuiltVolume_bytes : cost::kVolume_bytes);
	}
	else if (facts.verb == "gbuffer" || facts.verb == "shade" || facts.verb == "compare" || facts.verb == "level" ||
			 facts.verb == "info")
	{
		work_s = facts.pixels * cost::kPixel_s;
	}
	else
	{
		needs.known = false;
		needs.bytes = std::max(needs.bytes, JobNeeds{}.bytes);
		needs.seconds = JobNeeds{}.seconds;
		return needs;
	}
	needs.seconds = needs.load_seconds + work_s / threads;
	return needs;
}

std::vector<ListedCommand> readLevelList(const std::string& text, const std::string& path, const std::string& here)
{
	const nlohmann::json json = parseJson(text, path);
	const JsonValue root{&json, &path, ""};
	root.allowOnly({"schema", "values", "steps", "levels"});
	root.at("schema").require(root.at("schema").string() == "nook.levels/1", "nook.levels/1");
	const JsonValue steps = root.at("steps");
	const JsonValue levels = root.at("levels");
	const std::vector<std::string> all = steps.elements([](const JsonValue& step) { return step.at("name").string(); });
	std::vector<ListedCommand> commands;
	for (std::size_t l = 0; l < levels.arraySize(); ++l)
	{
		const JsonValue level = levels.at(l);
		level.allowOnly({"name", "level", "values", "steps"});
		const std::vector<std::string> chosen = stepsOf(level, all);
		Values values;
		addValues(values, root);
		addValues(values, level);
		values["name"] = level.at("name").string();
		const std::string file = level.at("level").string();
		values["level"] = file.starts_with("/") || file.starts_with("builtin:") || here == "." ? file : here + "/" + file;
		values["here"] = here;
		for (std::size_t s = 0; s < all.size(); ++s)
		{
			if (std::find(chosen.begin(), chosen.end(), all[s]) != chosen.end())
			{
				commands.push_back(commandFromStep(steps.at(s), values));
			}
		}
	}
	failIf(commands.empty(), root, "nothing to do", "at least one level and one step");
	return commands;
}

std::vector<std::string> filesNextTo(const std::string& path)
{
	const std::string ending = nativePath(path).extension().string();
	std::error_code failed;
	if (std::filesystem::file_size(nativePath(path), failed) > kMaxFileBytes || failed)
	{
		return {};
	}
	return ending == ".gltf" ? besideGltf(path) : ending == ".obj" ? besideObj(path) : std::vector<std::string>{};
}

} // namespace nook
