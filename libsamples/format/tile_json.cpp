// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/tile_json.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/text.h"
#include "format/arrays.h"
#include "format/json_fields.h"

#include <array>
#include <cmath>

namespace nook
{
namespace
{

// Fields of tiles made for filters only.
std::string filtersJson(const TileRecipe& recipe)
{
	if (recipe.filters.empty())
	{
		return {};
	}
	const auto fieldsOf = [](const TileFilter& filter) -> nlohmann::ordered_json
	{
		return {{"name", filter.name}, {"share", filter.share}, {"width", filter.width}, {"taps", filter.taps}};
	};
	const nlohmann::ordered_json filters = mapped(recipe.filters, fieldsOf);
	return ",\n\t\t\"filters\": " + jsonLine(filters) + ",\n\t\t\"robust\": " + (recipe.robust ? "true" : "false") +
		   ",\n\t\t\"frames\": " + std::to_string(recipe.frames) + ",\n\t\t\"ema\": " + doubleText(recipe.ema) +
		   ",\n\t\t\"moves\": " + (recipe.moves ? "true" : "false");
}

std::string recipeJson(const TileRecipe& recipe)
{
	return "{\n\t\t\"size\": " + std::to_string(recipe.size) + ",\n\t\t\"kind\": " + jsonText(nameOf(recipe.kind)) +
		   ",\n\t\t\"lambda\": " + doubleText(recipe.lambda) + ",\n\t\t\"starts\": " + std::to_string(recipe.starts) +
		   ",\n\t\t\"seed\": " + std::to_string(recipe.seed) + filtersJson(recipe) +
		   (recipe.progressive ? ",\n\t\t\"progressive\": true" : "") + "\n\t}";
}

// Returns the sum; throws if negative taps cancel it, which leaves no mean.
double checkedSum(const JsonValue& taps, const std::vector<double>& numbers)
{
	const double sum = sumOver(numbers);
	const double below = sumOver(numbers, [](double tap) { return tap < 0.0 ? -tap : 0.0; });
	failIf(!(sum > below) || sum > 1e9, taps,
		   "taps with the sum " + numberText(sum) + ", " + numberText(-below) + " of it negative",
		   "a sum above what the negative ones take away, at most 1e9");
	return sum;
}

TileFilter readFilterFields(const JsonValue& object)
{
	object.allowOnly({"name", "share", "width", "taps"});
	const auto width = static_cast<std::size_t>(object.at("width").integer(1, kMaxTaps));
	const JsonValue taps = object.at("taps");
	const std::size_t count = taps.arraySize();
	taps.require(!(count < 1 || count % width != 0 || count / width > kMaxTaps),
				 "rows of " + std::to_string(width) + " numbers, at most " + std::to_string(kMaxTaps));
	std::vector<double> numbers = listOf(count, [&taps](std::size_t i) { return taps.at(i).number(); });
	checkedSum(taps, numbers);
	TileFilter filter{object.at("name").string(), object.at("share").number(), static_cast<int>(width), std::move(numbers)};
	object.at("share").require(filter.share > 0.0 && filter.share <= 1e6, "a number above 0, at most 1e6");
	return filter;
}

TileRecipe readRecipe(const JsonValue& object, const PatternTile& tile)
{
	object.allowOnly({"size", "kind", "lambda", "starts", "seed", "filters", "robust", "frames", "ema", "moves", "progressive"});
	TileRecipe recipe;
	recipe.size = static_cast<int>(object.at("size").integer(2, kMaxTileSize));
	recipe.kind = enumOf<TileKind>(object.at("kind"));
	recipe.lambda = object.at("lambda").number();
	recipe.starts = static_cast<int>(object.at("starts").integer(0, 1000));
	recipe.seed = static_cast<uint32_t>(object.at("seed").integer(0, UINT32_MAX));
	recipe.progressive = object.has("progressive") && object.at("progressive").boolean();
	if (object.has("filters"))
	{
		recipe.filters = mapped(object.objects("filters"), readFilterFields);
		recipe.robust = object.at("robust").boolean();
		recipe.frames = static_cast<int>(object.at("frames").integer(1, kMaxTileFrames));
		recipe.ema = object.at("ema").number();
		recipe.moves = object.at("moves").boolean();
	}
	if (recipe.frames != tile.frames || recipe.moves == tile.moves.empty())
	{
		object.at("frames").expected(std::to_string(tile.frames) + " as in the tile, and moves as there");
	}
	object.at("size").require(recipe.size == tile.size, std::to_string(tile.size) + " as in the tile");
	try
	{
		checkTileRecipe(recipe, tile.domain);
	}
	catch (const Error& error)
	{
		object.fail(std::string("options that do not go together (") + error.what() + ")", "a recipe of nook tile");
	}
	return recipe;
}

std::array<double, 4> numbersOf(const TileTransform& t, Domain domain)
{
	return domain == Domain::ball ? std::array{t.axis.x, t.axis.y, t.axis.z, t.scale}
								  : std::array{t.cos, t.sin, t.scale, t.handedness};
}

TileTransform readTransform(const JsonValue& value, Domain domain)
{
	value.require(value.arraySize() == 4, "an array of 4 numbers");
	const std::array<double, 4> n{value.at(0).number(), value.at(1).number(), value.at(2).number(), value.at(3).number()};
	const TileTransform t = domain == Domain::ball ? TileTransform{.scale = n[3], .axis = {n[0], n[1], n[2]}}
												   : TileTransform{.cos = n[0], .sin = n[1], .scale = n[2], .handedness = n[3]};
	const bool unit = domain == Domain::ball
						  ? std::fabs(t.axis.x * t.axis.x + t.axis.y * t.axis.y + t.axis.z * t.axis.z - 1.0) <= 1e-5
						  : std::fabs(t.cos * t.cos + t.sin * t.sin - 1.0) <= 1e-5 && std::fabs(t.handedness) == 1.0;
	value.require(unit && t.scale > 0.0, domain == Domain::ball
											 ? "a unit direction and a scale above 0"
											 : "the cosine and sine of an angle, a scale above 0 and a handedness of 1 or -1");
	return t;
}

// Empty for a tile that is the same in every frame.
std::string framesJson(const PatternTile& tile)
{
	const auto textOf = [](const glm::ivec2& move)
	{
		return "[" + std::to_string(move.x) + ", " + std::to_string(move.y) + "]";
	};
	const std::string moves = joinedText(tile.moves, ", ", textOf);
	return (tile.frames > 1 ? "\t\"frames\": " + std::to_string(tile.frames) + ",\n" : "") +
		   (moves.empty() ? "" : "\t\"moves\": [" + moves + "],\n");
}

void readFrames(const JsonValue& root, PatternTile& tile)
{
	tile.frames = root.has("frames") ? static_cast<int>(root.at("frames").integer(1, kMaxTileFrames)) : 1;
	if (!root.has("moves"))
	{
		return;
	}
	const JsonValue moves = root.at("moves");
	moves.require(moves.arraySize() == static_cast<std::size_t>(tile.frames),
				  "an array of " + std::to_string(tile.frames) + ", one a frame");
	for (std::size_t f = 0; f < moves.arraySize(); ++f)
	{
		const JsonValue move = moves.at(f);
		move.require(move.arraySize() == 2, "an array of 2 numbers");
		tile.moves.emplace_back(move.at(0).integer(0, tile.size - 1), move.at(1).integer(0, tile.size - 1));
	}
}

void readVariants(const JsonValue& root, std::size_t count, PatternTile& tile)
{
	const auto number = static_cast<std::size_t>(tile.size * tile.size * layersOf(tile));
	const JsonValue variants = root.at("variants");
	variants.require(variants.arraySize() == number,
					 "an array of " + std::to_string(number) + ", one a pixel of the window, without moves in each frame");
	for (std::size_t i = 0; i < number; ++i)
	{
		const JsonValue variant = variants.at(i);
		variant.allowOnly({"points", "weights", "powers"});
		tile.variants.push_back(readSamples(variant, tile.domain, true));
		variant.at("points").require(tile.variants.back().count() == count,
									 "an array of " + std::to_string(count) + ", as count says");
	}
	if (!root.has("transforms"))
	{
		return;
	}
	const JsonValue transforms = root.at("transforms");
	transforms.require(transforms.arraySize() == number, "an array of " + std::to_string(number) + ", one a variant");
	tile.transforms = listOf(number, [&](std::size_t i) { return readTransform(transforms.at(i), tile.domain); });
}

constexpr std::string_view kFile = "file:";

} // namespace

std::string tileJson(const PatternTile& tile, const TileRecipe* recipe, const TileQuality& quality, const EmitContext& context)
{
	std::string text = "{\n" + jsonHead(kTileSchema, context);
	if (!context.base_command.empty())
	{
		text += "\t\"base_command\": " + jsonText(context.base_command) + ",\n";
	}
	text += "\t\"quality\": " + measuresJson(measuresOf(quality)) + ",\n";
	if (recipe != nullptr)
	{
		text += "\t\"recipe\": " + recipeJson(*recipe) + ",\n";
	}
	text += "\t\"domain\": " + jsonText(nameOf(tile.domain)) + ",\n\t\"count\": " + std::to_string(tile.variants.front().count()) +
			",\n\t\"size\": " + std::to_string(tile.size) + ",\n" + framesJson(tile);
	const auto transformText = [&tile](const TileTransform& transform)
	{
		return "\n\t\t[" + joinedText(numbersOf(transform, tile.domain), ", ", doubleText) + "]";
	};
	text += tile.transforms.empty() ? "" : "\t\"transforms\": [" + joinedText(tile.transforms, ",", transformText) + "\n\t],\n";
	const auto textOf = [](const Pattern& variant)
	{
		return "\n\t\t{\n" + samplesJson(variant, "\t\t\t") + "\n\t\t}";
	};
	return text + "\t\"variants\": [" + joinedText(tile.variants, ",", textOf) + "\n\t]\n}\n";
}

TileFile parseTileJson(const std::string& text, const std::string& path)
{
	const nlohmann::json document = parseJson(text, path);
	const JsonValue root{&document, &path, ""};
	requireSchema(root, kTileSchema);
	root.allowOnly({"schema", "SPDX-License-Identifier", "command", "base_command", "version", "comment", "quality", "recipe",
					"domain", "count", "size", "frames", "moves", "transforms", "variants"});
	TileFile file;
	file.tile.domain = enumOf<Domain>(root.at("domain"));
	file.tile.size = static_cast<int>(root.at("size").integer(2, kMaxTileSize));
	readFrames(root, file.tile);
	readVariants(root, static_cast<std::size_t>(root.at("count").integer(1, kMaxCount)), file.tile);
	readHead(root, file.command, file.version);
	file.base_command = root.text("base_command");
	if (root.has("quality"))
	{
		file.quality = readMeasures<TileQuality>(root.at("quality"));
	}
	if (root.has("recipe"))
	{
		file.recipe = readRecipe(root.at("recipe"), file.tile);
	}
	return file;
}

TileFile readTile(const std::string& path)
{
	return parseTileJson(readFile(path), path);
}

std::string tileCsv(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	std::string text = commentBlock(notesOf(context, measuresOf(quality)), "# ");
	text += "# domain: " + std::string(nameOf(tile.domain)) + "\n";
	text += "# variant of a pixel: " + variantText(tile, std::to_string(tile.size)) + "\n";
	for (std::size_t f = 0; f < tile.moves.size(); ++f)
	{
		text += "# move of frame " + std::to_string(f) + ": " + std::to_string(tile.moves[f].x) + ", " +
				std::to_string(tile.moves[f].y) + "\n";
	}
	const std::vector<Sample> transforms = transformsOf(tile);
	for (std::size_t i = 0; i < transforms.size(); ++i)
	{
		text += (i == 0 ? "# transforms: variant," + std::string(transformColumnsOf(tile.domain)) + "\n" : "") + "# " +
				std::to_string(i) + "," + rowText(transforms[i]) + "\n";
	}
	text += "variant," + std::string(columnsOf(tile.domain)) + "\n";
	for (std::size_t i = 0; i < tile.variants.size(); ++i)
	{
		text += joinedText(samplesOf(tile.variants[i]), "",
						   [&](const Sample& sample) { return std::to_string(i) + "," + rowText(sample) + "\n"; });
	}
	return text;
}

FilterFile parseFilter(const std::string& text, const std::string& path)
{
	const nlohmann::json document = parseJson(text, path);
	const JsonValue root{&document, &path, ""};
	root.allowOnly({"taps"});
	const JsonValue rows = root.at("taps");
	const std::size_t height = rows.arraySize();
	rows.require(!(height < 1 || height > kMaxTaps), "an array of 1 to " + std::to_string(kMaxTaps) + " rows");
	std::vector<double> taps;
	std::size_t width = 0;
	for (std::size_t y = 0; y < height; ++y)
	{
		const JsonValue row = rows.at(y);
		const std::size_t found = row.arraySize();
		width = y == 0 ? found : width;
		row.require(!(found < 1 || found > kMaxTaps || found != width),
					"an array of " + (y == 0 ? "1 to " + std::to_string(kMaxTaps) : std::to_string(width)) + " numbers");
		for (std::size_t x = 0; x < width; ++x)
		{
			taps.push_back(row.at(x).number());
		}
	}
	const double sum = checkedSum(rows, taps);
	return {tileFilterOf("file:" + nativePath(path).filename().string(), static_cast<int>(width), std::move(taps)), sum};
}

std::vector<TileFilter> filtersOf(const std::vector<std::string>& names, std::vector<std::string>& warnings)
{
	std::vector<TileFilter> filters;
	for (const std::string& text : names)
	{
		const auto [name, share] = nameAndShare(text);
		if (name.starts_with(kFile))
		{
			const std::string path = name.substr(kFile.size());
			FilterFile file = parseFilter(readFile(path), path);
			if (std::fabs(file.sum - 1.0) > 1e-6)
			{
				warnings.push_back(path + ": taps: found the sum " + roundedText(file.sum, 6) + ", divided by it");
			}
			filters.push_back(std::move(file.filter));
		}
		else
		{
			filters.push_back(tileFilterNamed(name));
		}
		filters.back().share = share;
	}
	return filters;
}

std::vector<std::string> filterFiles(const std::vector<std::string>& names)
{
	return mapped(itemsWhere(names, [](const std::string& text) { return text.starts_with(kFile); }),
				  [](const std::string& text) { return nameAndShare(text).first.substr(kFile.size()); });
}

} // namespace nook
