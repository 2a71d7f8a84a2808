// SPDX-License-Identifier: GPL-3.0-or-later
#include "plan_words.h"

#include "options.h"
#include "verbs.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "core/text.h"
#include "farm/estimate.h"
#include "farm/inputs.h"
#include "scene/builtin.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>

namespace nook
{
namespace
{

namespace fs = std::filesystem;

// "--gbuffer=g.exr" and "-og.exr" are two words each.
std::vector<std::string> splitWords(const std::vector<std::string>& words)
{
	std::vector<std::string> split;
	for (const std::string& word : words)
	{
		const std::size_t equals = word.find('=');
		if (word.find('\n') != std::string::npos || word.find('\0') != std::string::npos)
		{
			refuse("the command: found a word with a new line in it, expected none");
		}
		if (word.starts_with("--") && equals != std::string::npos)
		{
			split.insert(split.end(), {word.substr(0, equals), word.substr(equals + 1)});
		}
		else if (word.starts_with("-o") && word.size() > 2)
		{
			split.insert(split.end(), {"-o", word.substr(2)});
		}
		else
		{
			split.push_back(word);
		}
	}
	return split;
}

bool isBelow(const fs::path& path, const fs::path& folder)
{
	const fs::path inside = path.lexically_relative(folder);
	return !inside.empty() && *inside.begin() != "..";
}

// Names that begin with a slash as seen from the folder; none may lead out of the root.
std::string wordInPlace(const std::string& word, const CommandPlace& place)
{
	const bool whole = word.starts_with("/");
	if (!whole && word != ".." && word.find("../") == std::string::npos)
	{
		return word;
	}
	const fs::path folder = nativePath(place.folder);
	const fs::path path = fs::weakly_canonical(whole ? nativePath(word) : folder / nativePath(word));
	if (!isBelow(path, nativePath(place.root)))
	{
		refuse(word + ": found a name outside " + place.root + ", expected one in the folder that the farm mounts (--root)");
	}
	return whole ? path.lexically_relative(folder).generic_string() : word;
}

// The verb, with its options as they were given.
struct ParsedCommand
{
	CLI::App nook;
	std::vector<Verb> verbs; // they hold what the options are read into
	CLI::App* verb = nullptr;
	std::string name; // "report error"

	explicit ParsedCommand(const std::vector<std::string>& words)
	{
		nook.allow_windows_style_options(false);
		nook.require_subcommand(1);
		verbs = addVerbs(nook);
		try
		{
			nook.parse(std::vector<std::string>(words.rbegin(), words.rend()));
		}
		catch (const CLI::Success&)
		{
			refuse("the command: found one that asks for help, expected one that writes files");
		}
		catch (const CLI::ParseError& error)
		{
			refuse("the command '" + (words.empty() ? "" : words.front()) + "': " + error.what() + ", expected what nook " +
				   (words.empty() ? "" : words.front()) + " --help lists");
		}
		verb = &nook;
		while (!verb->get_subcommands().empty())
		{
			verb = verb->get_subcommands().front();
			name += (name.empty() ? "" : " ") + verb->get_name();
		}
	}

	bool has(const std::string& option) const
	{
		return verb->get_option_no_throw(option) != nullptr;
	}

	std::vector<std::string> values(const std::string& option) const
	{
		const CLI::Option* const found = verb->get_option_no_throw(option);
		return found != nullptr ? found->results() : std::vector<std::string>{};
	}

