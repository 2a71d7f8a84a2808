// SPDX-License-Identifier: GPL-3.0-or-later
// What was built: for --version alone, since what nook writes must not change with every commit.
#pragma once

namespace nook
{

extern const char* const kCommit; // "unknown" without a repository

} // namespace nook
