// SPDX-License-Identifier: GPL-3.0-or-later
// A tile of variants ↔ JSON, "schema": "nook.tile/1".
//
// Fields, in this order: schema, command, base_command (of the base pattern, where known), version, SPDX-License-Identifier,
// quality, recipe (every option of `nook tile` by its name), domain, count, size, frames (length of the cycle, unless 1), moves
// (the offset in pixels [x, y] per frame, if the tile moves), transforms (one per variant, only for transformed tiles: [cos, sin,
// scale, handedness], ball: [x, y, z, scale]), variants (size² row by row, without moves repeated per frame, each with points and
// weights).
#pragma once

#include "core/json_reader.h"
#include "format/notes.h"
#include "format/pattern_json.h"
#include "pattern/tile_filter.h"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace nook
{

inline constexpr const char* kTileSchema = "nook.tile/1";

std::string tileJson(const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality, const EmitContext& context);

struct TileFile
{
	PatternTile tile;
	std::optional<TileRecipe> recipe;
	std::optional<TileQuality> quality; // from the file
	std::string command;
	std::string base_command;
	std::string version;
};

// `path` is for messages. Only recipe, quality, commands and version are optional. Throws Error (invalid_input).
TileFile parseTileJson(const std::string& text, const std::string& path);
TileFile readTile(const std::string& path);

// One row per sample: variant, then the columns of a pattern. Comments first.
std::string tileCsv(const PatternTile& tile, const TileQuality& quality, const EmitContext& context);

// Filter taps in JSON: {"taps": [[0, 1, 0], [1, 4, 1], [0, 1, 0]]}, rows from the top, 1 to 65 rows of equal length.

struct FilterFile
{
	TileFilter filter; // named "file:" plus the file name without its folder
	double sum = 1.0;  // sum of the taps in the file
};

// Throws Error (invalid input) naming `path`, also if the negative taps cancel the sum.
FilterFile parseFilter(const std::string& text, const std::string& path);

// NAME or NAME@SHARE each, where "file:KERNEL.json" is read; a warning for each whose taps do not sum to 1. Throws Error.
std::vector<TileFilter> filtersOf(const std::vector<std::string>& names, std::vector<std::string>& warnings);

// The files among such names.
std::vector<std::string> filterFiles(const std::vector<std::string>& names);

// Writes a tile as a KTX2 file with one texture of 32-bit floats, laid out as in arrays.h. Frames with tiles of their own
// become array layers, so that a texture is no wider than size² texels.

std::string tileKtx2(const PatternTile& tile, const TileQuality& quality, const EmitContext& context);

// Reads a tile if the JSON's schema says so, else a pattern. Same errors as readPattern and readTile.
std::variant<PatternFile, TileFile> readInput(const std::string& path, std::optional<Domain> domain = std::nullopt);

// Computes missing weights as the integrals of the cells.
void completeWeights(PatternFile& file);

// Throws Error (invalid_input) unless prefixes of the file's samples are patterns themselves, as the bands of `nook shade` require.
void checkProgressive(const std::variant<PatternFile, TileFile>& input, const std::string& path);

} // namespace nook
