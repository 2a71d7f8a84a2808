// SPDX-License-Identifier: GPL-3.0-or-later
#include "farm/plan.h"

#include "core/file.h"
#include "core/json_text.h"
#include "core/system.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <sstream>

namespace nook
{
namespace
{

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
