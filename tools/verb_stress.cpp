// SPDX-License-Identifier: GPL-3.0-or-later
// nook stress: kernels and builders against twins of more digits, over inputs that break things.
#include "options.h"

#include "core/error.h"
#include "core/file.h"
#include "stress/stress.h"
#include "version.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kTableFormats{".md"};
constexpr uint64_t kMost = 1'000'000'000'000;

struct StressOptions
{
	StressSettings settings;
	std::optional<uint64_t> one;
	Outputs outputs;
	int threads = 0;
};

void show(const StressOptions& options)
{
	if (options.settings.kernels.size() != 1)
	{
		throw Error(ExitCode::usage,
					"--case: found " + std::to_string(options.settings.kernels.size()) + " times --kernel, expected it once");
	}
	if (!options.outputs.files.empty() || !options.outputs.json.empty() || !options.outputs.progress.empty() ||
		options.outputs.part)
	{
		throw Error(ExitCode::usage, "--case: found with -o, --json, --progress or --part, expected it alone: it prints");
	}
	const StressCase one = showStressCase(options.settings.kernels[0], options.settings.seed, *options.one);
	writeFile("-", one.text);
	if (!one.passed)
	{
		throw Error(ExitCode::difference, "stress: found a case beyond its threshold, expected none");
	}
}

void run(const StressOptions& options, VerbProgress& progress)
{
	if (options.one)
	{
		show(options);
		return;
	}
	const Outputs& outputs = options.outputs;
	if (!outputs.files.empty() || !outputs.json.empty() || outputs.part)
	{
		checkOutputs(outputs, kTableFormats);
	}
	else
	{
		checkNames(outputs, {});
	}
	const std::vector<StressResult> results =
		runStress(options.settings, progress.start("stress", options.threads, outputs.progress));
	OutputSet files;
	for (const std::string& path : outputs.files)
	{
		files.add(path, stressMarkdown(results, options.settings, NOOK_VERSION));
	}
	addSide(files, outputs, stressJson(results, options.settings, NOOK_VERSION), {});
	if (isStdoutFree(outputs))
	{
		files.add("-", stressText(results, options.settings));
	}
	files.commit();
	for (const StressResult& result : results)
	{
		if (!result.passed())
		{
			throw Error(ExitCode::difference,
						"stress: " + std::string(result.name) + ": found it beyond its threshold, expected none");
		}
	}
}

} // namespace

Verb addStressVerb(CLI::App& nook)
{
	CLI::App* const app =
		nook.add_subcommand("stress", "Holds kernels and builders against twins of more digits, over inputs that break things");
	const auto options = std::make_shared<StressOptions>();
	StressSettings& settings = options->settings;
	const auto kernels = [&settings](const std::vector<std::string>& names)
	{
		settings.kernels = names;
	};
	app->add_option_function<std::vector<std::string>>("--kernel", kernels,
													   "Only this one; may be repeated (default: all that the table names)")
		->type_name("NAME")
		->allow_extra_args(false);
	const auto cases = [&settings](uint64_t count)
	{
		settings.cases = count;
	};
	addLong(*app, "--cases", cases, 1, kMost, "Cases of all kernels together, shared out by what one costs (default 1000000)");
	addSeed(*app, settings.seed);
	const auto one = [options](uint64_t index)
	{
		options->one = index;
	};
	addLong(*app, "--case", one, 0, kMost, "Prints one case of one kernel: its input, the result, the twin's");
	addOutputs(*app, options->outputs, kTableFormats);
	addThreads(*app, options->threads);
	addProgress(*app, options->outputs.progress);
	addPart(*app, options->outputs.part);
	addUnitCache(*app);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
