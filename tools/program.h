// SPDX-License-Identifier: GPL-3.0-or-later
// The whole program, as main() calls it: a command line → what it wrote, and its exit code.
#pragma once

namespace nook
{

int runProgram(int argc, char** argv);

// The commit that was built, or "unknown"; only --version prints it, since outputs must not change with commits.
extern const char* const kCommit;

} // namespace nook
