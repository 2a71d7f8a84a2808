// SPDX-License-Identifier: GPL-3.0-or-later
// The table of features (feature_table.h) as options of nook shade and nook emit, and what is wrong with those that are given.
#pragma once

#include "methods/feature_table.h"
#include "methods/method_table.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <string>
#include <vector>

namespace nook
{

struct FeatureOption
{
	const FeatureRow* row = nullptr;
	CLI::Option* option = nullptr;
};

// One of the table's rows. `more` ends its line of help.
FeatureOption addFeature(CLI::App& app, const FeatureRow& row, ShadeSettings& settings, const std::string& more = {});

// Those of a place (kInShade, kInEmit) that fit, in the table's order.
std::vector<FeatureOption> addFeatures(CLI::App& app, unsigned place, const std::function<bool(const FeatureRow&)>& fits,
									   ShadeSettings& settings);

// --slices beside a tile, whose slices are what a pixel has. Throws Error (usage).
void refuseSlicesBesideTile(const std::vector<FeatureOption>& options);

// Values that the table alone cannot tell: layers, taps, bands. Throws Error (usage), as all below.
void checkValues(const std::vector<FeatureOption>& options, const ShadeSettings& settings);

// Nook shade: refuses options of another method, and such as need one another.
void checkShadeFeatures(const std::vector<FeatureOption>& options, const ShadeSettings& settings);

// Nook emit: refuses options that would change nothing.
void checkEmitFeatures(const std::vector<FeatureOption>& options, const ShadeSettings& settings,
					   const std::vector<ShadeMethod>& methods);

// As given: " --cut --filter window".
std::string featuresText(const std::vector<FeatureOption>& options);

} // namespace nook