	std::optional<double> number(const std::string& option) const
	{
		const std::vector<std::string> found = values(option);
		double value = 0.0;
		return !found.empty() &&
					   readDecimal(found.front().data(), found.front().data() + found.front().size(), value).ec == std::errc{}
				   ? std::optional(value)
				   : std::nullopt;
	}
};

void checkForFarm(const ParsedCommand& parsed, const CommandChoice& choice)
{
	for (const char* verb : {"plan", "batch", "merge"})
	{
		if (parsed.name == verb)
		{
			refuse("the command: found " + parsed.name + ", expected a verb that makes something");
		}
	}
	for (const char* option : {"--part", "--depfile", "--progress"})
	{
		if (!parsed.values(option).empty())
		{
			refuse(std::string(option) + ": found in the command, expected none: the plan has its own");
		}
	}
	if (choice.parts > 1 && !parsed.has("--part"))
	{
		throw Error(ExitCode::unsupported, "--parts: found " + std::to_string(choice.parts) + " of nook " + parsed.name +
											   ", expected 1, since that verb has no --part");
	}
	std::vector<std::string> written = parsed.values("-o");
	const std::vector<std::string> json = parsed.values("--json");
	written.insert(written.end(), json.begin(), json.end());
	if (written.empty())
	{
		refuse("the command: found no -o FILE and no --json FILE, expected something to write");
	}
	if (std::find(written.begin(), written.end(), "-") != written.end())
	{
		refuse("-: found standard output in the command, expected files");
	}
}

// The data window of an EXR file's header (OpenEXR's "Technical Introduction": attributes are name, type, size, value).
double pixelsOfExr(const std::string& path)
{
	constexpr std::size_t kHeader = 1U << 16U;
	std::string begin(kHeader, '\0');
	std::FILE* const file = openFile(path, "rb");
	if (file == nullptr)
	{
		return 0.0;
	}
	begin.resize(std::fread(begin.data(), 1, begin.size(), file));
	std::fclose(file);
	constexpr std::string_view attribute("dataWindow\0box2i\0", 17);
	const std::size_t at = begin.find(attribute);
	std::array<int32_t, 4> box{};
	const std::size_t values = at + attribute.size() + 4;
	if (at == std::string::npos || values + sizeof box > begin.size())
	{
		return 0.0;
	}
	std::memcpy(box.data(), begin.data() + values, sizeof box);
	return (static_cast<double>(box[2]) - box[0] + 1.0) * (static_cast<double>(box[3]) - box[1] + 1.0);
}

// The folder may not be there yet, and "out/../a.glb" is then no name of a file.
fs::path placed(const CommandPlace& place, const std::string& name)
{
	return (nativePath(place.folder) / nativePath(name)).lexically_normal();
}

double bytesOf(const CommandPlace& place, const std::string& path)
{
	std::error_code failed;
	const auto bytes = fs::file_size(placed(place, path), failed);
	return failed ? 0.0 : static_cast<double>(bytes);
}

double trianglesOf(const CommandPlace& place, const std::string& level)
{
	if (!level.starts_with(kBuiltinPrefix))
	{
		return trianglesOfFile(nativePath(level).extension().string(), bytesOf(place, level));
	}
	const std::size_t colon = level.rfind(':');
	double triangles = 0.0;
	const char* const end = level.data() + level.size();
	const bool sized = readDecimal(level.data() + colon + 1, end, triangles).ec == std::errc{};
	return sized ? triangles : 10000.0; // as many as the largest has
}

constexpr double kVerticesOfTriangle = 0.75; // with values of their own: what Sponza has

WorkFacts factsOf(const ParsedCommand& parsed, const CommandPlace& place, const std::vector<std::string>& outputs, PixelsOf& pixels)
{
	WorkFacts facts;
	facts.verb = parsed.name;
	for (const std::string& level : parsed.values("LEVEL"))
	{
		facts.triangles += trianglesOf(place, level);
	}
	for (const char* option : {"--gbuffer", "FILE.exr", "FILE"})
	{
		for (const std::string& name : parsed.values(option))
		{
			const auto planned = pixels.find(plainPath(name));
			facts.pixels += planned != pixels.end() ? planned->second : pixelsOfExr(placed(place, name).string());
		}
	}
	for (const std::string& name : parsed.values("--points"))
	{
		facts.pixels += bytesOf(place, name) / 50.0; // six numbers a line
	}
	for (const std::string& size : parsed.values("--size"))
	{
		const std::size_t x = size.find('x');
		double width = 0.0;
		double height = 0.0;
		if (x != std::string::npos && readDecimal(size.data(), size.data() + x, width).ec == std::errc{} &&
			readDecimal(size.data() + x + 1, size.data() + size.size(), height).ec == std::errc{})
		{
			facts.pixels = width * height;
		}
	}
	facts.rays = parsed.number("--rays").value_or(256.0);
	const auto given = [&parsed](std::initializer_list<const char*> options)
	{
		return std::any_of(options.begin(), options.end(),
						   [&parsed](const char* option) { return !parsed.values(option).empty(); });
	};
	facts.looks_on = given({"--trim", "--compensate", "--drop-hidden", "--detail"});
	if (parsed.name == "bake")
	{
		const double across = parsed.number("--texture").value_or(0.0);
		facts.pixels = across > 0.0 ? across * across : kVerticesOfTriangle * facts.triangles;
		facts.open_end = given({"--max-error", "--probes"});
	}
	for (const std::string& output : outputs)
	{
		pixels[plainPath(output)] = facts.pixels;
	}
	return facts;
}

// What is read must be there, or be made by the plan.
void checkLevel(const ParsedCommand& parsed, const CommandPlace& place, const PixelsOf& planned)
{
	for (const char* option : {"LEVEL", "--gbuffer", "--points"})
	{
		for (const std::string& name : parsed.values(option))
		{
			std::error_code failed;
			if (!name.starts_with(kBuiltinPrefix) && planned.count(plainPath(name)) == 0 &&
				!fs::is_regular_file(placed(place, name), failed))
			{
				throw Error(ExitCode::file, name + ": cannot be read: found no such file, expected what the command reads");
			}
		}
	}
}

bool namesOutput(const std::string& word)
{
	return word == "-o" || word == "--output" || word == "--json";
}

} // namespace

bool isCommandName(const std::string& name)
{
	const auto is_plain = [](char letter)
	{
		return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9');
	};
	return !name.empty() && name.size() <= 48 && is_plain(name.front()) &&
		   std::all_of(name.begin(), name.end(),
					   [&](char letter) { return is_plain(letter) || letter == '.' || letter == '_' || letter == '-'; });
}

PlanCommand planCommandOf(std::vector<std::string> words, const CommandPlace& place, const CommandChoice& choice, PixelsOf& pixels)
{
	words = splitWords(words);
	for (std::string& word : words)
	{
		word = wordInPlace(word, place);
	}
	const ParsedCommand parsed(words);
	checkForFarm(parsed, choice);
	checkLevel(parsed, place, pixels);

	PlanCommand command;
	command.name = choice.name;
	command.verb = parsed.name;
	command.parts = choice.parts;
	command.tells = parsed.has("--progress");
	for (std::size_t i = 0; i < words.size(); ++i)
	{
		if (namesOutput(words[i]) && i + 1 < words.size())
		{
			command.out_words.insert(command.out_words.end(), {words[i], words[i + 1]});
			command.outputs.push_back(words[i + 1]);
			++i;
			continue;
		}
		command.words.push_back(words[i]);
		std::error_code failed;
		if (!words[i].empty() && fs::is_regular_file(placed(place, words[i]), failed) && pixels.count(plainPath(words[i])) == 0)
		{
			command.inputs.push_back(words[i]);
		}
	}
	const int threads = static_cast<int>(parsed.number("--threads").value_or(1.0));
	if (parsed.has("--threads") && parsed.values("--threads").empty())
	{
		command.words.insert(command.words.end(), {"--threads", "1"}); // all of a machine is not a farm's to give
	}
	command.needs = guessWork(factsOf(parsed, place, command.outputs, pixels), threads);
	command.needs.minutes = choice.minutes;
	command.needs.mebibytes = choice.mebibytes;
	return command;
}

} // namespace nook
