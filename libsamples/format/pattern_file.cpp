// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/pattern_file.h"

#include "core/error.h"
#include "core/file.h"
#include "core/json_reader.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/text.h"
#include "core/words.h"
#include "format/arrays.h"
#include "format/pattern_json.h"
#include "format/tile_json.h"
#include "image/drawing.h"
#include "pattern/cells.h"

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
	const std::string ending = nativePath(path).extension().string();
	refuseInput(path, ending.empty() ? "no ending" : "the ending " + ending, "one of " + joinedText(formats, ", "),
				ExitCode::usage);
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

std::string joined(const Sample& sample, const char* separator, const char* suffix)
{
	return joinedText(sample, separator, [suffix](float value) { return floatText(value) + suffix; });
}

std::string constantsText(const Source& source)
{
	return joinedText(
		source.constants, "",
		[](const SourceConstant& constant)
		{ return "#define " + constant.name + " " + std::to_string(constant.value) + " // " + constant.comment + "\n"; });
}

// Syntax of a language: how it begins and ends a row, a number's suffix, and how it ends an array.
struct Shape
{
	std::string before;
	std::string after;
	const char* suffix; // suffix of a number
	std::string close;
};

template <class Opening> std::string arraysText(const Source& source, const Shape& shape, const Opening& opening)
{
	std::string text;
	for (const SourceArray& array : source.arrays)
	{
		text += "\n// " + array.comment + "\n" + opening(array) + "\n";
		const auto rowOf = [&shape](const Sample& row)
		{
			return "\t" + shape.before + joined(row, ", ", shape.suffix) + shape.after;
		};
		text += joinedText(array.rows, ",\n", rowOf) + "\n" + shape.close + "\n";
	}
	return text;
}

bool isTile(const std::string& text, const std::string& path)
{
	const nlohmann::json root = parseJson(text, path);
	const auto schema = root.find("schema");
	return root.is_object() && schema != root.end() && *schema == kTileSchema;
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
	return format == ".json"  ? patternJson(pattern, recipe, quality, context)
		   : format == ".csv" ? patternCsv(pattern, quality, context)
		   : format == ".svg" ? svgText(patternPicture(pattern, recipe, quality), notesOf(context, measuresOf(quality)))
							  : sourceBytes(format, sourceOf(pattern, recipe, quality, context), patternFormats());
}

std::string tileBytes(std::string_view format, const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality,
					  const EmitContext& context)
{
	return format == ".json"   ? tileJson(tile, recipe, quality, context)
		   : format == ".csv"  ? tileCsv(tile, quality, context)
		   : format == ".svg"  ? svgText(tilePicture(tile, quality), notesOf(context, measuresOf(quality)))
		   : format == ".png"  ? tilePng(tile, quality, context)
		   : format == ".exr"  ? tileExr(tile, quality, context)
		   : format == ".ktx2" ? tileKtx2(tile, quality, context)
							   : sourceBytes(format, sourceOf(tile, quality, context), tileFormats());
}

std::string headerText(const Source& source)
{
	const std::string guard = source.guard + "_H";
	const std::string unused = "#ifndef NOOK_MAYBE_UNUSED\n"
							   "#if defined(__GNUC__) || defined(__clang__)\n"
							   "#define NOOK_MAYBE_UNUSED __attribute__((unused))\n"
							   "#else\n"
							   "#define NOOK_MAYBE_UNUSED\n"
							   "#endif\n"
							   "#endif\n";
	return commentBlock(source.notes, "// ") + "#ifndef " + guard + "\n#define " + guard + "\n\n" + unused + "\n" +
		   constantsText(source) +
		   arraysText(source, {"{", "}", "f", "};"},
					  [](const SourceArray& array)
					  { return "NOOK_MAYBE_UNUSED static const float " + array.name + "[" + array.size_name + "][4] = {"; }) +
		   "\n#endif // " + guard + "\n";
}

std::string glslText(const Source& source)
{
	const std::string guard = source.guard + "_GLSL";
	return commentBlock(source.notes, "// ") +
		   "// Include it in a shader of GLSL 1.30, GLSL ES 3.00 or later; older versions have no constant arrays and get "
		   "none.\n#ifndef " +
		   guard + "\n#define " + guard + "\n#if __VERSION__ >= 130\n\n" + constantsText(source) +
		   arraysText(source, {"vec4(", ")", "", ");"},
					  [](const SourceArray& array)
					  {
						  const std::string size = "[" + array.size_name + "]";
						  return "const highp vec4 " + array.name + size + " = vec4" + size + "(";
					  }) +
		   "\n#endif\n#endif // " + guard + "\n";
}

std::string hlslText(const Source& source)
{
	const std::string guard = source.guard + "_HLSL";
	return commentBlock(source.notes, "// ") + "#ifndef " + guard + "\n#define " + guard + "\n\n" + constantsText(source) +
		   arraysText(source, {"float4(", ")", "", "};"},
					  [](const SourceArray& array)
					  { return "static const float4 " + array.name + "[" + array.size_name + "] = {"; }) +
		   "\n#endif // " + guard + "\n";
}

std::string rowText(const Sample& sample)
{
	return joined(sample, ",", "");
}

std::variant<PatternFile, TileFile> readInput(const std::string& path, std::optional<Domain> domain)
{
	if (nativePath(path).extension() == ".csv" || !isTile(readFile(path), path))
	{
		return readPattern(path, domain);
	}
	TileFile file = readTile(path);
	if (domain && *domain != file.tile.domain)
	{
		refuseInput(path + ": domain", std::string(nameOf(file.tile.domain)), std::string(nameOf(*domain)));
	}
	return file;
}

void completeWeights(PatternFile& file)
{
	if (!file.weights_given)
	{
		file.pattern.weights = exactCells(file.pattern.domain, file.pattern.points, file.pattern.powers).integrals;
	}
}

void checkProgressive(const std::variant<PatternFile, TileFile>& input, const std::string& path)
{
	bool progressive = false;
	if (const PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		progressive = file->recipe && file->recipe->order == Order::progressive;
	}
	else
	{
		const TileFile& tile = std::get<TileFile>(input);
		progressive = (tile.recipe && tile.recipe->progressive) ||
					  (!tile.tile.transforms.empty() && tile.base_command.find("--order progressive") != std::string::npos);
	}
	refuseInputIf(!progressive, path, "samples in any order",
				  "for bands a pattern in progressive order, a tile that turns it, or a progressive tile");
}

} // namespace nook
