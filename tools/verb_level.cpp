// SPDX-License-Identifier: GPL-3.0-or-later
// nook level: any level that nook reads, or several as one, as a file that other programs read.
#include "scene_options.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/system.h"
#include "scene/camera_choice.h"
#include "scene/level.h"
#include "scene/level_glb.h"
#include "scene/load.h"
#include "scene/tracer.h"
#include "version.h"
#include "volume/occluders.h"

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <filesystem>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kLevelFormats{".glb"};

struct CellOptions
{
	std::optional<Bounds> box;      // of --cell
	std::optional<glm::uvec3> grid; // of --cells
	std::optional<double> around_m; // of --around
	bool given() const
	{
		return box || grid;
	}
};

struct ConvertOptions
{
	std::vector<std::string> levels;
	std::vector<glm::dvec3> moves; // one a level, or none
	LoadSettings load;
	CellOptions cells;
	int cameras = 0; // to be added
	Outputs outputs;
};

void addCameras(Level& level, int count, const RunSettings& settings)
{
	const std::vector<LevelCamera> chosen = chooseCameras(Tracer(level, settings), count, settings);
	refuseIf(chosen.size() < static_cast<std::size_t>(count),
			 level.name + ": --cameras: found " + std::to_string(chosen.size()) + " views that show something, expected " +
				 std::to_string(count),
			 ExitCode::invalid_input);
	append(level.cameras, chosen);
}

std::vector<PlacedLevel> placesOf(const ConvertOptions& options)
{
	refuseIf(!options.moves.empty() && options.moves.size() != options.levels.size(),
			 "--move: found " + std::to_string(options.moves.size()) + " for " + std::to_string(options.levels.size()) +
				 " levels, expected one for each level, in their order");
	const auto placeOf = [&options](std::size_t i)
	{
		return PlacedLevel{options.levels[i], options.moves.empty() ? glm::dvec3(0.0) : options.moves[i]};
	};
	return listOf(options.levels.size(), placeOf);
}

constexpr unsigned kMostCells = 4096;

// "4x3" or "4x2x3": along x and z, or x, y and z.
glm::uvec3 gridOfText(const std::string& name, const std::string& text)
{
	const auto counts = mapped(partsOf(text, 'x'), [](const std::string& part)
							   { return std::min(numberFrom<unsigned>(part).value_or(0), kMostCells + 1); });
	const glm::uvec3 grid = counts.size() == 2   ? glm::uvec3(counts[0], 1, counts[1])
							: counts.size() == 3 ? glm::uvec3(counts[0], counts[1], counts[2])
												 : glm::uvec3(0);
	const uint64_t cells = uint64_t{grid.x} * grid.y * grid.z;
	refuseValueIf(cells < 1 || cells > kMostCells, name, text, "XxZ or XxYxZ, at most 4096 cells: 4x3 or 4x2x3");
	return grid;
}

std::string cornerText(glm::dvec3 p)
{
	return numberText(p.x) + "," + numberText(p.y) + "," + numberText(p.z);
}

// The files that `-o` stands for: itself, or NAME-X-Z.glb for each cell of a grid, NAME-X-Y-Z.glb where it is higher than one.
std::vector<std::string> cellFiles(const CellOptions& options, const std::string& file)
{
	if (!options.grid)
	{
		return {file};
	}
	const std::filesystem::path path = nativePath(file);
	std::vector<std::string> files;
	for (unsigned z = 0; z < options.grid->z; ++z)
	{
		for (unsigned y = 0; y < options.grid->y; ++y)
		{
			for (unsigned x = 0; x < options.grid->x; ++x)
			{
				const std::string place =
					"-" + std::to_string(x) + (options.grid->y > 1 ? "-" + std::to_string(y) : "") + "-" + std::to_string(z);
				std::filesystem::path numbered = path;
				numbered.replace_filename(nativePath(path.stem().string() + place + path.extension().string()));
				files.push_back(numbered.string());
			}
		}
	}
	return files;
}

// Calls `take` with each cell that has triangles of its own and its number among cellFiles(), in that order; facts into `facts`.
// Throws Error (invalid_input) where none has any.
void cutCells(const Level& level, const CellOptions& options, Facts& facts, const RunSettings& run,
			  const std::function<void(std::size_t number, Level& cell)>& take)
{
	const std::vector<Bounds> boxes = options.grid ? gridOf(level, *options.grid) : std::vector<Bounds>{*options.box};
	ProgressCounter stage(run.progress, "cells", boxes.size());
	const std::vector<uint8_t> closed = closedTriangles(level, silent(run));
	std::vector<Facts> items;
	for (std::size_t i = 0; i < boxes.size(); ++i)
	{
		Level cell = cutCell(level, {boxes[i], *options.around_m}, closed, run.threads);
		stage.finishOne();
		if (cell.triangles.empty())
		{
			continue;
		}
		const std::size_t around = sumOver(cell.meshes, [](const Mesh& mesh) { return mesh.around ? mesh.triangle_count : 0; });
		Facts& item = items.emplace_back();
		if (options.grid)
		{
			const glm::uvec3& grid = *options.grid;
			item.numbers("cell", {static_cast<double>(i % grid.x), static_cast<double>(i / grid.x % grid.y),
								  static_cast<double>(i / grid.x / grid.y)});
		}
		item.numbers("least_m", {boxes[i].least.x, boxes[i].least.y, boxes[i].least.z});
		item.numbers("most_m", {boxes[i].most.x, boxes[i].most.y, boxes[i].most.z});
		item.whole("triangles", cell.triangles.size() - around);
		item.whole("triangles_around", around);
		take(i, cell);
	}
	if (items.empty())
	{
		const Bounds bounds = boundsOf(level);
		throw Error(ExitCode::invalid_input, level.name + ": --cell: found no triangle whose centre is in " +
												 cornerText(boxes[0].least) + "," + cornerText(boxes[0].most) +
												 ", expected a box within " + cornerText(bounds.least) + "," +
												 cornerText(bounds.most));
	}
	facts.number("around_m", *options.around_m);
	facts.items("cells", items);
}

