// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/pattern_json.h"

#include "core/error.h"
#include "core/file.h"
#include "core/text.h"
#include "format/json_fields.h"

namespace nook
{
namespace
{

std::string recipeJson(const Recipe& recipe)
{
	const auto flag = [](bool value)
	{
		return value ? "true" : "false";
	};
	const auto name = [](auto value)
	{
		return jsonText(nameOf(value));
	};
	return "{\n\t\t\"domain\": " + name(recipe.domain) + ",\n\t\t\"count\": " + std::to_string(recipe.count) +
		   ",\n\t\t\"centre\": " + flag(recipe.centre) + ",\n\t\t\"symmetric\": " + flag(recipe.symmetric) +
		   ",\n\t\t\"method\": " + name(recipe.method) + ",\n\t\t\"minimise\": " + name(recipe.minimise) +
		   ",\n\t\t\"weights\": " + name(recipe.weights) + ",\n\t\t\"voronoi\": " + name(recipe.voronoi) +
		   ",\n\t\t\"order\": " + name(recipe.order) + ",\n\t\t\"starts\": " + std::to_string(recipe.starts) +
		   ",\n\t\t\"seed\": " + std::to_string(recipe.seed) + ",\n\t\t\"exponent\": " + doubleText(recipe.exponent) + "\n\t}";
}

Recipe readRecipe(const JsonValue& object, const Pattern& pattern)
{
	object.allowOnly({"domain", "count", "centre", "symmetric", "method", "minimise", "weights", "voronoi", "order", "starts",
					  "seed", "exponent"});
	Recipe recipe;
	recipe.domain = enumOf<Domain>(object.at("domain"));
	recipe.count = static_cast<int>(object.at("count").integer(1, kMaxCount));
	recipe.centre = object.at("centre").boolean();
	recipe.symmetric = object.at("symmetric").boolean();
	recipe.method = enumOf<Method>(object.at("method"));
	recipe.minimise = enumOf<Minimise>(object.at("minimise"));
	recipe.weights = enumOf<WeightRule>(object.at("weights"));
	recipe.voronoi = enumOf<VoronoiMode>(object.at("voronoi"));
	recipe.order = enumOf<Order>(object.at("order"));
	recipe.starts = static_cast<int>(object.at("starts").integer(0, 100000));
	recipe.seed = static_cast<uint32_t>(object.at("seed").integer(0, UINT32_MAX));
	recipe.exponent = object.at("exponent").number();
	if (recipe.domain != pattern.domain)
	{
		object.at("domain").expected(jsonText(nameOf(pattern.domain)) + " as in the pattern");
	}
	if (static_cast<std::size_t>(recipe.count) != pattern.count())
	{
		object.at("count").expected(std::to_string(pattern.count()) + " as in the pattern");
	}
	try
	{
		checkRecipe(recipe);
	}
	catch (const Error& error)
	{
		object.fail(std::string("options that do not go together (") + error.what() + ")", "a recipe of nook pattern");
	}
	return recipe;
}

} // namespace

std::string patternJson(const Pattern& pattern, const Recipe* recipe, const Quality& quality, const EmitContext& context)
{
	std::string text = "{\n" + jsonHead(kPatternSchema, context) + "\t\"quality\": " + measuresJson(measuresOf(quality)) + ",\n";
	if (recipe != nullptr)
	{
		text += "\t\"recipe\": " + recipeJson(*recipe) + ",\n";
	}
	text += "\t\"domain\": " + jsonText(nameOf(pattern.domain)) + ",\n\t\"count\": " + std::to_string(pattern.count()) + ",\n";
	return text + samplesJson(pattern, "\t") + "\n}\n";
}

PatternFile parsePatternJson(const std::string& text, const std::string& path)
{
	const nlohmann::json document = parseJson(text, path);
	const JsonValue root{&document, &path, ""};
	root.requireObject();
	const bool ours = root.has("schema");
	if (ours)
	{
		requireSchema(root, kPatternSchema);
	}
	root.allowOnly({"schema", "SPDX-License-Identifier", "command", "version", "comment", "quality", "recipe", "domain", "count",
					"points", "weights", "powers"});
	PatternFile file;
	const Domain domain = enumOf<Domain>(root.at("domain"));
	if (domain == Domain::slice)
	{
		root.at("domain").expected("that of a pattern; slices come in tiles");
	}
	if (ours || root.has("count"))
	{
		const auto count = static_cast<std::size_t>(root.at("count").integer(1, kMaxCount));
		if (root.at("points").arraySize() != count)
		{
			root.at("points").expected("an array of " + std::to_string(count) + ", as count says");
		}
	}
	file.weights_given = ours || root.has("weights");
	file.pattern = readSamples(root, domain, file.weights_given);
	readHead(root, file.command, file.version);
	if (root.has("quality"))
	{
		file.quality = readMeasures<Quality>(root.at("quality"));
	}
	if (root.has("recipe"))
	{
		file.recipe = readRecipe(root.at("recipe"), file.pattern);
	}
	return file;
}

PatternFile readPattern(const std::string& path, std::optional<Domain> domain)
{
	const std::string text = readFile(path);
	if (path.ends_with(".csv"))
	{
		return parsePatternCsv(text, path, domain);
	}
	PatternFile file = parsePatternJson(text, path);
	if (domain.has_value() && file.pattern.domain != *domain)
	{
		throw Error(ExitCode::invalid_input, path + ": domain: found " + jsonText(nameOf(file.pattern.domain)) + ", expected " +
												 jsonText(nameOf(*domain)) + " as asked for");
	}
	return file;
}

} // namespace nook
