// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/recipes.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_reader.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "methods/assets.h"
#include "methods/method_table.h"

#include <algorithm>

namespace nook
{
namespace
{

const FeatureRow* featureNamed(std::string_view option)
{
	return firstWhere(featureTable(),
					  [option](const FeatureRow& row) { return row.option == option && (row.places & kInShade) != 0; });
}

double valueOf(const JsonValue& json, const FeatureRow& feature)
{
	if (feature.kind == FeatureKind::flag)
	{
		return json.boolean() ? 1.0 : 0.0;
	}
	if (feature.kind == FeatureKind::choice)
	{
		const std::string name = json.string();
		const auto found = std::find(feature.choices.begin(), feature.choices.end(), name);
		json.require(found != feature.choices.end(), "one of its choices");
		return static_cast<double>(found - feature.choices.begin());
	}
	if (feature.kind == FeatureKind::whole)
	{
		return static_cast<double>(json.integer(static_cast<int64_t>(feature.least), static_cast<int64_t>(feature.most)));
	}
	const double value = json.number();
	failIf(value < feature.least || value > feature.most, json, numberText(value),
		   "a number from " + numberText(feature.least) + " to " + numberText(feature.most));
	return value;
}

MethodRecipe recipeOf(const JsonValue& json)
{
	json.allowOnly({"method", "radius", "options", "errors"});
	const JsonValue name = json.at("method");
	const MethodRow* const row = methodNamed(name.string());
	name.require(!(row == nullptr || row->kind != MethodKind::screen), "a screen-space method");
	MethodRecipe recipe{row->method, json.at("radius").number(), {}};
	failIf(!(recipe.radius >= 1e-3 && recipe.radius <= 1e3), json, "radius", numberText(recipe.radius),
		   "a number from 0.001 to 1000");
	const JsonValue options = json.objectNeeded("options");
	for (const auto& [option, value] : options.value->items())
	{
		const FeatureRow* const feature = featureNamed(option);
		failIf(feature == nullptr || !takesFeature(*row, *feature), options, option, "an option",
			   "one of " + std::string(row->name));
		recipe.values.push_back({feature, valueOf(options.at(option), *feature)});
	}
	return recipe;
}

} // namespace

std::span<const MethodRecipe> raysRecipes()
{
	static const std::vector<MethodRecipe> recipes = recipesOf(std::string(assets::rays_json), "rays.json");
	return recipes;
}

const MethodRecipe* recipeFor(std::span<const MethodRecipe> recipes, ShadeMethod method)
{
	return firstWhere(recipes, [method](const MethodRecipe& one) { return one.method == method; });
}

void applyRecipe(ShadeSettings& settings, const MethodRecipe& recipe, double reach_m)
{
	settings.radius_m = recipe.radius * reach_m;
	for (const RecipeValue& one : recipe.values)
	{
		one.feature->value.set(settings, isLength(*one.feature) ? one.value * reach_m : one.value);
	}
}

void takeFrom(MethodRecipe& recipe, const ShadeSettings& settings)
{
	for (RecipeValue& one : recipe.values)
	{
		one.value = one.feature->value.get(settings);
	}
}

bool isLength(const FeatureRow& feature)
{
	return feature.unit == "m";
}

std::string recipeText(const MethodRecipe& recipe)
{
	std::string text = "radius " + numberText(recipe.radius) + ",";
	for (const RecipeValue& one : recipe.values)
	{
		text += " " + std::string(one.feature->option);
		text += one.feature->kind == FeatureKind::choice
					? " " + std::string(one.feature->choices[static_cast<std::size_t>(one.value)])
				: one.feature->kind == FeatureKind::flag ? ""
														 : " " + numberText(one.value);
	}
	return text;
}

nlohmann::ordered_json recipeJson(const MethodRecipe& recipe)
{
	nlohmann::ordered_json options = nlohmann::ordered_json::object();
	for (const RecipeValue& one : recipe.values)
	{
		nlohmann::ordered_json& option = options[std::string(one.feature->option)];
		switch (one.feature->kind)
		{
		case FeatureKind::flag: option = one.value > 0.0; break;
		case FeatureKind::choice: option = one.feature->choices[static_cast<std::size_t>(one.value)]; break;
		case FeatureKind::whole: option = static_cast<int>(one.value); break;
		case FeatureKind::number: option = one.value; break;
		}
	}
	return {{"method", rowOf(recipe.method).name}, {"radius", recipe.radius}, {"options", options}};
}

std::string recipesFile(const std::vector<MethodRecipe>& recipes, const std::string& version)
{
	const auto list = mapped(recipes, [](const MethodRecipe& recipe) { return recipeJson(recipe); });
	return jsonFile(nlohmann::ordered_json{{"format", kRecipesFormat}, {"nook_version", version}, {"recipes", list}});
}

bool holdsRecipes(const std::string& text, const std::string& path)
{
	const nlohmann::json document = parseJson(text, path);
	const auto format = document.find("format");
	return document.is_object() && format != document.end() && *format == kRecipesFormat;
}

std::vector<MethodRecipe> recipesOf(const std::string& text, const std::string& path)
{
	const nlohmann::json document = parseJson(text, path);
	const JsonValue root{&document, &path, {}};
	root.allowOnly({"format", "nook_version", "command", "fit", "recipes"});
	root.at("format").require(root.at("format").string() == kRecipesFormat, "'" + std::string(kRecipesFormat) + "'");
	std::vector<MethodRecipe> recipes;
	for (const JsonValue& one : root.objects("recipes"))
	{
		recipes.push_back(recipeOf(one));
		failIf(recipeFor({recipes.data(), recipes.size() - 1}, recipes.back().method) != nullptr, one, "method",
			   "one that was there", "each method once");
	}
	return recipes;
}

std::vector<MethodRecipe> readRecipes(const std::string& path)
{
	return recipesOf(readFile(path), path);
}

std::optional<MethodRecipe> chosenRecipe(const std::string& name, ShadeMethod method)
{
	if (name == "paper")
	{
		return std::nullopt;
	}
	std::vector<MethodRecipe> of_file;
	if (isRecipeFile(name))
	{
		refuseIf(!name.ends_with(".json"), "--recipe: found '" + name + "', expected paper, rays or FILE.json");
		of_file = readRecipes(name);
	}
	const MethodRecipe* const found = recipeFor(isRecipeFile(name) ? of_file : raysRecipes(), method);
	refuseIf(found == nullptr && isRecipeFile(name),
			 name + ": recipes: found none of " + std::string(nameOf(method)) + ", expected one", ExitCode::invalid_input);
	return found != nullptr ? std::optional(*found) : std::nullopt;
}

} // namespace nook
