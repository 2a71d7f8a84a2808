// SPDX-License-Identifier: GPL-3.0-or-later
// nook level: any level that nook reads, as one file that other programs read.
#include "level_options.h"
#include "options.h"
#include "scene_summary.h"
#include "summary.h"

#include "core/error.h"
#include "scene/camera_choice.h"
#include "scene/level_glb.h"
#include "scene/load.h"
#include "scene/tracer.h"
#include "version.h"

#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kLevelFormats{".glb"};

struct ConvertOptions
{
	LevelOptions level;
	int cameras = 0; // to be added
	Outputs outputs;
	int threads = 0;
};

void addCameras(Level& level, int count, const RunSettings& settings)
{
	const std::vector<LevelCamera> chosen = chooseCameras(Tracer(level, settings), count, settings);
	if (chosen.size() < static_cast<std::size_t>(count))
	{
		throw Error(ExitCode::invalid_input, level.name + ": --cameras: found " + std::to_string(chosen.size()) +
												 " views that show something, expected " + std::to_string(count));
	}
	level.cameras.insert(level.cameras.end(), chosen.begin(), chosen.end());
}

void run(const ConvertOptions& options, VerbProgress& progress)
{
	checkOutputs(options.outputs, kLevelFormats, {options.level.level});
	const RunSettings settings = progress.start("level", options.threads, options.outputs.progress);
	LoadedLevel loaded = loadLevel(options.level.level, options.level.load, settings);
	checkRead(options.outputs, loaded.level.files);
	if (options.cameras > 0)
	{
		addCameras(loaded.level, options.cameras, settings);
	}
	OutputSet files;
	if (!options.outputs.files.empty())
	{
		const ProgressCounter stage(settings.progress, "file");
		const std::string bytes = levelGlb(loaded.level, "nook " NOOK_VERSION);
		for (const std::string& path : options.outputs.files)
		{
			files.add(path, bytes);
		}
	}
	Summary summary("level");
	addLevelFacts(summary, loaded);
	addSide(files, options.outputs, summary.json(), loaded.level.files);
	files.commit();
}

} // namespace

Verb addLevelVerb(CLI::App& nook)
{
	const auto options = std::make_shared<ConvertOptions>();
	CLI::App* const app =
		nook.add_subcommand("level", "Writes a level as one binary glTF file: triangles, masks and cameras, cleaned and in metres");
	addLevelOptions(*app, options->level);
	addWhole(*app, "--cameras", options->cameras, 1, 64, "Adds the K most informative views, as --camera auto:K of other verbs")
		->type_name("K");
	addOutputs(*app, options->outputs, kLevelFormats);
	addThreads(*app, options->threads);
	addProgress(*app, options->outputs.progress);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
