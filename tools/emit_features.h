// SPDX-License-Identifier: GPL-3.0-or-later
// Options of `nook emit` that choose what a module can do: features, filters, resolution.
#pragma once

#include "emit/module.h"

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace nook
{

struct EmitFeature
{
	CLI::Option* option = nullptr;
	std::vector<ShadeMethod> methods; // that it changes; empty: any
};

std::vector<EmitFeature> addEmitFeatures(CLI::App& app, ShadeSettings& settings);

// Refuses options that would change nothing. Throws Error (usage).
void checkEmitFeatures(const std::vector<EmitFeature>& features, const ModuleSettings& settings,
					   const std::vector<ShadeMethod>& methods);

// As given: " --cut --filter window".
std::string featuresText(const std::vector<EmitFeature>& features);

} // namespace nook
