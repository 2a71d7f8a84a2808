// SPDX-License-Identifier: GPL-3.0-or-later
// A verb whose options have been parsed, run as a whole or as a part of it.
#pragma once

#include "options.h"

#include <string>
#include <vector>

namespace nook
{

// The verb that was parsed below `app`: of "report", say, "error".
const CLI::App& parsedVerb(const CLI::App& app);

// The verb's words and its arguments in one order, whatever theirs was, without outputs, threads, progress, cache and share: what
// makes a command the same.
std::vector<std::string> commandWords(const CLI::App& verb);

// The identity of results in a store (core/work_units.h): the version, then the command.
std::vector<std::string> identityOf(std::vector<std::string> command);

// With --cache, the run's results are kept there. Throws what the verb throws.
void runVerb(const Verb& verb, VerbProgress& progress);

} // namespace nook
