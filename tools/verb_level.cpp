// SPDX-License-Identifier: GPL-3.0-or-later
// nook level: any level that nook reads, or several as one, as a file that other programs read.
#include "level_cells.h"
#include "level_options.h"
#include "options.h"
#include "place_options.h"
#include "scene_summary.h"
#include "summary.h"

#include "core/error.h"
#include "scene/camera_choice.h"
#include "scene/level_glb.h"
#include "scene/load.h"
#include "scene/tracer.h"
#include "version.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kLevelFormats{".glb"};

struct ConvertOptions
{
	std::vector<std::string> levels;
	std::vector<glm::dvec3> moves; // one a level, or none
	LoadSettings load;
	CellOptions cells;
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

std::vector<PlacedLevel> placesOf(const ConvertOptions& options)
{
	if (!options.moves.empty() && options.moves.size() != options.levels.size())
	{
		throw Error(ExitCode::usage, "--move: found " + std::to_string(options.moves.size()) + " for " +
										 std::to_string(options.levels.size()) +
										 " levels, expected one for each level, in their order");
	}
	std::vector<PlacedLevel> places;
	for (const std::string& name : options.levels)
	{
		places.push_back({name, options.moves.empty() ? glm::dvec3(0.0) : options.moves[places.size()]});
	}
	return places;
}

// Parts of the level, a file each that is not empty.
void runCells(const ConvertOptions& options, VerbProgress& progress)
{
	Outputs outputs = options.outputs;
	outputs.files.clear();
	for (const std::string& file : options.outputs.files)
	{
		const std::vector<std::string> files = cellFiles(options.cells, file);
		outputs.files.insert(outputs.files.end(), files.begin(), files.end());
	}
	checkOutputs(outputs, kLevelFormats, options.levels);
	const RunSettings settings = progress.start("level", options.threads, outputs.progress);
	const LoadedLevel loaded = loadLevels(placesOf(options), options.load, settings);
	checkRead(outputs, loaded.level.files);
	Summary summary("level");
	addLevelFacts(summary, loaded);
	OutputSet files;
	Outputs written = outputs;
	written.files.clear();
	const auto take = [&](std::size_t number, Level& cell)
	{
		if (options.cameras > 0)
		{
			addCameras(cell, options.cameras, settings);
		}
		const std::size_t count = outputs.files.size() / std::max<std::size_t>(options.outputs.files.size(), 1);
		const std::string bytes = outputs.files.empty() ? std::string() : levelGlb(cell, "nook " NOOK_VERSION);
		for (std::size_t file = number; file < outputs.files.size(); file += count)
		{
			files.add(outputs.files[file], bytes);
			written.files.push_back(outputs.files[file]);
		}
	};
	cutCells(loaded.level, options.cells, summary, settings, take);
	addSide(files, written, summary.json(), loaded.level.files);
	files.commit();
}

void run(const ConvertOptions& options, VerbProgress& progress)
{
	checkCellOptions(options.cells);
	if (options.cells.given())
	{
		runCells(options, progress);
		return;
	}
	const std::vector<PlacedLevel> places = placesOf(options);
	checkOutputs(options.outputs, kLevelFormats, options.levels);
	const RunSettings settings = progress.start("level", options.threads, options.outputs.progress);
	LoadedLevel loaded = loadLevels(places, options.load, settings);
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

void addLevels(CLI::App& app, ConvertOptions& options)
{
	app.add_option_function<std::vector<std::string>>(
		   "LEVEL",
		   [&options](const std::vector<std::string>& names)
		   {
			   for (const std::string& name : names)
			   {
				   if (name.empty())
				   {
					   refuseValue("LEVEL", name, "a level's name");
				   }
				   options.levels.push_back(name);
			   }
		   },
		   "Levels (.gltf .glb .obj .fbx .ply .stl) or builtin:NAME, which become one")
		->type_name("LEVEL")
		->required();
	addLoadOptions(app, options.load);
	app.add_option_function<std::vector<std::string>>(
		   "--move",
		   [&options](const std::vector<std::string>& texts)
		   {
			   for (const std::string& text : texts)
			   {
				   options.moves.push_back(positionOf("--move", text));
			   }
		   },
		   "Moves a level by so many metres; as often as there are levels, in their order")
		->type_name("X,Y,Z")
		->allow_extra_args(false);
}

} // namespace

Verb addLevelVerb(CLI::App& nook)
{
	const auto options = std::make_shared<ConvertOptions>();
	CLI::App* const app =
		nook.add_subcommand("level", "Writes levels as one binary glTF file: triangles, masks and cameras, cleaned and in metres");
	addLevels(*app, *options);
	addCellOptions(*app, options->cells);
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
