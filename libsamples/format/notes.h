// SPDX-License-Identifier: GPL-3.0-or-later
// What every emitted file begins with: the command that makes it, the version, the licence and the measures.
#pragma once

#include "core/notes.h"
#include "measure/quality.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"

#include <string>
#include <vector>

namespace nook
{

struct EmitContext
{
	std::string command;      // makes the file again; without output files and absolute paths
	std::string version;      // of nook: "0.1.0"
	std::string name;         // stem of the identifiers in source files; empty: from the recipe, "nook_disk9_symmetric"
	std::string base_command; // of a tile: the command that makes its base pattern, or empty where unknown
};

// One measure by its name in JSON. Absent values are left out; infinite ones are JSON's null.
struct Measure
{
	std::string name;
	double value = 0.0;
};
std::vector<Measure> measuresOf(const Quality& quality);
std::vector<Measure> measuresOf(const TileQuality& quality);

// Sets a measure by name; false for an unknown one.
bool setMeasure(Quality& quality, std::string_view name, double value);
bool setMeasure(TileQuality& quality, std::string_view name, double value);

Notes notesOf(const EmitContext& context, const std::vector<Measure>& measures);

// "disk9_symmetric": domain, count and what differs from the default recipe.
std::string shortName(Domain domain, std::size_t count, const Recipe* recipe);

} // namespace nook
