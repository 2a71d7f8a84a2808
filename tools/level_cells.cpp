// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_cells.h"

#include "place_options.h"

#include "core/error.h"
#include "core/number.h"
#include "scene/cell.h"
#include "volume/closed.h"

#include <glm/vector_relational.hpp>

#include <charconv>
#include <filesystem>

namespace nook
{
namespace
{

constexpr unsigned kMostCells = 4096;

// "4x3" or "4x2x3": along x and z, or x, y and z.
glm::uvec3 gridOfText(const std::string& text)
{
	std::vector<unsigned> counts;
	const char* at = text.data();
	const char* const end = at + text.size();
	bool good = true;
	while (good && counts.size() < 3)
	{
		const std::from_chars_result result = std::from_chars(at, end, counts.emplace_back());
		good = result.ec == std::errc{} && counts.back() >= 1 && counts.back() <= kMostCells;
		at = result.ptr;
		if (at == end)
		{
			break;
		}
		good = good && *at++ == 'x';
	}
	const glm::uvec3 grid = counts.size() == 2   ? glm::uvec3(counts[0], 1, counts[1])
							: counts.size() == 3 ? glm::uvec3(counts[0], counts[1], counts[2])
												 : glm::uvec3(0);
	if (!good || at != end || grid.x == 0 || uint64_t{grid.x} * grid.y * grid.z > kMostCells)
	{
		refuseValue("--cells", text, "XxZ or XxYxZ, at most 4096 cells: 4x3 or 4x2x3");
	}
	return grid;
}

std::string cornerText(glm::dvec3 p)
{
	return numberText(p.x) + "," + numberText(p.y) + "," + numberText(p.z);
}

std::size_t aroundOf(const Level& level)
{
	std::size_t count = 0;
	for (const Mesh& mesh : level.meshes)
	{
		count += mesh.around ? mesh.triangle_count : 0;
	}
	return count;
}

} // namespace

void addCellOptions(CLI::App& app, CellOptions& options)
{
	app.add_option_function<std::string>(
		   "--cell", [&options](const std::string& text) { options.box = boxOf("--cell", text); },
		   "The part of the level in a box, metres: triangles by their centre, and their surroundings, marked as such")
		->type_name("X,Y,Z,X,Y,Z");
	app.add_option_function<std::string>(
		   "--cells", [&options](const std::string& text) { options.grid = gridOfText(text); },
		   "All of the level as such cells of one size, so many along x and z, or x, y and z: a file each, NAME-0-0.glb and so on")
		->type_name("XxZ");
	addNumber(
		app, "--around", [&options](double around_m) { options.around_m = around_m; }, 0.0, 1e9,
		"Metres that a cell's surroundings reach: what rays or volumes reach in it at least");
}

void checkCellOptions(const CellOptions& options)
{
	if (options.box && options.grid)
	{
		throw Error(ExitCode::usage, "--cells: found with --cell, expected one of them");
	}
	if (options.given() != options.around_m.has_value())
	{
		throw Error(ExitCode::usage, options.around_m
										 ? "--around: found without --cell or --cells, expected one of them"
										 : "--around: found none, expected metres: what rays or volumes reach at least");
	}
	if (options.box && glm::any(glm::greaterThanEqual(options.box->least, options.box->most)))
	{
		throw Error(ExitCode::usage, "--cell: found a box without inside, expected one");
	}
}

std::vector<std::string> cellFiles(const CellOptions& options, const std::string& file)
{
	if (!options.grid)
	{
		return {file};
	}
	const std::filesystem::path path(file);
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
				numbered.replace_filename(path.stem().string() + place + path.extension().string());
				files.push_back(numbered.string());
			}
		}
	}
	return files;
}

void cutCells(const Level& level, const CellOptions& options, Summary& summary, const RunSettings& run,
			  const std::function<void(std::size_t number, Level& cell)>& take)
{
	const std::vector<Bounds> boxes = options.grid ? gridOf(level, *options.grid) : std::vector<Bounds>{*options.box};
	ProgressCounter stage(run.progress, "cells", boxes.size());
	const std::vector<uint8_t> closed = closedTriangles(level, silent(run));
	std::vector<Summary> items;
	for (std::size_t i = 0; i < boxes.size(); ++i)
	{
		Level cell = cutCell(level, {boxes[i], *options.around_m}, closed, run.threads);
		stage.finishOne();
		if (cell.triangles.empty())
		{
			continue;
		}
		const std::size_t around = aroundOf(cell);
		Summary& item = items.emplace_back();
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
	summary.number("around_m", *options.around_m);
	summary.items("cells", items);
}

} // namespace nook
