// SPDX-License-Identifier: GPL-3.0-or-later
// Recipes: all that can be said of a method, from one length, the reach of the rays that artists mean. `paper` says nothing, and
// the radius is the method's own, as published; `rays` is fitted to ray tracing by `nook fit` (rays.json).
#pragma once

#include "methods/feature_table.h"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

struct RecipeValue
{
	const FeatureRow* feature = nullptr;
	double value = 0.0; // of FeatureValue; a length in reaches
};

struct MethodRecipe
{
	ShadeMethod method{};
	double radius = 1.0; // of the method, in reaches
	std::vector<RecipeValue> values{};
};

// The recipes `rays`, at most one a method.
std::span<const MethodRecipe> raysRecipes();

// The one of a method; null where there is none.
const MethodRecipe* recipeFor(std::span<const MethodRecipe> recipes, ShadeMethod method);

// The settings of a recipe for rays that reach so far, > 0. What the recipe does not name is left alone.
void applyRecipe(ShadeSettings& settings, const MethodRecipe& recipe, double reach_m);

// The recipe's values as settings for a reach of 1 m have them.
void takeFrom(MethodRecipe& recipe, const ShadeSettings& settings);

// A number in metres, of settings.
bool isLength(const FeatureRow& feature);

// "radius 0.7, --thickness 0.6 --combine product", lengths in reaches.
std::string recipeText(const MethodRecipe& recipe);

inline constexpr std::string_view kRecipesFormat = "nook.recipes/1";

// {"method", "radius", "options": {"--thickness": 0.5, "--combine": "product"}}
nlohmann::ordered_json recipeJson(const MethodRecipe& recipe);

// A file of kRecipesFormat.
std::string recipesFile(const std::vector<MethodRecipe>& recipes, const std::string& version);

// Whether the text is JSON that says so of itself. Throws Error (invalid input) naming `path` where it is no JSON.
bool holdsRecipes(const std::string& text, const std::string& path);

// The text of a file of kRecipesFormat. Throws Error (invalid input) naming `path`.
std::vector<MethodRecipe> recipesOf(const std::string& text, const std::string& path);

} // namespace nook
