// SPDX-License-Identifier: GPL-3.0-or-later
// Procedural levels in metres with named cameras; the first camera is called "main".
#pragma once

#include "scene/level.h"

#include <span>
#include <string>
#include <string_view>

namespace nook
{

inline constexpr std::string_view kBuiltinPrefix = "builtin:";

// "cornell", "courtyard", …: valid names after the prefix.
std::span<const std::string_view> builtinNames();

// `name` without the prefix; "heightfield:1000000" and "cave:20000" ask for at least that many triangles. Throws Error (usage) for
// another name.
Level builtinLevel(std::string_view name);

} // namespace nook
