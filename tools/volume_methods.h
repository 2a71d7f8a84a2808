// SPDX-License-Identifier: GPL-3.0-or-later
// The methods that draw volumes, as options of several verbs name them, and --directions of the one that masks.
#pragma once

#include "options.h"

#include <string>

namespace nook
{

// Their names, from the table.
std::string volumeMethods(const std::string& between);
std::string sumMethod();
std::string maskMethod();

// 128 unless given.
CLI::Option* addDirections(CLI::App& app, int& directions);

// Throws Error (usage) where it was given for another method, or is no count of whole words.
void checkDirections(const CLI::Option& given, int directions, bool masks);

} // namespace nook
