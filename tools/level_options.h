// SPDX-License-Identifier: GPL-3.0-or-later
// Which level, and how its file is to be taken: the same options for every verb that asks for one.
#pragma once

#include "options.h"

#include "scene/load.h"

#include <string>

namespace nook
{

struct LevelOptions
{
	std::string level; // a file, or builtin:NAME
	LoadSettings load;
};

// LEVEL, --unit, --up, --strict, --max-texels, --allow-outside, --pose and --tr.
void addLevelOptions(CLI::App& app, LevelOptions& options);

// The same without LEVEL, for verbs whose file may be something else; returns the options.
std::vector<CLI::Option*> addLoadOptions(CLI::App& app, LoadSettings& load);

} // namespace nook
