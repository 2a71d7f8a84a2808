// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/pattern_file.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "format/arrays.h"
#include "format/pattern_json.h"
#include "format/source_text.h"
#include "format/tile_json.h"
#include "format/tile_texture.h"
#include "image/drawing.h"

#include <algorithm>
#include <array>
#include <filesystem>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 9> kFormats{".json", ".h", ".glsl", ".hlsl", ".csv", ".svg", ".png", ".exr", ".ktx2"};

[[noreturn]] void refuseFormat(const std::string& path, std::span<const std::string_view> formats)
{
	std::string names;
	for (const std::string_view name : formats)
	{
		names += (names.empty() ? "" : ", ") + std::string(name);
	}
	const std::string ending = nativePath(path).extension().string();
	throw Error(ExitCode::usage,
				path + ": found " + (ending.empty() ? "no ending" : "the ending " + ending) + ", expected one of " + names);
}

std::string sourceBytes(std::string_view format, const Source& source, std::span<const std::string_view> formats)
{
	if (format == ".h")
	{
		return headerText(source);
	}
	if (format == ".glsl")
	{
		return glslText(source);
	}
	if (format == ".hlsl")
	{
		return hlslText(source);
	}
	refuseFormat(std::string(format), formats);
}

} // namespace

std::span<const std::string_view> patternFormats()
{
	return std::span(kFormats).first(6);
}

std::span<const std::string_view> tileFormats()
{
	return kFormats;
}

std::string_view formatOf(const std::string& path, std::span<const std::string_view> formats)
{
	const std::string ending = nativePath(path).extension().string();
	std::error_code ignored;
	const std::filesystem::file_status status = std::filesystem::status(nativePath(path), ignored);
	const bool device =
		std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) && !std::filesystem::is_directory(status);
	if (path == "-" || (ending.empty() && device))
	{
		return kFormats.front();
	}
	const auto found = std::find(formats.begin(), formats.end(), ending);
	if (found == formats.end())
	{
		refuseFormat(path, formats);
	}
	return *found;
}

std::string patternBytes(std::string_view format, const Pattern& pattern, const Recipe* recipe, const Quality& quality,
						 const EmitContext& context)
{
	if (format == ".json")
	{
		return patternJson(pattern, recipe, quality, context);
	}
	if (format == ".csv")
	{
		return patternCsv(pattern, quality, context);
	}
	if (format == ".svg")
	{
		return svgText(patternPicture(pattern, recipe, quality), notesOf(context, measuresOf(quality)));
	}
	return sourceBytes(format, sourceOf(pattern, recipe, quality, context), patternFormats());
}

std::string tileBytes(std::string_view format, const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality,
					  const EmitContext& context)
{
	if (format == ".json")
	{
		return tileJson(tile, recipe, quality, context);
	}
	if (format == ".csv")
	{
		return tileCsv(tile, quality, context);
	}
	if (format == ".svg")
	{
		return svgText(tilePicture(tile, quality), notesOf(context, measuresOf(quality)));
	}
	if (format == ".png")
	{
		return tilePng(tile, quality, context);
	}
	if (format == ".exr")
	{
		return tileExr(tile, quality, context);
	}
	if (format == ".ktx2")
	{
		return tileKtx2(tile, quality, context);
	}
	return sourceBytes(format, sourceOf(tile, quality, context), tileFormats());
}

void emitPattern(const std::string& path, const Pattern& pattern, const Recipe* recipe, const Quality& quality,
				 const EmitContext& context)
{
	writeFile(path, patternBytes(formatOf(path, patternFormats()), pattern, recipe, quality, context));
}

void emitTile(const std::string& path, const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality,
			  const EmitContext& context)
{
	writeFile(path, tileBytes(formatOf(path, tileFormats()), tile, recipe, quality, context));
}

} // namespace nook
