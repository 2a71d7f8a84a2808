// SPDX-License-Identifier: GPL-3.0-or-later
// The words of one of nook's command lines → a command that a farm can be given.
#pragma once

#include "farm/plan.h"

#include <map>
#include <string>
#include <vector>

namespace nook
{

struct CommandPlace
{
	std::string root;   // the whole name of the folder that the farm mounts
	std::string folder; // the whole name of the folder where the command runs, in it
};

struct CommandChoice
{
	std::string name; // of its jobs
	int parts = 1;
	int minutes = 0; // to ask for; 0: by an estimate
	int mebibytes = 0;
};

inline constexpr const char* kCommandName = "letters, digits, '.', '_' and '-', a letter or digit first, at most 48";
bool isCommandName(const std::string& name);

// Pixels of pictures that commands before it write; its own are added.
using PixelsOf = std::map<std::string, double>;

// Checks the words as the verb itself would before any work. Names of files become relative to the folder. Throws Error: usage
// (words that the verb does not take, options that the farm needs for itself, names outside the root), file (no level there),
// unsupported (a verb that cannot be split).
PlanCommand planCommandOf(std::vector<std::string> words, const CommandPlace& place, const CommandChoice& choice, PixelsOf& pixels);

} // namespace nook
