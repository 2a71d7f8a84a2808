// SPDX-License-Identifier: GPL-3.0-or-later
// Command line → one verb, and its exit code. The only place that prints errors and exits.
#include "program.h"

#include "core/error.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/text.h"
#include "core/work_units.h"
#include "options.h"
#include "version.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace nook
{

void refuseWithout(const std::string& component, const std::string& what)
{
	throw Error(ExitCode::unsupported, what + ": found a program without the component " + component +
										   ", expected one that was built with it (NOOK_COMPONENTS)");
}

namespace
{

// It stands in the help, and says that it is not there.
[[maybe_unused]] Verb absentVerb(CLI::App& app, const std::string& name, const std::string& component)
{
	CLI::App* const verb = app.add_subcommand(name, "Not in this build: needs the component " + component);
	verb->allow_extras();
	const std::string whole = app.get_parent() != nullptr ? app.get_name() + " " + name : name;
	return {verb, [whole, component](VerbProgress&)
			{
				refuseWithout(component, whole);
			}};
}

template <bool there, class Add> Verb verbOf(CLI::App& nook, const char* name, const char* component, const Add& add)
{
	if constexpr (there)
	{
		return add(nook);
	}
	else
	{
		return absentVerb(nook, name, component);
	}
}

// Options that never change a byte, or say where bytes go.
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

// Names from a file may be of any length: of a line as long as that, the beginning and the end are shown.
std::string shortened(const std::string& line)
{
	constexpr std::size_t kMost = 2000;
	if (line.size() <= kMost)
	{
		return line;
	}
	const auto letter = [&](std::size_t at) // where one begins: no UTF-8 is cut
	{
		while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0U) == 0x80U)
		{
			++at;
		}
		return at;
	};
	return line.substr(0, letter(kMost / 2)) + " ... " + line.substr(letter(line.size() - kMost / 2));
}
int failed(VerbProgress& progress, ExitCode code, const std::string& message)
{
	const std::string line = shortened(oneLine(message));
	progress.end(code, line);
	std::fprintf(stderr, "nook: %s\n", line.c_str());
	return static_cast<int>(code);
}
// The verbs that one of `app` may be: "pattern, tile or info".
std::string verbsOf(const CLI::App& app)
{
	const std::vector<const CLI::App*> verbs = app.get_subcommands([](const CLI::App*) { return true; });
	const std::vector<std::string> names = mapped(verbs, [](const CLI::App* verb) { return verb->get_name(); });
	return names.empty() ? "" : spokenList(std::vector<std::string_view>(names.begin(), names.end()));
}
// The verb that was parsed below `app`: of "report", say, "error".
const CLI::App& parsedVerb(const CLI::App& app)
{
	const CLI::App* verb = &app;
	while (!verb->get_subcommands().empty())
	{
		verb = verb->get_subcommands().front();
	}
	return *verb;
}

