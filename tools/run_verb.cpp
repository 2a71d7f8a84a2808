// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_verb.h"

#include "core/error.h"
#include "core/text.h"
#include "core/work_units.h"
#include "version.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string_view>

namespace nook
{
namespace
{

// What never changes a byte, or says where bytes go.
constexpr std::array<std::string_view, 7> kOutside{"--output",   "--json",  "--depfile", "--threads",
												   "--progress", "--share", "--cache"};

void addWords(std::vector<std::string>& words, const CLI::Option& option)
{
	const std::string name = option.get_name();
	if (std::find(kOutside.begin(), kOutside.end(), name) != kOutside.end())
	{
		return;
	}
	for (const std::string& value : option.results())
	{
		if (!option.get_positional())
		{
			words.push_back(name);
		}
		if (option.get_expected_max() > 0) // else a flag
		{
			words.push_back(value);
		}
	}
}

} // namespace

const CLI::App& parsedVerb(const CLI::App& app)
{
	const CLI::App* verb = &app;
	while (!verb->get_subcommands().empty())
	{
		verb = verb->get_subcommands().front();
	}
	return *verb;
}

std::vector<std::string> commandWords(const CLI::App& verb)
{
	std::vector<std::string> words;
	for (const CLI::App* app = &verb; app->get_parent() != nullptr; app = app->get_parent())
	{
		words.insert(words.begin(), app->get_name());
	}
	for (const bool positional : {true, false}) // an option that takes several values takes what follows it
	{
		for (const CLI::Option* const option : verb.get_options())
		{
			if (option->get_positional() == positional)
			{
				addWords(words, *option);
			}
		}
	}
	return words;
}

std::vector<std::string> identityOf(std::vector<std::string> command)
{
	command.insert(command.begin(), NOOK_VERSION);
	return command;
}

void runVerb(const Verb& verb, VerbProgress& progress)
{
	const CLI::App& app = parsedVerb(*verb.app);
	const auto given = [&app](const char* name)
	{
		const CLI::Option* const option = app.get_option_no_throw(name);
		return option != nullptr && option->count() > 0 ? option->results().front() : std::string();
	};
	const std::string cache = given("--cache");
	const std::string share = given("--share");
	if (cache.empty())
	{
		if (!share.empty())
		{
			throw Error(ExitCode::usage,
						"--share: found without --cache, expected --cache DIR, where the share's results are kept");
		}
		verb.run(progress);
		return;
	}
	WorkUnits units(cache, identityOf(commandWords(app)), share.empty() ? std::nullopt : shareOf(share));
	progress.divide(units);
	verb.run(progress);
	units.finish();
	if (const std::string remark = units.store().remark(); !remark.empty())
	{
		std::fprintf(stderr, "nook: cache: %s\n", oneLine(remark).c_str());
	}
	std::fprintf(stderr, "nook: %zu results made, %zu from the cache\n", units.store().kept() - 1, units.store().found());
}

} // namespace nook
