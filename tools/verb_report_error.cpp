// SPDX-License-Identifier: GPL-3.0-or-later
// nook report error: levels → time against error of every method, as one page.
#include "options.h"
#include "scene_options.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/text.h"
#include "core/work_units.h"
#include "methods/method_table.h"
#include "study/error_report.h"
#include "version.h"

#include <array>
#include <cstdio>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kPages{".html"};
constexpr std::array<std::string_view, 2> kMeasuringDevices{"gl", "cpu"};

struct ErrorOptions
{
	ErrorReportSettings settings;
	CameraOptions camera;
	std::string methods;
	std::vector<std::string> join;
	std::string baseline;
	bool quick = false;
	const CLI::App* app = nullptr;
	std::vector<const CLI::Option*> of_measuring; // with levels alone
	Outputs outputs;
};

std::string measuredNames()
{
	return methodNames([](const MethodRow&) { return true; }) + namesBesideMethods() + ", rays";
}

void declareMeasuring(CLI::App& app, ErrorOptions& options)
{
	ErrorReportSettings& settings = options.settings;
	MeasureSettings& measure = settings.measure;
	addLoadOptions(app, settings.load);
	const OptionRules not_quick = excludes("--quick");
	addOptions(
		app,
		{cameraRow(options.camera),
		 sizeRow(settings.width_px, settings.height_px),
		 {"--grid", takesChoice(namesOf<GridSize>(), settings.grid),
		  "How much is tried: quick (84 candidates), normal (default), or full (every product of counts, samples, filters, "
		  "resolutions, thickness and StatVO's tables)",
		  not_quick},
		 {"--methods", takesText(options.methods, "LIST"),
		  "Only these, with commas between: " + measuredNames() + " (default: all)"},
		 {"--rays", takesWhole(settings.rays, 1, 16384), "Rays a pixel of the reference (default 1024)", not_quick},
		 {"--repetitions", takesWhole(measure.repetitions, 1, 1000), "Drawings of each candidate, after a warm-up (default 5)",
		  not_quick},
		 {"--slowest", takesNumber(measure.slowest_s, 0.0, 1e6, "SECONDS"),
		  "Volumes that would take longer a picture are stopped, and shown as such; 0: none (default 60, with --quick 4)"},
		 {"--quick", takesFlag(options.quick), "A first look: --grid quick --size 240x135 --rays 256 --repetitions 3 --slowest 4"},
		 {"--radius", takesNumber(settings.radius_m, 1e-6, 1e6),
		  "Radius of the reference's rays in metres, of which the methods' radii are parts (default: by each level's size, at most "
		  "1.5)"},
		 {"--device",
		  takesIndex(kMeasuringDevices, [&measure](std::size_t i) { measure.device = i == 0 ? Device::gl : Device::cpu; }),
		  "gl (default): OpenGL without a display, whatever renderer that is; or cpu: our own code"},
		 glDeviceRow(measure.gl_device, excludes("--device cpu", "--device gl")),
		 {"--pictures", takesWhole(settings.pictures, 0, 64), "Pictures of each view, beside the reference (default 8)"},
		 {"--shifts", takesWhole(settings.shifts, 0, 64),
		  "Parts of a pixel by which views are moved to see what flickers (default 4, at least 2; 0: not measured)"},
		 {"--baseline", takesText(options.baseline, "FILE.json"),
		  "An earlier report: exit code 7 where an error has grown (times do not count)"}});
	addRun(app, options.outputs, true);
	options.app = &app;
	const auto measures = [](const CLI::Option* option)
	{
		return option->get_name() != "LEVEL" && option->get_name() != "--cache" && !option->get_name().starts_with("--help");
	};
	options.of_measuring = itemsWhere(options.app->get_options(), measures);
}

void checkJoin(const ErrorOptions& options)
{
	for (const CLI::Option* const option : options.of_measuring)
	{
		refuseIf(option->count() > 0, option->get_name() + ": found with --join, which measures nothing, expected one of them");
	}
	refuseIf(!options.settings.levels.empty() || !options.outputs.json.empty(),
			 std::string(options.settings.levels.empty() ? "--json" : "LEVEL") +
				 ": found with --join, which measures nothing, expected -o FILE.html alone");
}

