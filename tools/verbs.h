// SPDX-License-Identifier: GPL-3.0-or-later
// All verbs of the command line, in the order of the help.
#pragma once

#include "options.h"

#include <vector>

namespace nook
{

std::vector<Verb> addVerbs(CLI::App& nook);

} // namespace nook
