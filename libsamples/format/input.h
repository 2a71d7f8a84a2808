// SPDX-License-Identifier: GPL-3.0-or-later
// A file of whatever kind → the pattern or the tile that it holds.
#pragma once

#include "format/pattern_json.h"
#include "format/tile_json.h"

#include <variant>

namespace nook
{

// Reads a tile where the JSON's schema says so, else a pattern; as readPattern and readTile, with the same errors.
std::variant<PatternFile, TileFile> readInput(const std::string& path, std::optional<Domain> domain = std::nullopt);

// Where the file has no weights: gives the pattern the integrals of its cells.
void completeWeights(PatternFile& file);

// Throws Error (invalid_input) where the first samples of the file are no pattern themselves, as the bands of `nook shade` need.
void checkProgressive(const std::variant<PatternFile, TileFile>& input, const std::string& path);

} // namespace nook
