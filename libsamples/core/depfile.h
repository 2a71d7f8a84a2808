// SPDX-License-Identifier: GPL-3.0-or-later
// What was made from what → a rule in Make's syntax, which Ninja reads too.
#pragma once

#include <span>
#include <string>

namespace nook
{

// "target…: source…", each path escaped. Throws Error (unsupported) for a path with a line break, which Make cannot express.
std::string depfileText(std::span<const std::string> targets, std::span<const std::string> sources);

} // namespace nook
