// SPDX-License-Identifier: GPL-3.0-or-later
// A list of levels and the steps that each goes through (nook.batch/1) → command lines of nook.
#pragma once

#include <string>
#include <vector>

namespace nook
{

struct BatchCommand
{
	std::string name;               // LEVEL.STEP
	std::vector<std::string> words; // names of files as seen from the output folder
	int parts = 1;
	int minutes = 0; // to ask for; 0: by an estimate
	int mebibytes = 0;
};

// `here`: the folder of the list, as seen from the output folder. Level by level, steps in their order. Throws Error
// (invalid_input) with the element that is wrong.
std::vector<BatchCommand> readBatch(const std::string& text, const std::string& path, const std::string& here);

} // namespace nook
