// SPDX-License-Identifier: GPL-3.0-or-later
// nook tune: levels and a budget, or a bound of error → which method to take, and its files.
#include "options.h"
#include "scene_options.h"

#include "core/error.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/text.h"
#include "emit/module.h"
#include "methods/method_table.h"
#include "study/tune.h"
#include "version.h"

#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>

namespace nook
{
namespace
{

constexpr const char* kPage = "tune.html";

struct TuneOptions
{
	const CLI::App* app = nullptr;
	std::vector<std::string> levels;
	LoadSettings load;
	std::string budget;
	std::string methods;
	TuneSettings settings;
	TuneEmitSettings emit;
	std::string folder;
	Outputs outputs;
};

// Names that --methods takes.
std::string searchedNames()
{
	return methodNames([](const MethodRow& row) { return row.emitted; }) + namesBesideMethods();
}

void declare(CLI::App& app, TuneOptions& options)
{
	TuneSettings& settings = options.settings;
	options.app = &app;
	app.add_option("LEVEL", options.levels, "Levels to choose for: files that nook reads, or builtin:NAME")->required();
	const OptionRules with_files = needs("-o", "a folder for the files that it shapes", "without -o");
	addOptions(app,
			   {{"--budget", takesText(options.budget, "TIME"), "Least error within this time per picture: 1.0ms, 800us"},
				{"--max-error", takesNumber(settings.goal.max_error, 1e-9, 1e9, "E"),
				 "Least time with no more than this error (--measure)"},
				{"--measure", takesChoice(namesOf<ErrorMeasure>(), settings.measure),
				 "What an error is, against rays: root mean square (rmse, default), equation 14 of AOV (eq14), or FLIP (flip)"},
				{"--over", takesChoice(namesOf<OverLevels>(), settings.goal.over),
				 "Several levels: the mean of their times and errors (mean, default), or the greatest (worst)"},
				{"--grid", takesChoice(namesOf<GridSize>(), settings.grid),
				 "Candidates: some (quick), all counts, filters and resolutions that make sense (normal, default), or all products "
				 "(full)"},
				{"--methods", takesText(options.methods, "LIST"),
				 "Only these, with commas between: " + searchedNames() + " (default: all; bake, " +
					 methodNames([](const MethodRow& row) { return row.kind == MethodKind::volumes; }, " and ") +
					 " are of static levels)"},
				{"--max-bytes", takesBytes(settings.max_bytes),
				 "Leaves out what needs a larger file of volumes or bake of any level: 1MiB (default: none)"},
				{"--radius", takesNumber(settings.radius_m, 1e-6, 1e9, "M"),
				 "Reach of occlusion in metres, with linear falloff (default: by each level's size, 1.5 m at most)"}});
	addOptions(app,
			   {sizeRow(settings.width_px, settings.height_px),
				{"--views", takesWhole(settings.views, 1, 64), "Views of each level, the most informative ones (default 4)"},
				{"--rays", takesWhole(settings.reference_rays, 1, 1 << 20), "Rays a pixel of the reference (default 256)"},
				{"--repetitions", takesWhole(settings.repetitions, 1, 1000), "Drawings of what gets to the end (default 7)"},
				glDeviceRow(settings.gl_device),
				{"--glsl", takesChoice(glslTargets(), options.emit.target),
				 "Language of the shader: OpenGL 3.3 (default), OpenGL 4.3, OpenGL ES 3.0 (without masks), or Vulkan", with_files},
				{"--depth", takesChoice(kModuleDepths, options.emit.device_depth),
				 "What the shader reads: depth along the view direction (default), or what a depth buffer holds", with_files}});
	addCache(app);
	addLoadOptions(app, options.load);
	addOptions(app, {{"-o,--output", takesText(options.folder, "FOLDER"),
					  "Where the files of the pick go, and a page about it; made where it is not"}});
	addJson(app, options.outputs.json);
	addRun(app, options.outputs);
}

// "1.0ms" in seconds.
double secondsOf(const std::string& text)
{
	double value = 0.0;
	const std::from_chars_result read = std::from_chars(text.data(), text.data() + text.size(), value);
	const std::string unit(read.ptr, text.data() + text.size());
	const double seconds = unit == "s" ? 1.0 : unit == "ms" ? 1e-3 : unit == "us" ? 1e-6 : 0.0;
	refuseValueIf(read.ec != std::errc{} || !std::isfinite(value) || !(value * seconds > 0.0), "--budget", text,
				  "a time above 0 with its unit, such as 1.0ms, 800us or 0.01s");
	return value * seconds;
}

// No file is a level, a file that one was read from, or another file.
void checkFiles(const TuneOptions& options, const std::vector<std::string>& files, const TuneReport* report = nullptr)
{
	static constexpr std::array<std::string_view, 5> kEndings{".glsl", ".h", ".json", ".glb", ".html"};
	Outputs outputs = options.outputs;
	outputs.files = files;
	checkAnyOutputs(outputs, kEndings, options.levels);
	for (std::size_t i = 0; report != nullptr && i < report->levels.size(); ++i)
	{
		checkRead(outputs, report->levels[i].files);
	}
}

// Checks before the search that its files can be written.
void checkPlaces(TuneOptions& options)
{
	namespace fs = std::filesystem;
	if (options.folder.empty())
	{
		checkFiles(options, {});
		return;
	}
	fs::path folder = fs::path(options.folder).lexically_normal();
	folder = folder.has_filename() ? folder : folder.parent_path(); // "out/"
	options.folder = folder.string();
	if (fs::is_directory(folder))
	{
		checkFiles(options, {(folder / kPage).string()});
		return;
	}
	refuseIf(fs::exists(folder), options.folder + ": found a file, expected a folder or nothing", ExitCode::file);
	checkWritable(options.folder);
	checkFiles(options, {});
}

// The methods that are asked for, or else all that the shader's language can draw (empty: everything).
std::vector<std::string> searchedMethods(const TuneOptions& options)
{
	std::vector<std::string> methods = partsOf(options.methods);
	const GlslTarget target = options.emit.target;
	for (const std::string& method : methods)
	{
		const MethodRow* const row = methodNamed(method);
		refuseIf(row != nullptr && !drawsVolumes(target, row->masks),
				 "--glsl: found " + std::string(nameOf(target)) + " with " + method + ", expected 330, 430 or vulkan");
		refuseValueIf(row != nullptr ? !row->emitted : assetNamed(method) == nullptr, "--methods", method,
					  "some of " + searchedNames());
	}
	if (!options.methods.empty() || drawsVolumes(target, true))
	{
		return methods;
	}
	return partsOf(methodNames([target](const MethodRow& row) { return row.emitted && drawsVolumes(target, row.masks); }, ",") +
				   joinedText(kindsBesideMethods(), "", [](const AssetKind* kind) { return "," + std::string(kind->name); }));
}

void check(TuneOptions& options)
{
	TuneSettings& settings = options.settings;
	const bool bounded = settings.goal.max_error.has_value();
	refuseIf(bounded == !options.budget.empty(),
			 std::string("--budget, --max-error: found ") + (bounded ? "both" : "neither") + ", expected one of them");
	if (!bounded)
	{
		settings.goal.budget_s = secondsOf(options.budget);
	}
	settings.methods = searchedMethods(options);
	settings.version = NOOK_VERSION;
	options.emit.version = NOOK_VERSION;
	options.emit.load = options.load;
	checkPlaces(options);
}

// Returns the command as it was given, without outputs.
std::string tuneCommand(const TuneOptions& options)
{
	std::string command = "nook tune " + joinedText(options.levels, " ", shellWord);
	for (const CLI::Option* const option : options.app->get_options())
	{
		const std::string name = option->get_name();
		if (option->count() == 0 || !name.starts_with("--") || name == "--json" || name == "--output" || name == "--threads" ||
			name == "--progress" || name == "--cache")
		{
			continue;
		}
		command += " " + name + (option->get_expected_max() > 0 ? " " + shellWord(option->results().front()) : "");
	}
	return command;
}

void write(const TuneOptions& options, const TuneReport& report, const TuneText& text)
{
	NewFolders folders;
	OutputSet files;
	std::vector<std::string> paths;
	if (!options.folder.empty())
	{
		std::error_code failed;
		folders.make(options.folder, failed);
		refuseIf(bool(failed), options.folder + ": " + failed.message(), ExitCode::file);
		const std::filesystem::path folder(options.folder);
		paths.push_back((folder / kPage).string());
		files.add(paths.front(), tuneHtml(report, text));
		for (std::size_t i = 0; text.emission != nullptr && i < text.emission->files.size(); ++i)
		{
			paths.push_back((folder / text.emission->files[i].name).string());
			files.add(paths.back(), text.emission->files[i].bytes);
		}
	}
	checkFiles(options, paths, &report);
	addSide(files, options.outputs, options.outputs.json.empty() ? "" : tuneJson(report, text), {}, tuneLines(report, text));
	files.commit();
}

// Writes the results in any case, then throws where something is wrong with them.
void run(TuneOptions& options, VerbProgress& progress)
{
	check(options);
	const RunSettings how = progress.start("tune", options.outputs.threads, options.outputs.progress);
	const TuneReport report = tuneLevels(options.levels, options.load, options.settings, how);
	TuneText text{tuneCommand(options), NOOK_VERSION, nullptr};
	std::optional<TuneEmission> emission;
	if (report.search.taken() && !options.folder.empty())
	{
		emission = emitPick(report, options.emit, how);
		text.emission = &*emission;
	}
	write(options, report, text);
	if (!report.search.pick)
	{
		const std::string nearest = report.search.nearest ? "the nearest is " + triedText(report, *report.search.nearest)
														  : "no candidate could be drawn here";
		throw Error(ExitCode::runtime, goalText(options.settings) +
										   ": found nothing that reaches it, expected a goal that can be reached: " + nearest);
	}
	for (const TuneLevel& level : report.levels)
	{
		refuseIf(!level.failed.empty(),
				 level.given + ": found a level that cannot be measured, expected one that can: " + level.failed,
				 ExitCode::runtime);
	}
}

} // namespace

Verb addTuneVerb(CLI::App& nook)
{
	return addVerb<TuneOptions>(
		nook, "tune", "Searches methods and settings on levels for the least error in a budget, and writes the files of the best",
		declare, run);
}

} // namespace nook
