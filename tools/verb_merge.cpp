// SPDX-License-Identifier: GPL-3.0-or-later
// nook merge: the parts of a command → what the command makes.
#include "options.h"
#include "run_verb.h"
#include "verbs.h"

#include "core/error.h"
#include "core/file.h"
#include "core/work_units.h"
#include "version.h"

#include <algorithm>

namespace nook
{
namespace
{

struct MergeOptions
{
	std::vector<std::string> parts;
	Outputs outputs;
	int threads = 0;
};

void declare(CLI::App& app, MergeOptions& options)
{
	app.add_option("PARTS", options.parts, "Files of --part, all of one command, in any order")->required()->type_name("PART");
	const auto take = [&options](const std::vector<std::string>& files)
	{
		for (const std::string& file : files)
		{
			if (file.empty() || (file.size() > 1 && file[0] == '-'))
			{
				refuseValue("-o", file, "FILE");
			}
		}
		options.outputs.files = files;
	};
	app.add_option_function<std::vector<std::string>>("-o,--output", take, "As the command's own; may be repeated where it may be")
		->type_name("FILE")
		->allow_extra_args(false);
	addJson(app, options.outputs.json);
	addThreads(app, options.threads);
	addProgress(app, options.outputs.progress);
}

std::vector<PartFile> readParts(const MergeOptions& options)
{
	std::vector<PartFile> parts;
	for (const std::string& path : options.parts)
	{
		parts.push_back(partFrom(readFile(path), path));
	}
	checkParts(parts, NOOK_VERSION);
	return parts;
}

// The command as it would be given, with the outputs of the merge.
std::vector<std::string> wordsOf(const std::vector<std::string>& command, const MergeOptions& options)
{
	std::vector<std::string> words = command;
	const auto add = [&words](const char* name, const std::string& value)
	{
		if (!value.empty())
		{
			words.insert(words.end(), {name, value});
		}
	};
	for (const std::string& file : options.outputs.files)
	{
		add("-o", file);
	}
	add("--json", options.outputs.json);
	add("--progress", options.outputs.progress);
	add("--threads", options.threads > 0 ? std::to_string(options.threads) : "");
	return words;
}

void run(const MergeOptions& options, VerbProgress& progress)
{
	std::vector<std::string> written = options.outputs.files;
	std::erase_if(written, [](const std::string& path) { return path == "-"; });
	checkNames({written, options.outputs.json, {}, options.outputs.progress}, options.parts);
	std::vector<PartFile> parts = readParts(options);
	const std::vector<std::string> command = parts.front().command;
	const std::string path = parts.front().path;

	CLI::App nook;
	nook.require_subcommand(1);
	nook.allow_windows_style_options(false);
	const std::vector<Verb> verbs = addVerbs(nook);
	try
	{
		std::vector<std::string> words = wordsOf(command, options);
		std::reverse(words.begin(), words.end()); // as CLI11 takes them
		nook.parse(std::move(words));
	}
	catch (const CLI::ParseError& error)
	{
		throw Error(ExitCode::usage, path + ": nook " + command.front() + ": " + error.what());
	}
	const CLI::App& app = parsedVerb(nook);
	if (commandWords(app) != command || app.get_option_no_throw("--part") == nullptr)
	{
		throw Error(ExitCode::invalid_input, path + ": found a part of a command that has none, expected one that takes --part");
	}
	WorkUnits units(std::move(parts));
	progress.divide(units);
	for (const Verb& verb : verbs)
	{
		if (verb.app->parsed())
		{
			verb.run(progress);
		}
	}
}

} // namespace

Verb addMergeVerb(CLI::App& nook)
{
	const auto options = std::make_shared<MergeOptions>();
	CLI::App* const app = nook.add_subcommand("merge", "Puts the parts of a command together: the same bytes as in one run");
	declare(*app, *options);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
