// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a pattern or a tile from a file of either kind.
#pragma once

#include "format/pattern_json.h"
#include "format/tile_json.h"

#include <variant>

namespace nook
{

// Reads a tile if the JSON's schema says so, else a pattern. Same errors as readPattern and readTile.
std::variant<PatternFile, TileFile> readInput(const std::string& path, std::optional<Domain> domain = std::nullopt);

// Computes missing weights as the integrals of the cells.
void completeWeights(PatternFile& file);

// Throws Error (invalid_input) unless prefixes of the file's samples are patterns themselves, as the bands of `nook shade` require.
void checkProgressive(const std::variant<PatternFile, TileFile>& input, const std::string& path);

} // namespace nook
