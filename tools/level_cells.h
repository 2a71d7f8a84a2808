// SPDX-License-Identifier: GPL-3.0-or-later
// nook level --cell and --cells: parts of a level with their surroundings, a file each.
#pragma once

#include "options.h"
#include "summary.h"

#include "scene/level.h"

#include <glm/vec3.hpp>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace nook
{

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

// --cell, --cells, --around.
void addCellOptions(CLI::App& app, CellOptions& options);

// Before any work: refuses those that contradict each other.
void checkCellOptions(const CellOptions& options);

// The files that `-o` stands for: itself, or NAME-X-Z.glb for each cell of a grid, NAME-X-Y-Z.glb where it is higher than one.
std::vector<std::string> cellFiles(const CellOptions& options, const std::string& file);

// Calls `take` with each cell that has triangles of its own and its number among cellFiles(), in that order; facts into `summary`.
// Throws Error (invalid_input) where none has any.
void cutCells(const Level& level, const CellOptions& options, Summary& summary, const RunSettings& run,
			  const std::function<void(std::size_t number, Level& cell)>& take);

} // namespace nook
