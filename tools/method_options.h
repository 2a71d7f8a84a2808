// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the screen-space methods: which method takes which.
#pragma once

#include "methods/settings.h"

#include <CLI/CLI.hpp>

#include <array>
#include <string_view>
#include <vector>

namespace nook
{

// What nook shade and nook emit both take.
inline constexpr std::array<std::string_view, 2> kNormalUses{"yes", "no"};
inline constexpr std::array<std::string_view, 2> kCombinations{"product", "minimum"};
inline constexpr std::array<std::string_view, 2> kFalloffs{"constant", "quadratic"};

struct MethodOption
{
	CLI::Option* option = nullptr;
	std::vector<ShadeMethod> methods; // that take it
};

// --use-normal --thickness --radius2 --combine --falloff --paired, --sigma --contrast --beta --epsilon --cut, --bands --band-pixels
std::vector<MethodOption> addMethodOptions(CLI::App& app, ShadeSettings& settings);

// Refuses options of another method, and such as need one another. Throws Error (usage).
void checkMethodOptions(const std::vector<MethodOption>& options, const ShadeSettings& settings);

} // namespace nook
