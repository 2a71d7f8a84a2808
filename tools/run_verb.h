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

// The verb's words and its arguments in one order, whatever theirs was, without outputs, threads, progress and part: what makes a
// command the same.
std::vector<std::string> commandWords(const CLI::App& verb);

// With --part the verb ends where its share is done, and a file of that appears in place of its outputs. Throws what the verb
// throws.
void runVerb(const Verb& verb, VerbProgress& progress);

} // namespace nook
