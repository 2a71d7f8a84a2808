// SPDX-License-Identifier: GPL-3.0-or-later
// The table of features (feature_table.h) and --recipe as options of nook shade and nook emit; and options that name the methods
// which draw volumes.
#pragma once

#include "options.h"

#include "methods/feature_checks.h"

#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr std::array<std::string_view, 2> kModuleDepths{"linear", "device"}; // that a module reads

// One of the table's rows. `more` ends its line of help.
OptionRow featureOption(const FeatureRow& row, ShadeSettings& settings, const std::string& more = {}, OptionRules rules = {});

// Those of a place (kInShade, kInEmit) that fit, in the table's order.
std::vector<OptionRow> featureOptions(unsigned place, const std::function<bool(const FeatureRow&)>& fits, ShadeSettings& settings,
									  const OptionRules& rules = {});

// Those of a place that were given.
GivenFeatures givenFeatures(const CLI::App& app, unsigned place);

// The given options as words of a command: " --cut --filter window".
std::string featuresText(const CLI::App& app, const GivenFeatures& features);

OptionRow recipeRow(std::string& name, OptionRules rules = {});

// The methods that draw volumes: all, the one that adds them up, the one that masks.
std::string volumeMethods(const std::string& between);
std::string sumMethod();
std::string maskMethod();

// --directions of the method that masks, a multiple of 32.
OptionRow directionsRow(int& directions, OptionRules rules = {});

} // namespace nook