void settle(ErrorOptions& options)
{
	ErrorReportSettings& settings = options.settings;
	if (!options.join.empty())
	{
		checkJoin(options);
		return;
	}
	refuseIf(settings.levels.empty(), "LEVEL: found none, expected a level, or --join FILE.json");
	settings.methods = partsOf(options.methods);
	for (const std::string& method : settings.methods)
	{
		refuseValueIf(method != "rays" && assetNamed(method) == nullptr && methodNamed(method) == nullptr, "--methods", method,
					  "some of " + measuredNames());
	}
	if (options.quick && !isGiven(*options.app, "--size"))
	{
		settings.width_px = 240;
		settings.height_px = 135;
	}
	if (options.quick)
	{
		settings.grid = GridSize::quick;
		settings.rays = 256;
		settings.measure.repetitions = 3;
	}
	if (!isGiven(*options.app, "--slowest"))
	{
		settings.measure.slowest_s = options.quick ? kSlowestQuickPicture_s : kSlowestPicture_s;
	}
	settings.camera = options.camera.automatic > 0 ? "" : options.camera.camera;
	settings.automatic = options.camera.automatic;
	settings.version = NOOK_VERSION;
	refuseValueIf(settings.shifts == 1, "--shifts", "1", "0 (not measured), or at least 2: one picture does not flicker");
}

void writePages(const ErrorOptions& options, std::span<const ErrorReport> reports, const std::string& json,
				const std::vector<std::string>& read)
{
	writeOutputs(
		options.outputs, [&](const std::string&) { return errorReportHtml(reports, NOOK_VERSION); }, json, read);
}

void join(const ErrorOptions& options)
{
	writePages(options, mapped(options.join, [](const std::string& path) { return errorReportFrom(readFile(path), path); }), "",
			   options.join);
}

// One line for the worst, or nothing.
std::string regressionText(const BaselineResult& result)
{
	if (result.regressions.empty())
	{
		return {};
	}
	const Regression& worst = result.regressions.front();
	return "baseline: found " + std::to_string(result.regressions.size()) + " errors that have grown, the worst " + worst.metric +
		   " of '" + worst.candidate + "' on " + worst.level + ", " + worst.camera + ": " + numberText(worst.now) + ", expected " +
		   numberText(worst.before);
}

void measure(const ErrorOptions& options, VerbProgress& progress)
{
	const RunSettings run = progress.start("report error", options.outputs.threads, options.outputs.progress);
	std::optional<ErrorReport> baseline;
	if (!options.baseline.empty())
	{
		addInputs({options.baseline}, run);
		baseline = errorReportFrom(readFile(options.baseline), options.baseline);
	}
	ErrorReportCounts counts;
	const ErrorReport report = measureErrors(options.settings, run, &counts);
	if (isShare(run))
	{
		return;
	}
	std::vector<std::string> read = counts.files;
	read.push_back(options.baseline);
	checkRead(options.outputs, read);
	writePages(options, {&report, 1}, options.outputs.json.empty() ? "" : errorReportJson(report), read);

	const std::vector<std::string> failures =
		itemsWhere(mapped(report.levels, [](const ErrorLevel& level) { return level.failure; }),
				   [](const std::string& failure) { return !failure.empty(); });
	std::string grown;
	if (baseline)
	{
		const BaselineResult result = compareWithBaseline(report, *baseline);
		for (const std::string& missing : result.missing)
		{
			std::fprintf(stderr, "nook: warning: baseline: %s: found nothing of it in this run\n", oneLine(missing).c_str());
		}
		grown = regressionText(result);
		refuseIf(failures.empty() && result.compared == 0,
				 "--baseline: found nothing in " + options.baseline +
					 " that was measured here, expected levels, cameras and candidates of this run",
				 ExitCode::invalid_input);
		refuseIf(failures.empty() && !grown.empty(), grown, ExitCode::difference);
	}
	refuseIf(!failures.empty(),
			 "report: found " + std::to_string(failures.size()) + " of " + std::to_string(report.levels.size()) +
				 " levels that failed, expected none: " + joinedText(failures, "; ") + (grown.empty() ? "" : "; " + grown),
			 ExitCode::runtime);
}

void declareReport(CLI::App& app, ErrorOptions& options)
{
	app.add_option("LEVEL", options.settings.levels, "Levels (.gltf .glb .obj .fbx .ply .stl), or builtin:NAME")
		->type_name("LEVEL");
	declareMeasuring(app, options);
	app.add_option("--join", options.join, "Reports of several renderers (JSON) side by side on one page; nothing is measured")
		->type_name("FILE.json");
	addOutputs(app, options.outputs, kPages);
}

void runReport(ErrorOptions& options, VerbProgress& progress)
{
	settle(options);
	std::vector<std::string> inputs = options.join;
	append(inputs, options.settings.levels);
	inputs.push_back(options.baseline);
	checkOutputs(options.outputs, kPages, inputs);
	if (options.join.empty())
	{
		measure(options, progress);
	}
	else
	{
		join(options);
	}
}

} // namespace

Verb addReportError(CLI::App& report)
{
	return addVerb<ErrorOptions>(report, "error", "Time against error of every method on levels", declareReport, runReport);
}

} // namespace nook
