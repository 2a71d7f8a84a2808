// SPDX-License-Identifier: GPL-3.0-or-later
// Recipes derive all settings of a method from one length, the ray length that artists specify. `paper` changes nothing: the radius
// is the method's own, as published. `rays` is fitted to ray tracing by `nook fit` (rays.json).
#pragma once

#include "methods/feature_table.h"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct RecipeValue
{
	const FeatureRow* feature = nullptr;
	double value = 0.0; // as in FeatureValue; lengths in multiples of the reach
};

struct MethodRecipe
{
	ShadeMethod method{};
	double radius = 1.0; // of the method, in multiples of the reach
	std::vector<RecipeValue> values{};
};

// The `rays` recipes, at most one per method.
std::span<const MethodRecipe> raysRecipes();

// The recipe of a method; null if there is none.
const MethodRecipe* recipeFor(std::span<const MethodRecipe> recipes, ShadeMethod method);

// Applies a recipe for rays of length reach_m > 0. Settings that the recipe does not name are unchanged.
void applyRecipe(ShadeSettings& settings, const MethodRecipe& recipe, double reach_m);

// Takes the recipe's values from settings for a reach of 1 m.
void takeFrom(MethodRecipe& recipe, const ShadeSettings& settings);

// True for a number in metres.
bool isLength(const FeatureRow& feature);

// "radius 0.7, --thickness 0.6 --combine product", lengths in multiples of the reach.
std::string recipeText(const MethodRecipe& recipe);

inline constexpr std::string_view kRecipesFormat = "nook.recipes/1";

// {"method", "radius", "options": {"--thickness": 0.5, "--combine": "product"}}
nlohmann::ordered_json recipeJson(const MethodRecipe& recipe);

// A file of kRecipesFormat.
std::string recipesFile(const std::vector<MethodRecipe>& recipes, const std::string& version);

// True if the JSON text declares this format. Throws Error (invalid input) naming `path` if it is not JSON.
bool holdsRecipes(const std::string& text, const std::string& path);

// Parses a file of kRecipesFormat. Throws Error (invalid input) naming `path`.
std::vector<MethodRecipe> recipesOf(const std::string& text, const std::string& path);

// A file of kRecipesFormat. Throws Error naming it.
std::vector<MethodRecipe> readRecipes(const std::string& path);

// The recipe of a method by the name that --recipe takes: "paper" (none: as published), "rays", or a file, .json. Throws Error
// (usage) for another name, and (invalid_input) for a file without the method.
std::optional<MethodRecipe> chosenRecipe(const std::string& name, ShadeMethod method);

inline bool isRecipeFile(const std::string& name)
{
	return name != "paper" && name != "rays";
}

} // namespace nook
