// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the methods to compare with: Crytek's, volumetric, horizon-based and scalable ambient occlusion.
#pragma once

#include "methods/settings.h"

#include <CLI/CLI.hpp>

#include <string_view>
#include <vector>

namespace nook
{

struct RivalOption
{
	CLI::Option* option = nullptr;
	ShadeMethod method = ShadeMethod::hbao;
	std::string_view method_name;
};

// --crytek-range, --hbao-…, --sao-…
std::vector<RivalOption> addRivalOptions(CLI::App& app, RivalSettings& settings);

// Refuses options of another method. Throws Error (usage).
void checkRivalOptions(const std::vector<RivalOption>& options, ShadeMethod method);

} // namespace nook
