// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/file.h"
#include "core/json_reader.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/system.h"
#include "farm/plan.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <sstream>

namespace nook
{
namespace
{

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
		if (item.key() == "level" || item.key() == "name" || item.key() == "here")
		{
			object.at(item.key()).fail("a value of that name", "another: {" + item.key() + "} has a meaning of its own");
		}
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
		if (end == text.size() || value == values.end())
		{
			word.fail("'" + text.substr(at, end + 1 - at) + "'", "{level}, {name}, {here} or a name of \"values\" in braces");
		}
		result += value->second;
		at = end + 1;
	}
	return result;
}

std::string inFolder(const std::string& folder, const std::string& path)
{
	const bool stays = path.starts_with("/") || path.starts_with("builtin:") || folder == ".";
	return stays ? path : folder + "/" + path;
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
	const JsonValue words = step.at("command");
	for (std::size_t i = 0; i < words.arraySize(); ++i)
	{
		command.words.push_back(filled(words.at(i), values));
	}
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
		if (std::find(all.begin(), all.end(), names[i]) == all.end())
		{
			level.at("steps").at(i).fail("'" + names[i] + "'", "the name of a step");
		}
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

std::vector<ListedCommand> readLevelList(const std::string& text, const std::string& path, const std::string& here)
{
	const nlohmann::json json = parseJson(text, path);
	const JsonValue root{&json, &path, ""};
	root.allowOnly({"schema", "values", "steps", "levels"});
	if (root.at("schema").string() != "nook.levels/1")
	{
		root.at("schema").expected("nook.levels/1");
	}
	const JsonValue steps = root.at("steps");
	const JsonValue levels = root.at("levels");
	const std::vector<std::string> all =
		listOf(steps.arraySize(), [&steps](std::size_t s) { return steps.at(s).at("name").string(); });
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
		values["level"] = inFolder(here, level.at("level").string());
		values["here"] = here;
		for (std::size_t s = 0; s < all.size(); ++s)
		{
			if (std::find(chosen.begin(), chosen.end(), all[s]) != chosen.end())
			{
				commands.push_back(commandFromStep(steps.at(s), values));
			}
		}
	}
	if (commands.empty())
	{
		root.fail("nothing to do", "at least one level and one step");
	}
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
