// SPDX-License-Identifier: GPL-3.0-or-later
#include "run_verb.h"

#include "core/error.h"
#include "core/work_units.h"
#include "version.h"

#include <algorithm>
#include <array>
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

void runVerb(const Verb& verb, VerbProgress& progress)
{
	const CLI::App& app = parsedVerb(*verb.app);
	const CLI::Option* const option = app.get_option_no_throw("--part");
	if (option == nullptr || option->count() == 0)
	{
		verb.run(progress);
		return;
	}
	const std::string number = option->results().front();
	const std::size_t slash = number.find('/'); // addPart() has checked it
	WorkUnits units(PartNumber{std::stoi(number.substr(0, slash)), std::stoi(number.substr(slash + 1))});
	progress.divide(units);
	try
	{
		verb.run(progress);
	}
	catch (const PartIsDone&)
	{
		PartFile part = units.result();
		part.version = NOOK_VERSION;
		part.command = commandWords(app);
		OutputSet files;
		files.add(app.get_option("--output")->results().front(), partBytes(part));
		files.commit();
		return;
	}
	throw Error(ExitCode::unsupported, "--part: found a verb that has not shared out its work, expected one that does");
}

} // namespace nook
