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
constexpr std::array<std::string_view, 7> kOutside{"--output",   "--json", "--depfile", "--threads",
												   "--progress", "--part", "--cache"};

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

namespace
{

PartFile identityOf(const CLI::App& verb)
{
	PartFile identity;
	identity.version = NOOK_VERSION;
	identity.command = commandWords(verb);
	return identity;
}

// --cache of verbs that keep units; report error and tune keep measurements themselves.
void runWhole(const Verb& verb, const CLI::App& app, VerbProgress& progress)
{
	const CLI::Option* const cache = givenUnitCache(app);
	if (cache == nullptr)
	{
		verb.run(progress);
		return;
	}
	WorkUnits units(cache->results().front(), identityOf(app));
	progress.divide(units);
	verb.run(progress);
	const WorkUnits::Kept& kept = units.kept();
	if (!kept.remark.empty())
	{
		std::fprintf(stderr, "nook: cache: %s\n", oneLine(kept.remark).c_str());
	}
	std::fprintf(stderr, "nook: %zu units made, %zu from the cache\n", kept.computed, kept.known);
}

} // namespace

void runVerb(const Verb& verb, VerbProgress& progress)
{
	const CLI::App& app = parsedVerb(*verb.app);
	const CLI::Option* const option = app.get_option_no_throw("--part");
	if (option == nullptr || option->count() == 0)
	{
		runWhole(verb, app, progress);
		return;
	}
	if (givenUnitCache(app) != nullptr)
	{
		throw Error(ExitCode::usage, "--cache: found with --part, expected one of them: a part that was killed is run again");
	}
	const std::string number = option->results().front();
	const std::size_t slash = number.find('/'); // addPart() has checked it
	WorkUnits units(PartNumber{std::stoi(number.substr(0, slash)), std::stoi(number.substr(slash + 1))}, identityOf(app));
	progress.divide(units);
	try
	{
		verb.run(progress);
	}
	catch (const PartIsDone&)
	{
		OutputSet files;
		files.add(app.get_option("--output")->results().front(), partBytes(units.result()));
		files.commit();
		return;
	}
	throw Error(ExitCode::unsupported, "--part: found a verb that has not shared out its work, expected one that does");
}

} // namespace nook