// CLI11's wording, with what to do about it.
std::string misuseText(const CLI::App& program, const CLI::ParseError& error)
{
	const CLI::App& app = parsedVerb(program);
	const std::string verbs = verbsOf(app);
	if (!verbs.empty())
	{
		// Nothing but a verb can follow here; CLI11 would only say that one is missing.
		const std::vector<std::string> found = app.remaining();
		return (found.empty() ? "no verb" : "verb: found '" + found.front() + "'") + ", expected " + verbs;
	}
	std::string command = app.get_name();
	for (const CLI::App* above = app.get_parent(); above != nullptr; above = above->get_parent())
	{
		command = above->get_name() + " " + command;
	}
	return std::string(error.what()) + ", expected what '" + command + " --help' lists";
}
// The library speaks of values, which are options here: where a message begins with one or names one in brackets, it is written as
// in the command: "count: found 0" → "--count: found 0", "symmetric centre: ...", "... (threads)". Errors of files begin with a
// file's name, which may be that of an option.
std::string withOptions(const CLI::App& verb, const Error& error)
{
	std::string message = error.what();
	const auto dashed = [&](std::size_t at) // what follows the option there, or the end where none is
	{
		const std::size_t end = std::min(message.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-", at), message.size());
		const std::string option = "--" + message.substr(at, end - at);
		const bool ends = end < message.size() && std::string_view(": )").find(message[end]) != std::string_view::npos;
		if (!ends || end == at || verb.get_option_no_throw(option) == nullptr)
		{
			return message.size();
		}
		message.replace(at, end - at, option);
		return at + option.size();
	};
	for (std::size_t at = message.find('('); at < message.size(); at = message.find('(', at + 1))
	{
		dashed(at + 1);
	}
	const bool names_file = error.code() == ExitCode::file || error.code() == ExitCode::invalid_input;
	const std::size_t colon = std::min(message.find(": "), message.size());
	if (!names_file &&
		std::count(message.begin(), message.begin() + static_cast<std::ptrdiff_t>(colon), ' ') < 2) // with its value, or another
	{
		dashed(std::min(dashed(0) + 1, message.size()));
	}
	return message;
}
std::string versionText()
{
	std::string text = "nook " NOOK_VERSION "\ncomponents: patterns";
	for (const auto& [there, name] :
		 {std::pair(kHasLevels, " levels"), std::pair(kHasShading, " shading"), std::pair(kHasReports, " reports")})
	{
		text += there ? name : "";
	}
	return text + "\ncommit: " + kCommit + "\n";
}
// Runs a parsed verb, as a whole or as a share, and keeps results with --cache. Throws what the verb throws.
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
		refuseIf(!share.empty(), "--share: found without --cache, expected --cache DIR, where the share's results are kept");
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

void run(const std::vector<std::string>& command, VerbProgress& progress)
{
	CLI::App nook(NOOK_DESCRIPTION);
	nook.name("nook");
	nook.set_version_flag("--version", versionText(), "Print the version, the components and the commit, and exit");
	nook.set_help_flag("-h,--help", "Print this help and exit");
	nook.allow_windows_style_options(false); // /patterns is a folder everywhere
	nook.require_subcommand(1);
	nook.footer("Exit codes: 0 ok, 1 usage, 2 file cannot be read or written, 3 invalid input, 4 failed at run time,\n"
				"5 not supported, 7 difference found.");
	const std::vector<Verb> verbs = addVerbs(nook);
	try
	{
		std::vector<std::string> words(command.rbegin(), command.rend()); // as CLI11 takes them
		words.resize(std::max<std::size_t>(words.size(), 1) - 1);         // without the program's name
		nook.parse(std::move(words));
		for (const Verb& verb : verbs)
		{
			if (verb.app->parsed())
			{
				runVerb(verb, progress);
			}
		}
	}
	catch (const CLI::CallForHelp&)
	{
		writeFile("-", nook.help());
	}
	catch (const CLI::CallForVersion&)
	{
		writeFile("-", versionText());
	}
	catch (const CLI::ParseError& error)
	{
		refuse(misuseText(nook, error));
	}
	catch (const Error& error)
	{
		throw Error(error.code(), withOptions(parsedVerb(nook), error));
	}
}
constexpr const char* kNoMemory = "memory: found none left, expected a smaller task";
// Where a library throws what nobody can catch: in a thread of its own (oneTBB's, where no other can be started), or on its way out
// of another error. Nothing here asks for memory.
[[noreturn]] void endAtOnce() noexcept
{
	static std::atomic_flag said;
	while (said.test_and_set())
	{
		waitForEnd(); // another thread has something to say, too
	}
	const char* message = "an error that cannot be handled";
	try
	{
		if (std::current_exception() != nullptr)
		{
			throw;
		}
	}
	catch (const std::bad_alloc&)
	{
		message = kNoMemory;
	}
	catch (const std::exception& error)
	{
		message = error.what();
	}
	catch (...)
	{
	}
	std::fprintf(stderr, "%snook: %s\n", isTerminal() ? "\r\033[K" : "", message);
	removeTemporaryFiles();
	std::_Exit(static_cast<int>(ExitCode::runtime));
}

} // namespace

// Functions of components that are not there are named in generic lambdas alone: what is not called is not linked.
std::vector<Verb> addVerbs(CLI::App& nook)
{
	return {addPatternVerb(nook),
			addTileVerb(nook),
			addCatalogueVerb(nook),
			verbOf<kHasLevels>(nook, "gbuffer", "levels", [](auto& app) { return addGBufferVerb(app); }),
			verbOf<kHasLevels>(nook, "reference", "levels", [](auto& app) { return addReferenceVerb(app); }),
			verbOf<kHasShading>(nook, "shade", "shading", [](auto& app) { return addShadeVerb(app); }),
			addEmitVerb(nook),
			verbOf<kHasLevels>(nook, "compare", "levels", [](auto& app) { return addCompareVerb(app); }),
			addReportVerb(nook),
			verbOf<kHasLevels>(nook, "level", "levels", [](auto& app) { return addLevelVerb(app); }),
			verbOf<kHasLevels>(nook, "volumes", "levels", [](auto& app) { return addVolumesVerb(app); }),
			verbOf<kHasLevels>(nook, "bake", "levels", [](auto& app) { return addBakeVerb(app); }),
			addInfoVerb(nook),
			verbOf<kHasReports>(nook, "fit", "reports", [](auto& app) { return addFitVerb(app); }),
			verbOf<kHasReports>(nook, "tune", "reports", [](auto& app) { return addTuneVerb(app); }),
			verbOf<kHasLevels>(nook, "plan", "levels", [](auto& app) { return addPlanVerb(app); })};
}

std::vector<Verb> addMeasuredReports(CLI::App& report)
{
	return {verbOf<kHasReports>(report, "error", "reports", [](auto& app) { return addReportError(app); }),
			verbOf<kHasReports>(report, "times", "reports", [](auto& app) { return addReportTimes(app); })};
}

std::vector<std::string> commandWords(const CLI::App& verb)
{
	std::vector<std::string> words{verb.get_name()}; // the library parses verbs by themselves, which then have no parent
	for (const CLI::App* app = verb.get_parent(); app != nullptr && app->get_parent() != nullptr; app = app->get_parent())
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

} // namespace nook
int nook::runProgram(int argc, char** argv)
{
	std::set_terminate(&endAtOnce);
	nook::handleSignals();
	nook::VerbProgress progress;
	try
	{
		run(nook::takeCommandLine(argc, argv), progress);
		progress.end(ExitCode::ok, "");
		return 0;
	}
	catch (const nook::Error& error)
	{
		return failed(progress, error.code(), error.what());
	}
	catch (const std::bad_alloc&)
	{
		return failed(progress, ExitCode::runtime, kNoMemory);
	}
	catch (const std::exception& error)
	{
		return failed(progress, ExitCode::runtime, error.what());
	}
}
