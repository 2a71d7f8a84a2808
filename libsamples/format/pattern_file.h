// SPDX-License-Identifier: GPL-3.0-or-later
// Writes a pattern or a tile; the path's extension chooses the format.
#pragma once

#include "format/notes.h"

#include <span>
#include <string>
#include <string_view>

namespace nook
{

// The supported extensions, in lower case with the dot.
std::span<const std::string_view> patternFormats(); // .json .h .glsl .hlsl .csv .svg .png
std::span<const std::string_view> tileFormats();    // .json .h .glsl .hlsl .csv .svg .png .exr .ktx2

// The format for a path; "-" (standard output) and devices without an extension get ".json".
// Throws Error (usage) for any other extension, so that all paths can be checked before any work.
std::string_view formatOf(const std::string& path, std::span<const std::string_view> formats);

// Deterministic. Requires pattern.weights; recipe may be null. Throws Error (usage) if context.name is not a C identifier.
std::string patternBytes(std::string_view format, const Pattern& pattern, const Recipe* recipe, const Quality& quality,
						 const EmitContext& context);

// Textures (.png, .exr, .ktx2): layout in arrays.h. .svg: a sheet of the variants. recipe may be null.
std::string tileBytes(std::string_view format, const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality,
					  const EmitContext& context);

} // namespace nook
