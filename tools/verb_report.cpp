// SPDX-License-Identifier: GPL-3.0-or-later
// nook report: measurements → one page that a team chooses from.
#include "options.h"

#include "study/noise_report.h"
#include "version.h"

#include <array>

namespace nook
{
namespace
{

struct NoiseOptions
{
	NoiseReportSettings settings;
	Outputs outputs;
};

void run(const NoiseOptions& options, VerbProgress& progress)
{
	static constexpr std::array<std::string_view, 1> kPages{".html"};
	checkOutputs(options.outputs, kPages);
	const RunSettings how = progress.start("report noise", options.outputs.threads, options.outputs.progress);
	const NoiseReport report = measureNoise(options.settings, how);
	if (isShare(how))
	{
		return;
	}
	const std::string command = noiseReportCommand(options.settings);
	const std::string html = options.outputs.files.empty() ? "" : noiseReportHtml(report, command, NOOK_VERSION);
	const std::string json = options.outputs.json.empty() ? "" : noiseReportJson(report, command, NOOK_VERSION);
	writeOutputs(options.outputs, [&](const std::string&) { return html; }, json, {});
}

} // namespace

Verb addReportVerb(CLI::App& nook)
{
	CLI::App* const report = nook.add_subcommand("report", "Measures, and shows the figures as one self-contained page");
	report->require_subcommand(1);
	CLI::App* const app = report->add_subcommand("noise", "Noise against count for every domain and method");
	const auto options = std::make_shared<NoiseOptions>();
	NoiseReportSettings& settings = options->settings;
	addOptions(
		*app,
		{{"--max-count", takesWhole(settings.max_count, 1, kMaxReportCount), "Counts from 1 to this (default 64)"},
		 {"--starts", takesWhole(settings.starts, 1, 1000), "Starting sets of every method that searches (default: by method)"},
		 {"--seeds", takesWhole(settings.random_seeds, 1, 100), "Seeds over which random and poisson are averaged (default 3)"},
		 seedRow(settings.seed)});
	addOutputs(*app, options->outputs, std::array<std::string_view, 1>{".html"});
	addRun(*app, options->outputs, true);
	const std::vector<Verb> measured = addMeasuredReports(*report);
	return {report, [options, measured](VerbProgress& progress)
			{
				for (const Verb& verb : measured)
				{
					if (verb.app->parsed())
					{
						return verb.run(progress);
					}
				}
				run(*options, progress);
			}};
}

} // namespace nook
