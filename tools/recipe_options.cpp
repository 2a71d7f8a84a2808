// SPDX-License-Identifier: GPL-3.0-or-later
#include "recipe_options.h"

#include "options.h"

#include "core/error.h"
#include "core/file.h"
#include "methods/method_table.h"

namespace nook
{

std::vector<MethodRecipe> readRecipes(const std::string& path)
{
	return recipesOf(readFile(path), path);
}

CLI::Option* addRecipe(CLI::App& app, RecipeOption& recipe)
{
	return addText(
		app, "--recipe", recipe.name, "paper|rays|FILE.json",
		"rays (default): --radius is the reach of rays with linear falloff, and radii, thickness, strength and power are "
		"fitted to them; paper: the method as published, --radius its own; or a file of nook fit. Options that are given "
		"count more");
}

std::optional<MethodRecipe> chosenRecipe(const RecipeOption& recipe, ShadeMethod method)
{
	if (recipe.name == "paper")
	{
		return std::nullopt;
	}
	std::vector<MethodRecipe> of_file;
	const bool rays = !isRecipeFile(recipe);
	if (!rays)
	{
		if (!recipe.name.ends_with(".json"))
		{
			refuseValue("--recipe", recipe.name, "paper, rays or FILE.json");
		}
		of_file = readRecipes(recipe.name);
	}
	const MethodRecipe* const found = recipeFor(rays ? raysRecipes() : of_file, method);
	if (found == nullptr && !rays)
	{
		throw Error(ExitCode::invalid_input,
					recipe.name + ": recipes: found none of " + std::string(nameOf(method)) + ", expected one");
	}
	return found != nullptr ? std::optional(*found) : std::nullopt;
}

ShadeSettings withRecipe(const ShadeSettings& settings, const std::optional<MethodRecipe>& recipe, double reach_m,
						 const std::vector<FeatureOption>& given)
{
	ShadeSettings result = settings;
	if (!recipe)
	{
		return result;
	}
	applyRecipe(result, *recipe, reach_m);
	for (const FeatureOption& one : given)
	{
		if (one.option->count() > 0)
		{
			one.row->value.set(result, one.row->value.get(settings));
		}
	}
	return result;
}

} // namespace nook
