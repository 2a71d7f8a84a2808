// SPDX-License-Identifier: GPL-3.0-or-later
// Options of statistical volumetric obscurance.
#pragma once

#include "method_options.h"

namespace nook
{

// What nook shade and nook emit both take.
inline constexpr std::array<std::string_view, 2> kLayerings{"adaptive", "uniform"};
inline constexpr std::array<std::string_view, 3> kStatVoTables{"full", "half", "quarter"};
inline constexpr std::array<std::string_view, 2> kSkips{"yes", "no"};

// --layers --layering --quadrants --tables --slope --height --largest --skip --tables-by
void addStatVoOptions(CLI::App& app, StatVoSettings& settings, std::vector<MethodOption>& options);

// Throws Error (usage) for counts that the layering has not.
void checkStatVo(const StatVoSettings& settings);

// "4 adaptive layers, full tables": for notes and summaries.
std::string layersText(const StatVoSettings& settings);

} // namespace nook
