// SPDX-License-Identifier: GPL-3.0-or-later
// Command line → one verb, and its exit code. The only place that prints errors and exits.
#include "commit.h"
#include "components.h"
#include "run_verb.h"
#include "verbs.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "core/temporary_file.h"
#include "core/text.h"
#include "version.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace
{

using nook::ExitCode;

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

int failed(nook::VerbProgress& progress, ExitCode code, const std::string& message)
{
	const std::string line = shortened(nook::oneLine(message));
	progress.end(code, line);
	std::fprintf(stderr, "nook: %s\n", line.c_str());
	return static_cast<int>(code);
}

// The verbs that one of `app` may be: "pattern, tile or info".
std::string verbsOf(const CLI::App& app)
{
	const std::vector<const CLI::App*> verbs = app.get_subcommands([](const CLI::App*) { return true; });
	std::string names;
	for (std::size_t i = 0; i < verbs.size(); ++i)
	{
		names += std::string(i == 0 ? "" : i + 1 < verbs.size() ? ", " : " or ") + verbs[i]->get_name();
	}
	return names;
}

// CLI11's wording, with what to do about it.
std::string misuseText(const CLI::App& nook, const CLI::ParseError& error)
{
	std::string command = "nook";
	const CLI::App* app = &nook;
	while (!app->get_subcommands().empty())
	{
		app = app->get_subcommands().front();
		command += " " + app->get_name();
	}
	if (!verbsOf(*app).empty())
	{
		// Nothing but a verb can follow here; CLI11 would only say that one is missing.
		const std::vector<std::string> found = app->remaining();
		return (found.empty() ? "no verb" : "verb: found '" + found.front() + "'") + ", expected " + verbsOf(*app);
	}
	return std::string(error.what()) + ", expected what '" + command + " --help' lists";
}

std::string versionText()
{
	std::string text = "nook " NOOK_VERSION "\ncomponents: patterns";
	for (const auto& [there, name] : {std::pair(nook::kHasLevels, " levels"), std::pair(nook::kHasShading, " shading"),
									  std::pair(nook::kHasReports, " reports")})
	{
		text += there ? name : "";
	}
	return text + "\ncommit: " + nook::kCommit + "\n";
}

void run(const std::vector<std::string>& command, nook::VerbProgress& progress)
{
	CLI::App nook(NOOK_DESCRIPTION);
	nook.name("nook");
	nook.set_version_flag("--version", versionText(), "Print the version, the components and the commit, and exit");
	nook.set_help_flag("-h,--help", "Print this help and exit");
	nook.allow_windows_style_options(false); // /patterns is a folder everywhere
	nook.require_subcommand(1);
	nook.footer("Exit codes: 0 ok, 1 usage, 2 file cannot be read or written, 3 invalid input, 4 failed at run time,\n"
				"5 not supported, 7 difference found.");
	const std::vector<nook::Verb> verbs = nook::addVerbs(nook);
	try
	{
		std::vector<std::string> words(command.rbegin(), command.rend()); // as CLI11 takes them
		words.resize(std::max<std::size_t>(words.size(), 1) - 1);         // without the program's name
		nook.parse(std::move(words));
	}
	catch (const CLI::CallForHelp&)
	{
		nook::writeFile("-", nook.help());
		return;
	}
	catch (const CLI::CallForVersion&)
	{
		nook::writeFile("-", versionText());
		return;
	}
	catch (const CLI::ParseError& error)
	{
		throw nook::Error(ExitCode::usage, misuseText(nook, error));
	}
	for (const nook::Verb& verb : verbs)
	{
		if (verb.app->parsed())
		{
			nook::runVerb(verb, progress);
		}
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
		nook::waitForEnd(); // another thread has something to say, too
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
	std::fprintf(stderr, "%snook: %s\n", nook::isTerminal() ? "\r\033[K" : "", message);
	nook::removeTemporaryFiles();
	std::_Exit(static_cast<int>(ExitCode::runtime));
}

} // namespace

int main(int argc, char** argv)
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
