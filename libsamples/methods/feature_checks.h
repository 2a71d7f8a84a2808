// SPDX-License-Identifier: GPL-3.0-or-later
// Which features and views go with a method and with one another. Each check throws Error (usage).
#pragma once

#include "methods/feature_table.h"
#include "methods/method_table.h"
#include "methods/recipes.h"

#include <optional>
#include <string_view>
#include <vector>

namespace nook
{

// The rows of options that were given, in the table's order.
using GivenFeatures = std::vector<const FeatureRow*>;

// For nook shade: refuses options of another method, and options that lack one they need.
void checkShadeFeatures(const GivenFeatures& given, const ShadeSettings& settings);

// For nook emit: refuses options that would change nothing.
void checkEmitFeatures(const GivenFeatures& given, const ShadeSettings& settings, const std::vector<ShadeMethod>& methods);

// Refuses --slices beside a tile, which has its own.
void refuseSlicesWithTile(const GivenFeatures& given);

// The settings of a recipe, and over them the features that were given.
ShadeSettings withRecipe(const ShadeSettings& settings, const std::optional<MethodRecipe>& recipe, double reach_m,
						 const GivenFeatures& given);

// Names of DebugView, in its order, and the one that settings ask for, or "visibility".
std::string_view debugName(const ShadeSettings& settings);

// Refuses a view that says nothing of the method, and once they are known, of the samples.
void checkDebug(const ShadeSettings& settings);
void checkDebug(const ShadeSettings& settings, const ShadeSamples& samples);

} // namespace nook
