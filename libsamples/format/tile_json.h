// SPDX-License-Identifier: GPL-3.0-or-later
// A tile of variants ↔ JSON, "schema": "nook.tile/1".
//
// Fields, in this order: schema, command, base_command (of the base pattern, where known), version, SPDX-License-Identifier,
// quality, recipe (every option of `nook tile` by its name), domain, count, size, frames (of a cycle, where it is not 1), moves
// (pixels [x, y] that the tile moves by in each, where it does), transforms (one a variant, only for transformed tiles: [cos, sin,
// scale, handedness], ball: [x, y, z, scale]), variants (size² row by row, without moves for frame after frame, each with points
// and weights).
#pragma once

#include "format/notes.h"

#include <optional>
#include <string>

namespace nook
{

inline constexpr const char* kTileSchema = "nook.tile/1";

std::string tileJson(const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality, const EmitContext& context);

struct TileFile
{
	PatternTile tile;
	std::optional<TileRecipe> recipe;
	std::optional<TileQuality> quality; // as written in the file
	std::string command;
	std::string base_command;
	std::string version;
};

// `path` is for messages only. Throws Error (invalid_input) for anything wrong; unlike a pattern's, every field of a tile is needed
// but recipe, quality, the commands and version.
TileFile parseTileJson(const std::string& text, const std::string& path);
TileFile readTile(const std::string& path);

// One row a sample: variant, then the columns of a pattern. Comments first.
std::string tileCsv(const PatternTile& tile, const TileQuality& quality, const EmitContext& context);

} // namespace nook
