// SPDX-License-Identifier: GPL-3.0-or-later
// A pattern or a tile → a file; the ending of its path chooses the format.
#pragma once

#include "format/notes.h"

#include <span>
#include <string>
#include <string_view>

namespace nook
{

// The endings that are known, in lower case with the point: ".json", ".h", …
std::span<const std::string_view> patternFormats(); // .json .h .glsl .hlsl .csv .svg .png
std::span<const std::string_view> tileFormats();    // .json .h .glsl .hlsl .csv .svg .png .exr .ktx2

// Which of the formats a path asks for; "-" (standard output) and devices without an ending get ".json".
// Throws Error (usage) for another ending, so that every path can be checked before any work.
std::string_view formatOf(const std::string& path, std::span<const std::string_view> formats);

// The file's bytes: the same for the same arguments. pattern.weights are needed; recipe may be null (a pattern of unknown make).
// Throws Error (usage) where context.name is not an identifier of C.
std::string patternBytes(std::string_view format, const Pattern& pattern, const Recipe* recipe, const Quality& quality,
						 const EmitContext& context);

// Textures (.png, .exr, .ktx2): tile_texture.h says what is where. .svg: a sheet of the variants. recipe may be null.
std::string tileBytes(std::string_view format, const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality,
					  const EmitContext& context);

// Writes the file, complete or not at all. Throws Error (usage, file).
void emitPattern(const std::string& path, const Pattern& pattern, const Recipe* recipe, const Quality& quality,
				 const EmitContext& context);
void emitTile(const std::string& path, const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality,
			  const EmitContext& context);

} // namespace nook
