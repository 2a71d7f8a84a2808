// SPDX-License-Identifier: GPL-3.0-or-later
// What was made from what → a rule that GNU Make and Ninja read alike.
#pragma once

#include <span>
#include <string>

namespace nook
{

// "target…: source…", each path escaped. Throws Error (unsupported) for a path that Make 4.3 or Ninja 1.11 cannot hold: what such a
// path adds to a makefile may be a command, and what it adds to Ninja's log another file.
std::string depfileText(std::span<const std::string> targets, std::span<const std::string> sources);

} // namespace nook
