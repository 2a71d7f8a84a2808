// SPDX-License-Identifier: GPL-3.0-or-later
// --recipe, of nook shade and nook emit.
#pragma once

#include "feature_options.h"

#include "methods/recipes.h"

namespace nook
{

// A file of recipes. Throws Error naming it.
std::vector<MethodRecipe> readRecipes(const std::string& path);

struct RecipeOption
{
	std::string name = "rays"; // paper, rays or a file
};

inline bool isRecipeFile(const RecipeOption& recipe)
{
	return recipe.name != "paper" && recipe.name != "rays";
}

CLI::Option* addRecipe(CLI::App& app, RecipeOption& recipe);

// What it has of a method; none: as published. Throws Error for a name or file that is none, and for a file without the method.
std::optional<MethodRecipe> chosenRecipe(const RecipeOption& recipe, ShadeMethod method);

// The settings of a recipe, and over them what was given on the command line.
ShadeSettings withRecipe(const ShadeSettings& settings, const std::optional<MethodRecipe>& recipe, double reach_m,
						 const std::vector<FeatureOption>& given);

} // namespace nook
