// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/json_reader.h"
#include "core/json_text.h"
#include "core/text.h"
#include "farm/plan.h"

namespace nook
{

std::string planJson(const Plan& plan)
{
	nlohmann::ordered_json root;
	root["schema"] = "nook.plan/1";
	root["version"] = plan.version;
	root["title"] = plan.title;
	root["engine"] = plan.engine;
	root["program"] = plan.program;
	root["work"] = plan.work;
	nlohmann::ordered_json groups = nlohmann::ordered_json::array();
	for (const PlanGroup& group : plan.groups)
	{
		nlohmann::ordered_json item;
		item["name"] = group.name;
		item["first"] = group.first + 1;
		item["jobs"] = group.count;
		item["after"] = nlohmann::ordered_json::array();
		for (const std::size_t other : group.after)
		{
			item["after"].push_back(plan.groups[other].name);
		}
		item["depth"] = group.depth;
		item["estimated"] = group.needs.known;
		item["seconds"] = roundedNumber(group.needs.seconds, 4);
		item["memory_bytes"] = static_cast<uint64_t>(group.needs.bytes);
		item["threads"] = group.needs.threads;
		item["ask_minutes"] = minutesToAsk(group.needs);
		item["ask_memory_mib"] = mebibytesToAsk(group.needs);
		groups.push_back(item);
	}
	root["groups"] = groups;
	nlohmann::ordered_json jobs = nlohmann::ordered_json::array();
	for (const PlanJob& job : plan.jobs)
	{
		nlohmann::ordered_json item;
		item["name"] = job.name;
		item["key"] = job.key;
		item["command"] = job.words;
		item["outputs"] = job.outputs;
		item["progress"] = job.tells;
		jobs.push_back(item);
	}
	root["jobs"] = jobs;
	return jsonFile(root);
}

namespace
{

PlanGroup readGroup(const JsonValue& item, const Plan& plan)
{
	PlanGroup group;
	group.name = item.at("name").string();
	group.first = item.at("first").whole(kMostJobs);
	group.count = item.at("jobs").whole(kMostJobs);
	if (group.first < 1 || group.count < 1)
	{
		item.fail("a group without jobs", "at least one");
	}
	group.first -= 1;
	for (const std::string& name : item.texts("after"))
	{
		std::size_t other = 0;
		while (other < plan.groups.size() && plan.groups[other].name != name)
		{
			++other;
		}
		if (other == plan.groups.size())
		{
			item.fail("after", "'" + name + "'", "a group before this one");
		}
		group.after.push_back(other);
	}
	group.depth = item.at("depth").whole(kMostJobs);
	group.needs.known = item.at("estimated").boolean();
	group.needs.seconds = item.at("seconds").number(0.0, 1e18);
	group.needs.bytes = item.at("memory_bytes").number(0.0, 1e18);
	group.needs.threads = static_cast<int>(item.at("threads").integer(1, 1024));
	group.needs.minutes = static_cast<int>(item.at("ask_minutes").integer(1, kMostMinutes));
	group.needs.mebibytes = static_cast<int>(item.at("ask_memory_mib").integer(1, kMostMebibytes));
	return group;
}

} // namespace

Plan readPlan(const std::string& text, const std::string& path)
{
	const nlohmann::json json = parseJson(text, path);
	const JsonValue root{&json, &path, ""};
	root.requireObject();
	if (root.at("schema").string() != "nook.plan/1")
	{
		root.at("schema").expected("nook.plan/1");
	}
	Plan plan{root.at("title").string(),
			  root.at("version").string(),
			  root.at("program").string(),
			  root.at("work").string(),
			  root.at("engine").string(),
			  {},
			  {}};
	const JsonValue jobs = root.at("jobs");
	for (std::size_t i = 0; i < jobs.arraySize(); ++i)
	{
		const JsonValue item = jobs.at(i);
		item.requireObject();
		plan.jobs.push_back({item.at("name").string(), item.texts("command"), item.texts("outputs"), item.at("key").string(),
							 item.at("progress").boolean()});
		const std::string& name = plan.jobs.back().name;
		if (name.empty() || name.find('/') != std::string::npos)
		{
			item.at("name").expected("a name without slashes");
		}
	}
	const JsonValue groups = root.at("groups");
	for (std::size_t i = 0; i < groups.arraySize(); ++i)
	{
		const PlanGroup group = readGroup(groups.at(i), plan);
		if (group.first + group.count > plan.jobs.size())
		{
			groups.at(i).fail("jobs that are not there", "those of the plan");
		}
		plan.groups.push_back(group);
	}
	return plan;
}

} // namespace nook
