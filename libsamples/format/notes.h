// SPDX-License-Identifier: GPL-3.0-or-later
// Header of every emitted file: the command that makes it, the version, the licence and the measures.
#pragma once

#include "core/facts.h"
#include "core/text.h"
#include "pattern/quality.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"

#include <string>
#include <vector>

namespace nook
{

struct EmitContext
{
	std::string command;      // remakes the file; without output files and absolute paths
	std::string version;      // nook's version: "0.1.0"
	std::string name;         // stem of identifiers in source files; empty: derived from the recipe, "nook_disk9_symmetric"
	std::string base_command; // tiles: the command that makes the base pattern; empty if unknown
};

// Leaves out measures that are absent.
std::vector<Measure> measuresOf(const Quality& quality);
std::vector<Measure> measuresOf(const TileQuality& quality);

// Sets a measure by name; false if the name is unknown.
bool setMeasure(Quality& quality, std::string_view name, double value);
bool setMeasure(TileQuality& quality, std::string_view name, double value);

Notes notesOf(const EmitContext& context, const std::vector<Measure>& measures);

// "disk9_symmetric": domain, count and the options that differ from the default recipe.
std::string shortName(Domain domain, std::size_t count, const Recipe* recipe);

} // namespace nook