// Parts of the level, a file each that is not empty.
void runCells(const ConvertOptions& options, VerbProgress& progress)
{
	const Outputs outputs =
		expanded(options.outputs, [&options](const std::string& file) { return cellFiles(options.cells, file); });
	checkOutputs(outputs, kLevelFormats, options.levels);
	const RunSettings settings = progress.start("level", options.outputs.threads, options.outputs.progress);
	const LoadedLevel loaded = loadLevels(placesOf(options), options.load, settings);
	checkRead(outputs, loaded.level.files);
	Facts facts = verbFacts("level");
	addLevelFacts(facts, loaded);
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
	cutCells(loaded.level, options.cells, facts, settings, take);
	addSide(files, written, facts.json(), loaded.level.files);
	files.commit();
}

void run(ConvertOptions& options, VerbProgress& progress)
{
	refuseIf(options.cells.box && glm::any(glm::greaterThanEqual(options.cells.box->least, options.cells.box->most)),
			 "--cell: found a box without inside, expected one");
	refuseIf(options.cells.given() && !options.cells.around_m,
			 "--around: found none, expected metres: what rays or volumes reach at least");
	if (options.cells.given())
	{
		runCells(options, progress);
		return;
	}
	const std::vector<PlacedLevel> places = placesOf(options);
	checkOutputs(options.outputs, kLevelFormats, options.levels);
	const RunSettings settings = progress.start("level", options.outputs.threads, options.outputs.progress);
	LoadedLevel loaded = loadLevels(places, options.load, settings);
	checkRead(options.outputs, loaded.level.files);
	if (options.cameras > 0)
	{
		addCameras(loaded.level, options.cameras, settings);
	}
	std::string bytes;
	if (!options.outputs.files.empty())
	{
		const ProgressCounter stage(settings.progress, "file");
		bytes = levelGlb(loaded.level, "nook " NOOK_VERSION);
	}
	Facts facts = verbFacts("level");
	addLevelFacts(facts, loaded);
	writeOutputs(
		options.outputs, [&bytes](const std::string&) { return bytes; }, facts.json(), loaded.level.files);
}

void declare(CLI::App& app, ConvertOptions& options)
{
	CellOptions& cells = options.cells;
	const auto take_level = [&options](const std::string& name, const std::string& text)
	{
		refuseValueIf(text.empty(), name, text, "a level's name");
		options.levels.push_back(text);
	};
	addOptions(app, {{"LEVEL", takesEach("LEVEL", take_level),
					  "Levels (.gltf .glb .obj .fbx .ply .stl) or builtin:NAME, which become one", kRequired}});
	addLoadOptions(app, options.load);
	addOptions(
		app,
		{{"--move", takesEach("X,Y,Z", options.moves, positionOf),
		  "Moves a level by so many metres; as often as there are levels, in their order"},
		 {"--cell", takesParsed("X,Y,Z,X,Y,Z", cells.box, boxOf),
		  "The part of the level in a box, metres: triangles by their centre, and their surroundings, marked as such"},
		 {"--cells", takesParsed("XxZ", cells.grid, gridOfText),
		  "All of the level as such cells of one size, so many along x and z, or x, y and z: a file each, NAME-0-0.glb and so on",
		  excludes("--cell")},
		 {"--around", takesNumber(cells.around_m, 0.0, 1e9),
		  "Metres that a cell's surroundings reach: what rays or volumes reach in it at least",
		  needs("--cell or --cells", "one of them")},
		 {"--cameras", takesWhole(options.cameras, 1, 64, "K"),
		  "Adds the K most informative views, as --camera auto:K of other verbs"}});
	addOutputs(app, options.outputs, kLevelFormats);
	addRun(app, options.outputs);
}

} // namespace

Verb addLevelVerb(CLI::App& nook)
{
	return addVerb<ConvertOptions>(
		nook, "level", "Writes levels as one binary glTF file: triangles, masks and cameras, cleaned and in metres", declare, run);
}

} // namespace nook
